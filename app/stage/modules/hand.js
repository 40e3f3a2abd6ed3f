// The hand and its spring. Stretch is the spring's length; with the pull it gets wider (2 to 4 px) and its coils
// flatter. White whatever the pull: pulling hard isn't wrong.

import { CANVAS_FONT, WALL } from './palette.js';

const HAND_PX = 12;

// From the ring at (x0, y0), radius r0, to the hand at (x1, y1) [px]; pull 0 (none) .. 1 (full).
export function drawHand(g, x0, y0, r0, x1, y1, pull, label = '') {
  const distance = Math.hypot(x1 - x0, y1 - y0);
  if (distance > r0 + HAND_PX + 14) drawSpring(g, x0, y0, x1, y1, distance, r0, pull);
  g.beginPath();
  g.arc(x1, y1, HAND_PX, 0, 2 * Math.PI);
  g.fillStyle = 'rgba(18,26,31,.55)';
  g.fill();
  g.lineWidth = 6;
  g.strokeStyle = WALL.halo;
  g.stroke();
  g.lineWidth = 2.5;
  g.strokeStyle = WALL.hand;
  g.stroke();
  g.beginPath();
  g.arc(x1, y1, 3, 0, 2 * Math.PI);
  g.fillStyle = WALL.hand;
  g.fill();
  if (label) drawLabel(g, x1 + HAND_PX + 9, y1, label);
}

function drawSpring(g, x0, y0, x1, y1, distance, r0, pull) {
  const tension = Math.min(1, Math.max(0, pull));
  const width = 2 + 2 * tension;
  const lead = 7;
  const from = r0 + 1;
  const to = distance - HAND_PX - 2;
  const length = to - from - 2 * lead;
  const coils = length < 12 ? 0 : Math.min(8, Math.max(2, Math.round(length / 11)));
  const height = 8 - 3 * tension;
  const points = [[from, 0], [from + lead, 0]];
  for (let i = 0; i < 2 * coils; i++) {
    points.push([from + lead + (length * (i + 0.5)) / (2 * coils), i % 2 ? height : -height]);
  }
  points.push([to - lead, 0], [to, 0]);
  const ux = (x1 - x0) / distance;
  const uy = (y1 - y0) / distance;
  g.lineJoin = 'round';
  g.lineCap = 'round';
  g.beginPath();
  for (const [along, across] of points) g.lineTo(x0 + ux * along - uy * across, y0 + uy * along + ux * across);
  for (const [w, colour] of [[width + 4, WALL.halo], [width, WALL.hand]]) {
    g.lineWidth = w;
    g.strokeStyle = colour;
    g.stroke();
  }
}

function drawLabel(g, x, y, label) {
  g.font = `500 13px ${CANVAS_FONT}`;
  g.textAlign = 'left';
  g.textBaseline = 'middle';
  g.lineJoin = 'round';
  g.lineWidth = 4;
  g.strokeStyle = WALL.halo;
  g.strokeText(label, x, y);
  g.fillStyle = WALL.hand;
  g.fillText(label, x, y);
}
