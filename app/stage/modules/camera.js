// The eye of the robot view: behind the arm and to its right, so that the elbow shows. Base frame, metres.

const EYE = [-0.92, -1.42, 0.88];
const TARGET = [0.62, -0.38, 0.155];
const HALF_HEIGHT = 0.375; // tangent of half the vertical field of view
const NARROW = 1.8; // a narrower view is wider open, so that the arm and the wall stay in it
const NEAR = 0.3;
const FAR = 8;

const minus = (a, b) => a.map((v, i) => v - b[i]);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const unit = (a) => a.map((v) => v / Math.hypot(...a));

const FORWARD = unit(minus(TARGET, EYE));
const RIGHT = unit(cross(FORWARD, [0, 0, 1]));
const UP = cross(RIGHT, FORWARD);

export const eye = EYE;

const halfHeight = (aspect) => HALF_HEIGHT * Math.max(1, NARROW / aspect);

// Column-major projection of the view, as WebGL takes it; aspect = width / height.
export function projection(aspect) {
  const sx = 1 / (halfHeight(aspect) * aspect);
  const sy = 1 / halfHeight(aspect);
  const depth = (FAR + NEAR) / (FAR - NEAR);
  const shift = (-2 * FAR * NEAR) / (FAR - NEAR);
  const rows = [
    [...RIGHT.map((v) => v * sx), -dot(RIGHT, EYE) * sx],
    [...UP.map((v) => v * sy), -dot(UP, EYE) * sy],
    [...FORWARD.map((v) => v * depth), -dot(FORWARD, EYE) * depth + shift],
    [...FORWARD, -dot(FORWARD, EYE)],
  ];
  return new Float32Array([0, 1, 2, 3].flatMap((column) => rows.map((row) => row[column])));
}

// A point on the screen { x, y, distance, scale [px/m] } of a view of that size.
export function project(point, width, height) {
  const d = minus(point, EYE);
  const distance = dot(d, FORWARD);
  const scale = height / (2 * halfHeight(width / height) * distance);
  return { x: width / 2 + dot(d, RIGHT) * scale, y: height / 2 - dot(d, UP) * scale, distance, scale };
}
