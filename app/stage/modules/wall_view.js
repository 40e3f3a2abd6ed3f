// The wall on the screen: the empty wall, what is painted on it, the hand and the nozzle's cursor.

import { drawCursor } from './cursor.js';
import { fitted, Frame, LANE_M, spareCanvas } from './frame.js';
import { drawHand } from './hand.js';
import { drawStart, drawWall } from './wall.js';

const NARROW_PX = 620;
const ROOM_FOR_WORDS_PX = 280;

export class WallView {
  // texts.start: the label of start and finish.
  constructor(canvas, maze, path, texts) {
    Object.assign(this, { canvas, maze, path, texts });
    this.empty = spareCanvas();
  }

  // state may be null: an empty wall. look: how the cursor looks.
  draw(state, look) {
    const view = fitted(this.canvas);
    if (!view) return;
    const { context: g, width, height, ratio } = view;
    const frame = this.#frame(width, height, ratio);
    g.drawImage(this.empty, 0, 0, width, height);
    g.drawImage(this.path.canvas, 0, 0, width, height);
    drawStart(g, frame, this.texts.start, width < NARROW_PX ? 11 : 13);
    if (!state) return;
    const [x, y] = [frame.x(state.y), frame.y(state.z)];
    if (state.moving) {
      drawHand(g, x, y, frame.ring * 1.15, frame.x(state.hand.y), frame.y(state.hand.z), state.pull, state.handLabel);
    }
    drawCursor(g, x, y, { ...look, radius: frame.ring });
  }

  #frame(width, height, ratio) {
    if (this.frame?.width !== width || this.frame?.height !== height || this.ratio !== ratio) {
      this.frame = new Frame(this.maze, width, height);
      this.ratio = ratio;
      this.empty.width = Math.round(width * ratio);
      this.empty.height = Math.round(height * ratio);
      const g = this.empty.getContext('2d');
      g.scale(ratio, ratio);
      drawWall(g, this.frame);
      this.path.fit(this.frame, ratio);
      this.#leaveRoom();
    }
    return this.frame;
  }

  // Tells the styles how wide the rectangle is, so that no words stand on the lane.
  #leaveRoom() {
    const { x0, x1 } = this.frame.box;
    const lane = LANE_M * this.frame.scale;
    const inside = x1 - x0 - lane;
    const wall = this.canvas.parentElement;
    wall.style.setProperty('--inside', `${inside}px`);
    wall.style.setProperty('--outside', `${inside + 2 * lane}px`);
    wall.toggleAttribute('data-small', inside < ROOM_FOR_WORDS_PX);
  }
}
