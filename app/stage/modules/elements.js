// Building the page: elements, icons, and words with values filled in.

// el('button.primary', { type: 'button', onclick }, 'Play'): a tag with classes, properties or attributes, content.
export function el(tag, properties = {}, ...content) {
  const [name, ...classes] = tag.split('.');
  const element = document.createElement(name);
  if (classes.length) element.className = classes.join(' ');
  for (const [key, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith('on')) element.addEventListener(key.slice(2), value);
    else element.setAttribute(key, value === true ? '' : value);
  }
  element.append(...content.flat().filter((part) => part !== null && part !== undefined));
  return element;
}

const STROKE = 'fill="none" stroke="currentColor" stroke-width="1.8" stroke-linecap="round" stroke-linejoin="round"';
const ICONS = {
  restart: `<path d="M13 8a5 5 0 1 1-1.6-3.7M13 2v3h-3" ${STROKE}/>`,
  check: `<path d="M3 8.5l3.2 3.2L13 4.8" ${STROKE}/>`,
  back: `<path d="M13 8H3.5M7.5 4l-4 4 4 4" ${STROKE}/>`,
  lock: `<rect x="3" y="7" width="10" height="7" rx="1.6" fill="currentColor"/><path d="M5.2 7V5a2.8 2.8 0 0 1 5.6 0v2" ${STROKE}/>`,
  play: '<path d="M4.5 2.8v10.400L13 8z" fill="currentColor"/>',
  pause: '<path d="M4.2 3v10M11.8 3v10" fill="none" stroke="currentColor" stroke-width="3" stroke-linecap="round"/>',
  dial: '<circle cx="8" cy="8" r="6" fill="none" stroke="currentColor" stroke-opacity=".25" stroke-width="2.5"/><circle class="arc" cx="8" cy="8" r="6" pathLength="100" fill="none" stroke="currentColor" stroke-width="2.5" stroke-dasharray="0 100" transform="rotate(-90 8 8)"/>',
};

export function icon(name) {
  const holder = document.createElement('template');
  holder.innerHTML = `<svg class="icon" viewBox="0 0 16 16" aria-hidden="true">${ICONS[name]}</svg>`;
  return holder.content.firstChild;
}

// The sign of a method: A a circle, B a square.
export function badge(slot, size = '') {
  return el(`i.badge.${slot.toLowerCase()}${size && `.${size}`}`, { 'aria-hidden': 'true' }, slot);
}

// words('{seconds} seconds more with {method}', { seconds: 3, method: 'A' })
export function words(text, values = {}) {
  return text.replace(/\{(\w+)\}/g, (all, key) => values[key] ?? all);
}

// Changes a text only if it differs, so that screen readers and layout are left in peace.
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
