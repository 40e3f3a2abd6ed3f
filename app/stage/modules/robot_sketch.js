// The robot view without WebGL: the same capsules as thick lines from far to near, the wall as a sheared picture.

import { capsules, FLOOR_Z, nozzleTip } from './arm.js';
import { project } from './camera.js';
import { PAINT } from './palette.js';

const ROOM = {
  light: { floor: '#DCDEDC', room: '#F1F2F0', shadow: 'rgba(29,41,48,.10)', dim: 1 },
  dark: { floor: '#262E33', room: '#191F23', shadow: 'rgba(0,0,0,.28)', dim: 0.82 },
};

export class RobotSketch {
  constructor(canvas, picture, wallX) {
    Object.assign(this, { canvas, picture, wallX });
  }

  draw(state, path, look, theme, { width, height, ratio }) {
    const { canvas } = this;
    const size = { width: Math.round(width * ratio), height: Math.round(height * ratio) };
    if (canvas.width !== size.width || canvas.height !== size.height) Object.assign(canvas, size);
    const g = canvas.getContext('2d');
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    const at = (point) => project(point, width, height);
    const room = ROOM[theme];
    this.picture.draw(state, path, look);
    g.fillStyle = room.room;
    g.fillRect(0, 0, width, height);
    const foot = [4, -2.6].map((y) => at([this.wallX, y, FLOOR_Z]));
    fill(g, room.floor, [...foot, { x: 2 * width, y: 2 * height }, { x: -width, y: 2 * height }]);
    this.#drawWall(g, at);
    const tubes = capsules(state.q);
    for (const { a, b, ra } of tubes) line(g, at([a[0], a[1], FLOOR_Z]), at([b[0], b[1], FLOOR_Z]), ra, room.shadow);
    const nearness = ({ a, b }) => at(a).distance + at(b).distance;
    for (const tube of [...tubes].sort((p, q) => nearness(q) - nearness(p))) {
      const shade = (share) => `rgb(${tube.colour.map((v) => Math.round(255 * Math.min(1, v * share) * room.dim)).join()})`;
      line(g, at(tube.a), at(tube.b), tube.ra, shade(0.72));
      line(g, at(tube.a), at(tube.b), tube.ra * 0.62, shade(1.05));
    }
    if (state.spraying) {
      const spot = at([this.wallX, state.y, state.z]);
      line(g, at(nozzleTip(state.q)), spot, 0.008, `rgba(${PAINT.join()},.7)`);
    }
  }

  finish() {}

  dispose() {}

  // Narrow upright strips, each drawn where its edges stand: a picture in perspective without a shader.
  #drawWall(g, at) {
    const { left, right, top, bottom } = this.picture.extent;
    const { canvas } = this.picture;
    const strips = 48;
    for (let i = 0; i < strips; i++) {
      const y0 = left + ((right - left) * i) / strips;
      const y1 = left + ((right - left) * (i + 1)) / strips;
      const p = at([this.wallX, y0, top]);
      const q = at([this.wallX, y1, top]);
      const s = at([this.wallX, y0, bottom]);
      g.save();
      g.transform(q.x - p.x, q.y - p.y, s.x - p.x, s.y - p.y, p.x, p.y);
      g.drawImage(canvas, (canvas.width * i) / strips, 0, canvas.width / strips, canvas.height, 0, 0, 1.25, 1);
      g.restore();
    }
  }
}

function line(g, p, q, radius, colour) {
  g.strokeStyle = colour;
  g.lineCap = 'round';
  g.lineWidth = Math.max(1, radius * (p.scale + q.scale));
  g.beginPath();
  g.moveTo(p.x, p.y);
  g.lineTo(q.x, q.y);
  g.stroke();
}

function fill(g, colour, points) {
  g.fillStyle = colour;
  g.beginPath();
  for (const p of points) g.lineTo(p.x, p.y);
  g.fill();
}
