// One view for each place on the page. Streamlit calls a component's default export again whenever its data or the
// theme change, without a cleanup in between; the place (parentElement) stays the same.

const views = new WeakMap();
const REPEAT_MS = 3000;
const MOST_REPEATS = 20;

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
    const teller = new Teller(component.setTriggerValue);
    const view = create(root, { ...component, setTriggerValue: (...said) => teller.tell(...said) });
    shown = { name, comparison: data.comparison, root, view, teller };
    views.set(place, shown);
    focusHeading(root);
  }
  shown.root.dataset.theme = themeOf(place);
  shown.view.update(data);
  return () => {
    if (views.get(place) === shown) remove(place);
  };
}

// Streamlit drops what is told while its connection is away, so it is told again until the page has changed.
class Teller {
  constructor(send) {
    this.send = send;
  }

  tell(name, value) {
    this.stop();
    this.send(name, value);
    let left = MOST_REPEATS;
    this.timer = setInterval(() => {
      this.send(name, value);
      if (--left === 0) this.stop();
    }, REPEAT_MS);
  }

  stop() {
    clearInterval(this.timer);
  }
}

// A new page starts at its heading: else the focus is lost with the button that led here.
function focusHeading(root) {
  const heading = root.querySelector('h1');
  if (!heading) return;
  heading.tabIndex = -1;
  heading.focus({ preventScroll: true });
}

function remove(place) {
  const { root, view, teller } = views.get(place);
  views.delete(place);
  teller.stop();
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
