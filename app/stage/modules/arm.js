// The arm as a handful of capsules, from the joint angles. Base frame, metres.

// UR10 (CB3), standard Denavit-Hartenberg parameters.
const A = [0, -0.612, -0.5723, 0, 0, 0];
const D = [0.1273, 0, 0, 0.163941, 0.1157, 0.0922];
const ALPHA = [Math.PI / 2, 0, 0, Math.PI / 2, -Math.PI / 2, 0];

// The tubes stand beside the frames: upper arm and forearm, along the shoulder axis (from the arm's drawings).
const UPPER_ARM_OFFSET = 0.2209;
const FOREARM_OFFSET = 0.049;
export const FLOOR_Z = -0.46;
const TOOL_M = 0.35;
const HANDLE_M = 0.15;

const LIGHT = [0.82, 0.84, 0.85];
const SLATE = [0.36, 0.47, 0.53];
const GREY = [0.5, 0.54, 0.56];
const BLACK = [0.15, 0.17, 0.19];

const along = (p, direction, length) => p.map((v, i) => v + direction[i] * length);
const between = (p, q, share) => p.map((v, i) => v + (q[i] - v) * share);

// Frames 0..6: { o: origin, x, y, z: axes }.
export function frames(q) {
  let R = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  let o = [0, 0, 0];
  const all = [{ o, x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] }];
  for (let i = 0; i < 6; i++) {
    const [c, s, ca, sa] = [Math.cos(q[i]), Math.sin(q[i]), Math.cos(ALPHA[i]), Math.sin(ALPHA[i])];
    const step = [[c, -s * ca, s * sa], [s, c * ca, -c * sa], [0, sa, ca]];
    const shift = [A[i] * c, A[i] * s, D[i]];
    o = o.map((v, k) => v + R[k][0] * shift[0] + R[k][1] * shift[1] + R[k][2] * shift[2]);
    R = R.map((row) => [0, 1, 2].map((j) => row[0] * step[0][j] + row[1] * step[1][j] + row[2] * step[2][j]));
    all.push({ o, x: R.map((r) => r[0]), y: R.map((r) => r[1]), z: R.map((r) => r[2]) });
  }
  return all;
}

export function nozzleTip(q) {
  const flange = frames(q)[6];
  return along(flange.o, flange.z, TOOL_M);
}

// Capsules { a, b, ra, rb, colour }: from a to b with the radii there. The large ones come first: SHADOWS of them are
// enough for the shadow.
export const SHADOWS = 8;

export function capsules(q) {
  const [, f1, f2, f3, f4, f5, f6] = frames(q);
  const axis = f1.z;
  const tube = (a, b, r, colour = LIGHT, rb = r) => ({ a, b, ra: r, rb, colour });
  const grip = along(f6.o, f6.z, HANDLE_M);
  const across = Math.abs(f6.x[2]) > Math.abs(f6.y[2]) ? f6.y : f6.x;
  const upright = across === f6.y ? f6.x : f6.y;
  const handles = [-0.13, 0.13].map((side) => {
    const end = along(grip, across, side);
    return tube(along(end, upright, -0.05), along(end, upright, 0.05), 0.017, BLACK);
  });
  return [
    tube([0, 0, FLOOR_Z], [0, 0, -0.09], 0.082, BLACK),
    tube(along(f1.o, axis, -0.05), along(f1.o, axis, 0.2), 0.073),
    tube(along(f1.o, axis, UPPER_ARM_OFFSET - 0.02), along(f2.o, axis, UPPER_ARM_OFFSET - 0.02), 0.06, LIGHT, 0.054),
    tube(along(f2.o, axis, 0.19), along(f2.o, axis, 0.04), 0.06),
    tube(along(f2.o, axis, FOREARM_OFFSET), along(f3.o, axis, FOREARM_OFFSET), 0.048, LIGHT, 0.043),
    tube(along(f3.o, axis, 0.03), along(f3.o, axis, 0.13), 0.046),
    tube(f5.o, along(f6.o, f6.z, -0.02), 0.043),
    tube(along(f6.o, f6.z, 0.05), along(f6.o, f6.z, 0.3), 0.017, BLACK),
    tube([0, 0, -0.03], [0, 0, 0.1], 0.084, GREY),
    tube(along(f1.o, axis, 0.21), along(f1.o, axis, 0.228), 0.064, SLATE),
    tube(along(f2.o, axis, UPPER_ARM_OFFSET), along(f2.o, axis, UPPER_ARM_OFFSET + 0.002), 0.058, SLATE),
    tube(along(f3.o, axis, 0.014), along(f3.o, axis, 0.022), 0.042, SLATE),
    tube(f4.o, between(f4.o, f5.o, 0.6), 0.045),
    tube(along(f5.o, f6.z, -0.024), along(f5.o, f6.z, -0.012), 0.041, SLATE),
    tube(f6.o, along(f6.o, f6.z, 0.05), 0.036, BLACK),
    tube(along(f6.o, f6.z, 0.3), along(f6.o, f6.z, TOOL_M), 0.012, GREY, 0.009),
    tube(along(grip, across, -0.13), along(grip, across, 0.13), 0.011, BLACK),
    ...handles,
  ];
}
