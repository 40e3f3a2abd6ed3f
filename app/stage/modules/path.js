// The blasted path. Every pixel keeps the strongest opacity ever painted on it, so that strokes neither add up
// nor show beads: a faint line stays faint where it crosses itself.

import { PAINT_M, spareCanvas } from './frame.js';
import { PAINT } from './palette.js';

const SOLID = 0.97;
const FAINT = 0.2;

// Opacity of the path at a speed [m/s]: solid up to one speed, faint from another, smooth between.
export function opacityAt(speed, { solidUpTo, faintFrom }) {
  const t = Math.min(1, Math.max(0, (speed - solidUpTo) / (faintFrom - solidUpTo)));
  return SOLID + (FAINT - SOLID) * t * t * (3 - 2 * t);
}

export class Path {
  // limits: { solidUpTo, faintFrom } [m/s].
  constructor(limits) {
    this.limits = limits;
    this.canvas = spareCanvas();
    this.points = [];
    this.frame = null;
  }

  clear() {
    this.points = [];
    if (this.frame) this.fit(this.frame, this.ratio, true);
  }

  // A new size of the wall: what was painted is painted again at that size.
  fit(frame, ratio, anew = false) {
    const same = this.frame && frame.width === this.frame.width && frame.height === this.frame.height;
    if (same && ratio === this.ratio && !anew) return;
    this.frame = frame;
    this.ratio = ratio;
    this.canvas.width = Math.max(1, Math.round(frame.width * ratio));
    this.canvas.height = Math.max(1, Math.round(frame.height * ratio));
    this.context = this.canvas.getContext('2d');
    this.image = this.context.createImageData(this.canvas.width, this.canvas.height);
    for (let i = 1; i < this.points.length; i++) this.#paint(this.points[i - 1], this.points[i]);
    this.context.putImageData(this.image, 0, 0);
  }

  // The nozzle sprays at (y, z) [m] with a speed [m/s]; lift() ends a stroke.
  sprayTo(y, z, speed) {
    const point = { y, z, alpha: opacityAt(speed, this.limits) };
    const last = this.points.at(-1);
    this.points.push(point);
    if (!this.frame) return;
    const box = this.#paint(last && !last.lifted ? last : point, point);
    if (box) this.context.putImageData(this.image, 0, 0, box.x, box.y, box.w, box.h);
  }

  lift() {
    const last = this.points.at(-1);
    if (last) last.lifted = true;
  }

  // One stroke from p to q: a capsule whose opacity runs from p's to q's, with a soft edge one pixel wide.
  #paint(p, q) {
    if (p.lifted && p !== q) p = q;
    const { frame, ratio, image } = this;
    const radius = (PAINT_M / 2) * frame.scale * ratio;
    const [px, py, qx, qy] = [frame.x(p.y), frame.y(p.z), frame.x(q.y), frame.y(q.z)].map((v) => v * ratio);
    const x0 = Math.max(0, Math.floor(Math.min(px, qx) - radius - 1));
    const y0 = Math.max(0, Math.floor(Math.min(py, qy) - radius - 1));
    const x1 = Math.min(image.width, Math.ceil(Math.max(px, qx) + radius + 1));
    const y1 = Math.min(image.height, Math.ceil(Math.max(py, qy) + radius + 1));
    if (x1 <= x0 || y1 <= y0) return null;
    const dx = qx - px;
    const dy = qy - py;
    const length2 = dx * dx + dy * dy || 1e-9;
    for (let y = y0; y < y1; y++) {
      for (let x = x0; x < x1; x++) {
        const ax = x + 0.5 - px;
        const ay = y + 0.5 - py;
        const t = Math.min(1, Math.max(0, (ax * dx + ay * dy) / length2));
        const edge = radius - Math.hypot(ax - t * dx, ay - t * dy) + 0.5;
        if (edge <= 0) continue;
        const alpha = 255 * (p.alpha + (q.alpha - p.alpha) * t) * Math.min(1, edge);
        const i = 4 * (y * image.width + x);
        if (alpha > image.data[i + 3]) {
          image.data[i] = PAINT[0];
          image.data[i + 1] = PAINT[1];
          image.data[i + 2] = PAINT[2];
          image.data[i + 3] = alpha;
        }
      }
    }
    return { x: x0, y: y0, w: x1 - x0, h: y1 - y0 };
  }
}
