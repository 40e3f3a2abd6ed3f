// The picture of the instructions: a lap begun, the hand that guides, and the three looks of the nozzle's mark.

import { mount } from './component.js';
import { drawCursor } from './cursor.js';
import { el } from './elements.js';
import { fitted } from './frame.js';
import { WALL } from './palette.js';
import { Path } from './path.js';
import { WallView } from './wall_view.js';

const TILT_DEG = { straight: 0, little: 12, too: 22 };
const SHARE_ACROSS = 0.72; // how far along the top edge the drawn lap has come
const SHARE_FAST = [0.4, 0.52]; // where it was too fast, and the path is faint

export default function (component) {
  return mount(component, (root, { data }) => new Picture(root, data));
}

class Picture {
  constructor(root, data) {
    this.data = data;
    this.canvas = el('canvas', { 'aria-hidden': 'true' });
    this.marks = Object.keys(TILT_DEG).map((look) => ({ look, canvas: el('canvas', { 'aria-hidden': 'true' }) }));
    const { texts } = data;
    root.append(
      el(
        'div.picture',
        {},
        el('div.wall', { role: 'img', 'aria-label': texts.picture }, this.canvas),
        el(
          'div.marks',
          {},
          this.marks.map(({ look, canvas }) =>
            el('figure', {}, canvas, el('figcaption', {}, el('b', {}, texts[look]), texts[`${look}_means`])),
          ),
        ),
      ),
    );
    this.path = new Path(data.path);
    this.wall = new WallView(this.canvas, data.maze, this.path, texts);
    this.#spray();
    this.resizing = new ResizeObserver(() => this.update());
    this.resizing.observe(this.canvas);
  }

  update() {
    const { maze } = this.data;
    const state = {
      y: this.end,
      z: maze.top,
      hand: { y: this.end - 0.17, z: maze.top - 0.1 },
      pull: 0.5,
      moving: true,
      handLabel: this.data.texts.hand,
    };
    this.wall.draw(state, this.#look('straight'));
    for (const { look, canvas } of this.marks) {
      const view = fitted(canvas);
      if (!view) continue;
      view.context.fillStyle = WALL.lane;
      view.context.fillRect(0, 0, view.width, view.height);
      drawCursor(view.context, view.width / 2, view.height / 2, { ...this.#look(look), radius: 26 });
    }
  }

  dispose() {
    this.resizing.disconnect();
  }

  #look(look) {
    return { look, elongation: TILT_DEG[look] / this.data.tilt.fullEllipse, spraying: true };
  }

  #spray() {
    const { maze, path } = this.data;
    const steps = 120;
    for (let i = 0; i <= steps; i++) {
      const share = (SHARE_ACROSS * i) / steps;
      const isFast = share > SHARE_FAST[0] && share < SHARE_FAST[1];
      this.end = maze.left + (maze.right - maze.left) * share;
      const speed = isFast ? 0.9 * path.faintFrom : 0.5 * path.solidUpTo;
      this.path.sprayTo(this.end, maze.top + 0.004 * Math.sin(i / 5), speed);
    }
  }
}
