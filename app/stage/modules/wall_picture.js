// The wall as the robot view shows it: lane, path and cursor on a picture of fixed size.

import { drawCursor } from './cursor.js';
import { Frame } from './frame.js';
import { drawStart, drawWall } from './wall.js';

const WIDTH = 512;
const HEIGHT = 256;
const RING_PX = 10;

export class WallPicture {
  constructor(maze) {
    this.frame = new Frame(maze, WIDTH, HEIGHT);
    this.canvas = document.createElement('canvas');
    this.empty = document.createElement('canvas');
    for (const canvas of [this.canvas, this.empty]) {
      canvas.width = WIDTH;
      canvas.height = HEIGHT;
    }
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

  draw(state, path, look) {
    const g = this.canvas.getContext('2d');
    g.drawImage(this.empty, 0, 0);
    if (path.frame) {
      const share = this.frame.scale / path.frame.scale;
      const w = path.frame.width * share;
      const h = path.frame.height * share;
      g.drawImage(path.canvas, (WIDTH - w) / 2, (HEIGHT - h) / 2, w, h);
    }
    drawCursor(g, this.frame.x(state.y), this.frame.y(state.z), { ...look, radius: RING_PX });
  }
}
