// Keys that are held down while the wall, or nothing else that takes keys, has the focus.

const TAKES_KEYS = 'button, input, select, textarea, a[href], [contenteditable]';

// Where the arrows and the letters point: along base y (left) and z (up).
const ARROWS = { arrowleft: [1, 0], arrowright: [-1, 0], arrowup: [0, 1], arrowdown: [0, -1] };
const LETTERS = { a: [1, 0], d: [-1, 0], w: [0, 1], s: [0, -1] };
export const isArrow = (key) => key in ARROWS;
export const isLetter = (key) => key in LETTERS;

export class HeldKeys {
  // owns(key): whether the device has a use for a key; onDown(key, at), onUp(key, at): it went down or up, and when [ms];
  // late: keys that also count if they were down before the wall had the focus.
  constructor(wall, { owns, onDown, onUp, late = [] }) {
    Object.assign(this, { wall, owns, onDown, onUp, late });
    this.held = new Set();
    this.down = (event) => this.#down(event);
    this.up = (event) => this.#up(event);
    window.addEventListener('keydown', this.down);
    window.addEventListener('keyup', this.up);
  }

  has(key) {
    return this.held.has(key);
  }

  get arrows() {
    return this.#sum(ARROWS);
  }

  get letters() {
    return this.#sum(LETTERS);
  }

  release() {
    this.held.clear();
  }

  dispose() {
    window.removeEventListener('keydown', this.down);
    window.removeEventListener('keyup', this.up);
  }

  #down(event) {
    const key = event.key.toLowerCase();
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (!this.owns(key) || !this.#isOurs(event.composedPath()[0])) return;
    event.preventDefault();
    if (this.held.has(key) || (event.repeat && !this.late.includes(key))) return;
    this.held.add(key);
    this.wall.focus({ preventScroll: true });
    this.onDown(key, event.timeStamp);
  }

  #up(event) {
    const key = event.key.toLowerCase();
    if (this.held.delete(key)) this.onUp(key, event.timeStamp);
  }

  #isOurs(target) {
    return target === this.wall || !(target instanceof Element) || !target.closest(TAKES_KEYS);
  }

  #sum(directions) {
    let [y, z] = [0, 0];
    for (const [key, [dy, dz]] of Object.entries(directions)) {
      if (this.held.has(key)) [y, z] = [y + dy, z + dz];
    }
    return { y, z };
  }
}
