// Building a drawing: svg('path', { d, class: 'line' }), with text where there is any.

const NAMESPACE = 'http://www.w3.org/2000/svg';

export function svg(tag, attributes = {}, ...content) {
  const element = document.createElementNS(NAMESPACE, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...content.flat());
  return element;
}
