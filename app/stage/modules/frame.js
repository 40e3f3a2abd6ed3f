// Where a point of the wall is on the screen. Wall: metres, y grows to the left, z up. Screen: CSS pixels.

// Room around the rectangle: the lane, the ring and a hand pulled beyond the right edge [m].
const MARGIN = { across: 0.365, up: 0.165 };

export const LANE_M = 0.085;
export const PAINT_M = 0.034;
export const RING_M = 0.026;

export class Frame {
  // maze: { left, right, top, bottom } [m]; width and height of the view [px].
  constructor(maze, width, height) {
    const across = maze.left - maze.right + MARGIN.across;
    const up = maze.top - maze.bottom + MARGIN.up;
    this.maze = maze;
    this.width = width;
    this.height = height;
    this.scale = Math.min(width / across, height / up);
    this.midY = (maze.left + maze.right) / 2;
    this.midZ = (maze.top + maze.bottom) / 2;
  }

  x(y) {
    return this.width / 2 - (y - this.midY) * this.scale;
  }

  y(z) {
    return this.height / 2 - (z - this.midZ) * this.scale;
  }

  // The point of the wall that is shown at (x, y).
  wallAt(x, y) {
    return { y: this.midY - (x - this.width / 2) / this.scale, z: this.midZ - (y - this.height / 2) / this.scale };
  }

  // The rectangle's centre line on the screen.
  get box() {
    const { left, right, top, bottom } = this.maze;
    return { x0: this.x(left), x1: this.x(right), y0: this.y(top), y1: this.y(bottom) };
  }

  get ring() {
    return Math.max(13, RING_M * this.scale);
  }
}

// A canvas that isn't on the page; a worker has no document to make one with.
export function spareCanvas(width = 1, height = 1) {
  if (typeof document === 'undefined') return new OffscreenCanvas(width, height);
  return Object.assign(document.createElement('canvas'), { width, height });
}

// Sizes a canvas to its place on the page; the returned context draws in CSS pixels. Null while it has no size.
export function fitted(canvas) {
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  if (!width || !height) return null;
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  const w = Math.round(width * ratio);
  const h = Math.round(height * ratio);
  if (canvas.width !== w || canvas.height !== h) {
    canvas.width = w;
    canvas.height = h;
  }
  const context = canvas.getContext('2d');
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return { context, width, height, ratio };
}
