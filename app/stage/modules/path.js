// The blasted path. A pixel takes the opacity of the nearest point of the stroke, so that no beads or arcs show where
// the speed changes; where strokes cross, it keeps the strongest, so that they never add up.

import { PAINT_M, spareCanvas } from './frame.js';
import { PAINT } from './palette.js';

const SOLID = 0.97;
const FAINT = 0.2;
const SAME_PX = 0.25; // as near as before: the stronger of the two counts
const LEAVING_PX = 1; // so much further away than it was, the nozzle goes away from a pixel

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
    const pixels = this.canvas.width * this.canvas.height;
    // Of the stretch that was painted last over a pixel: where along the path it ended, how near it came, and how strong
    // it is there; and what stood there before it.
    this.end = new Float32Array(pixels).fill(-1);
    this.near = new Float32Array(pixels);
    this.alpha = new Uint8Array(pixels);
    this.before = new Uint8Array(pixels);
    this.isLeaving = new Uint8Array(pixels);
    this.along = 0;
    for (let i = 0; i < this.points.length; i++) this.#paint(this.#origin(i), this.points[i]);
    this.context.putImageData(this.image, 0, 0);
  }

  // The nozzle sprays at (y, z) [m] with a speed [m/s]; lift() ends a stroke.
  sprayTo(y, z, speed) {
    const point = { y, z, alpha: opacityAt(speed, this.limits) };
    this.points.push(point);
    if (!this.frame) return;
    const box = this.#paint(this.#origin(this.points.length - 1), point);
    if (box) this.context.putImageData(this.image, 0, 0, box.x, box.y, box.w, box.h);
  }

  lift() {
    const last = this.points.at(-1);
    if (last) last.lifted = true;
  }

  // Where the stroke comes from to a point: the point itself if it begins there.
  #origin(i) {
    const last = this.points[i - 1];
    return last && !last.lifted ? last : this.points[i];
  }

  // One stretch from p to q: a capsule whose opacity runs from p's to q's, with a soft edge one pixel wide.
  #paint(p, q) {
    const { frame, ratio, image } = this;
    const { width, height } = image;
    const radius = (PAINT_M / 2) * frame.scale * ratio;
    const [px, py, qx, qy] = [frame.x(p.y), frame.y(p.z), frame.x(q.y), frame.y(q.z)].map((v) => v * ratio);
    const dx = qx - px;
    const dy = qy - py;
    const long = Math.hypot(dx, dy);
    if (p === q) this.along += 1; // a new stroke: apart from all that was painted
    const from = this.along;
    this.along += long;
    const x0 = Math.max(0, Math.floor(Math.min(px, qx) - radius - 1));
    const y0 = Math.max(0, Math.floor(Math.min(py, qy) - radius - 1));
    const x1 = Math.min(width, Math.ceil(Math.max(px, qx) + radius + 1));
    const y1 = Math.min(height, Math.ceil(Math.max(py, qy) + radius + 1));
    if (x1 <= x0 || y1 <= y0) return null;
    const length2 = long * long || 1e-9;
    for (let y = y0; y < y1; y++) {
      for (let x = x0; x < x1; x++) {
        const ax = x + 0.5 - px;
        const ay = y + 0.5 - py;
        const t = Math.min(1, Math.max(0, (ax * dx + ay * dy) / length2));
        const far = Math.hypot(ax - t * dx, ay - t * dy);
        if (far >= radius + 0.5) continue;
        this.#take(y * width + x, far, 255 * (p.alpha + (q.alpha - p.alpha) * t), from, radius);
      }
    }
    return { x: x0, y: y0, w: x1 - x0, h: y1 - y0 };
  }

  // A pixel that a stretch comes over, as near as far [px]; from: where along the path the stretch begins. While the
  // nozzle comes nearer the pixel follows it; once it leaves, what is there stays, until it comes back.
  #take(i, far, alpha, from, radius) {
    const { data } = this.image;
    let goesOn = this.end[i] >= 0 && from - this.end[i] < 0.5;
    this.end[i] = this.along;
    if (goesOn && this.isLeaving[i]) {
      this.near[i] = Math.max(this.near[i], far);
      if (far > this.near[i] - LEAVING_PX) return;
      goesOn = false;
    } else if (goesOn && far > this.near[i] + LEAVING_PX) {
      this.isLeaving[i] = 1;
      this.near[i] = far;
      return;
    }
    if (!goesOn) {
      this.isLeaving[i] = 0;
      this.before[i] = data[4 * i + 3];
    }
    if (!goesOn || far < this.near[i] - SAME_PX) this.alpha[i] = alpha;
    else this.alpha[i] = Math.max(this.alpha[i], alpha);
    this.near[i] = goesOn ? Math.min(this.near[i], far) : far;
    data[4 * i] = PAINT[0];
    data[4 * i + 1] = PAINT[1];
    data[4 * i + 2] = PAINT[2];
    data[4 * i + 3] = Math.max(this.before[i], this.alpha[i] * Math.min(1, radius - this.near[i] + 0.5));
  }
}
