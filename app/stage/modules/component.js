// One view for each place on the page. Streamlit calls a component's default export again whenever its data or the
// theme change, without a cleanup in between; the place (parentElement) stays the same.

const views = new WeakMap();

// create(root, component) -> { update(data), dispose() }; it is called once for a comparison, update at every call.
export function mount(component, create) {
  const { parentElement: place, data, name } = component;
  let shown = views.get(place);
  if (shown && (shown.name !== name || shown.comparison !== data.comparison)) {
    remove(place);
    shown = null;
  }
  if (!shown) {
    const root = document.createElement('div');
    root.className = 'elbowroom';
    root.dataset.theme = themeOf(place);
    place.append(root);
    shown = { name, comparison: data.comparison, root, view: create(root, component) };
    views.set(place, shown);
  }
  shown.root.dataset.theme = themeOf(place);
  shown.view.update(data);
  return () => {
    if (views.get(place) === shown) remove(place);
  };
}

function remove(place) {
  const { root, view } = views.get(place);
  views.delete(place);
  view.dispose();
  root.remove();
}

// 'light' or 'dark', by Streamlit's background colour.
export function themeOf(place) {
  const host = place.host ?? place;
  const probe = document.createElement('canvas').getContext('2d');
  probe.fillStyle = getComputedStyle(host).getPropertyValue('--st-background-color').trim() || '#fff';
  const [r, g, b] = probe.fillStyle.match(/[0-9a-f]{2}/gi).map((pair) => parseInt(pair, 16));
  return 0.299 * r + 0.587 * g + 0.114 * b < 128 ? 'dark' : 'light';
}
