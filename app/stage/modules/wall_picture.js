// The wall as the robot view shows it: lane, path and cursor on a picture of fixed size.

import { drawCursor } from './cursor.js';
import { Frame, spareCanvas } from './frame.js';
import { drawStart, drawWall } from './wall.js';

const WIDTH = 512;
const HEIGHT = 256;
const RING_PX = 10;

export class WallPicture {
  constructor(maze) {
    this.frame = new Frame(maze, WIDTH, HEIGHT);
    this.canvas = spareCanvas(WIDTH, HEIGHT);
    this.empty = spareCanvas(WIDTH, HEIGHT);
    const g = this.empty.getContext('2d');
    drawWall(g, this.frame, { chevrons: false });
    drawStart(g, this.frame);
  }

  // Corners on the wall [m].
  get extent() {
    const { midY, midZ, scale } = this.frame;
    const halfY = WIDTH / scale / 2;
    const halfZ = HEIGHT / scale / 2;
    return { left: midY + halfY, right: midY - halfY, top: midZ + halfZ, bottom: midZ - halfZ };
  }

  // path: a Path of its own, painted at this picture's size.
  draw(state, path, look) {
    const g = this.canvas.getContext('2d');
    g.drawImage(this.empty, 0, 0);
    path.fit(this.frame, 1);
    g.drawImage(path.canvas, 0, 0);
    drawCursor(g, this.frame.x(state.y), this.frame.y(state.z), { ...look, radius: RING_PX });
  }
}
