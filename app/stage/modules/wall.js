// The empty wall: panels, the lane of the rectangle, its direction, start and finish.

import { LANE_M } from './frame.js';
import { CANVAS_FONT, WALL } from './palette.js';

const PANEL_M = 0.25;

export function drawWall(g, frame, { chevrons = true } = {}) {
  drawPanels(g, frame);
  const { x0, x1, y0, y1 } = frame.box;
  const lane = LANE_M * frame.scale;
  g.lineJoin = 'round';
  for (const [width, colour] of [[lane + 2, WALL.laneEdge], [lane, WALL.lane]]) {
    g.lineWidth = width;
    g.strokeStyle = colour;
    g.beginPath();
    g.roundRect(x0, y0, x1 - x0, y1 - y0, 3);
    g.stroke();
  }
  if (chevrons) drawChevrons(g, frame);
}

// Start and finish line; with a label (size in px) if it is asked for.
export function drawStart(g, frame, label = '', size = 13) {
  const { x0, y0 } = frame.box;
  const half = (LANE_M * frame.scale) / 2;
  g.strokeStyle = WALL.start;
  g.lineWidth = 3;
  g.lineCap = 'butt';
  g.beginPath();
  g.moveTo(x0 + half + 2, y0 - half);
  g.lineTo(x0 + half + 2, y0 + half);
  g.stroke();
  if (!label) return;
  g.fillStyle = WALL.label;
  g.font = `500 ${size}px ${CANVAS_FONT}`;
  g.textAlign = 'left';
  g.textBaseline = 'alphabetic';
  g.fillText(label, x0 - half, y0 - half - 9);
}

function drawPanels(g, frame) {
  const { width, height } = frame;
  const shade = g.createLinearGradient(0, 0, 0, height);
  shade.addColorStop(0, WALL.top);
  shade.addColorStop(1, WALL.bottom);
  g.fillStyle = shade;
  g.fillRect(0, 0, width, height);
  g.strokeStyle = WALL.seam;
  g.lineWidth = 1;
  const step = PANEL_M * frame.scale;
  g.beginPath();
  for (let x = frame.x(0) % step; x < width; x += step) {
    g.moveTo(Math.round(x) + 0.5, 0);
    g.lineTo(Math.round(x) + 0.5, height);
  }
  for (let y = frame.y(0) % step; y < height; y += step) {
    g.moveTo(0, Math.round(y) + 0.5);
    g.lineTo(width, Math.round(y) + 0.5);
  }
  g.stroke();
}

function drawChevrons(g, frame) {
  const { x0, x1, y0, y1 } = frame.box;
  const size = Math.max(4, frame.scale * 0.009);
  g.strokeStyle = WALL.chevron;
  g.lineWidth = 2;
  g.lineCap = 'round';
  const one = (x, y, angle) => {
    g.save();
    g.translate(x, y);
    g.rotate(angle);
    g.beginPath();
    g.moveTo(-size * 0.6, -size);
    g.lineTo(size * 0.6, 0);
    g.lineTo(-size * 0.6, size);
    g.stroke();
    g.restore();
  };
  for (const share of [0.2, 0.4, 0.6, 0.8]) {
    one(x0 + (x1 - x0) * share, y0, 0);
    one(x1 + (x0 - x1) * share, y1, Math.PI);
  }
  one(x1, (y0 + y1) / 2, Math.PI / 2);
  one(x0, (y0 + y1) / 2, -Math.PI / 2);
}
