// The nozzle's mark on the wall. Shape, line and colour change together with the tilt: a whole ring, a broken
// ellipse with one tick, a double ellipse with two ticks. Grey and hollow while the robot waits.

import { TILT, WALL } from './palette.js';

const HYSTERESIS_DEG = 2;

// Which of the three looks a tilt has; it falls back only two degrees below the limit it passed.
export class TiltLook {
  // limits: { greenBelow, redFrom, fullEllipse } [deg].
  constructor(limits) {
    this.limits = limits;
    this.look = 'straight';
  }

  at(tilt) {
    const { greenBelow, redFrom } = this.limits;
    const red = this.look === 'too' ? redFrom - HYSTERESIS_DEG : redFrom;
    const amber = this.look === 'straight' ? greenBelow : greenBelow - HYSTERESIS_DEG;
    this.look = tilt >= red ? 'too' : tilt >= amber ? 'little' : 'straight';
    return this.look;
  }
}

// radius [px]; elongation 0 (circle) .. 1 (full ellipse); direction: screen angle of the long axis [rad].
export function drawCursor(g, x, y, { radius, look, elongation, direction = 0, spraying = false, idle = false }) {
  const shape = idle ? 'straight' : look;
  const colour = idle ? TILT.idle : TILT[look];
  const q = idle ? 0 : Math.min(1, Math.max(0, elongation));
  const a = radius * (1 + 0.55 * q);
  const b = radius * (1 - 0.52 * q);
  const line = Math.max(3, radius / 5);
  g.save();
  g.translate(x, y);
  g.rotate(direction);
  ring(g, a, b, line + 5, WALL.halo);
  if (shape === 'too') ring(g, a + 1.9 * line, b + 1.9 * line, 0.6 * line + 4, WALL.halo);
  if (shape === 'little') brokenRing(g, a, b, line, colour);
  else ring(g, a, b, line, colour);
  if (shape === 'too') ring(g, a + 1.9 * line, b + 1.9 * line, 0.55 * line, colour);
  if (shape !== 'straight') {
    const start = a + (shape === 'too' ? 2.4 : 0.9) * line;
    const ends = shape === 'too' ? [1, -1] : [1];
    g.lineWidth = 0.8 * line;
    g.strokeStyle = colour;
    for (const side of ends) {
      g.beginPath();
      g.moveTo(side * start, 0);
      g.lineTo(side * (start + 0.42 * radius), 0);
      g.stroke();
    }
  }
  g.restore();
  drawCentre(g, x, y, 0.22 * radius, spraying);
}

function ring(g, a, b, width, colour) {
  g.lineWidth = width;
  g.strokeStyle = colour;
  g.beginPath();
  g.ellipse(0, 0, a, b, 0, 0, 2 * Math.PI);
  g.stroke();
}

function brokenRing(g, a, b, width, colour) {
  g.lineWidth = width;
  g.strokeStyle = colour;
  g.lineCap = 'butt';
  for (let quarter = 0; quarter < 4; quarter++) {
    const middle = Math.PI / 4 + (quarter * Math.PI) / 2;
    g.beginPath();
    g.ellipse(0, 0, a, b, 0, middle - 0.62, middle + 0.62);
    g.stroke();
  }
}

function drawCentre(g, x, y, radius, filled) {
  g.beginPath();
  g.arc(x, y, radius, 0, 2 * Math.PI);
  g.lineWidth = 5;
  g.strokeStyle = WALL.halo;
  g.stroke();
  if (filled) {
    g.fillStyle = WALL.hand;
    g.fill();
  } else {
    g.lineWidth = 2;
    g.strokeStyle = WALL.hand;
    g.stroke();
  }
}
