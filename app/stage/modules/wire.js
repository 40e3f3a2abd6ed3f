// The binary frames of a live trial, little-endian. The same layouts are in app/server/live/wire.py.

const VERSION = 1;
const INPUT = 1;
const STATE = 2;
const STROKES = 3;
const INPUT_BYTES = 40;
const STATE_BYTES = 80;
const STROKES_HEAD_BYTES = 12;
const POINT_BYTES = 16;
const JOINTS = 6;

const ENABLE = 1;
const BLAST = 2;
export const DEVICES = ['mouse', 'keyboard', 'touch', 'gamepad'];

// input: { y, z [m], tiltY, tiltZ [deg], enable, blast }; device: its name; latency [ms], -1 for none.
export function packInput(input, { device, seq, latency, frames, clock }) {
  const bytes = new DataView(new ArrayBuffer(INPUT_BYTES));
  bytes.setUint8(0, INPUT);
  bytes.setUint8(1, VERSION);
  bytes.setUint8(2, (input.enable ? ENABLE : 0) | (input.blast ? BLAST : 0));
  bytes.setUint8(3, DEVICES.indexOf(device));
  bytes.setUint32(4, seq, true);
  [input.y, input.z, input.tiltY, input.tiltZ, latency].forEach((v, i) => bytes.setFloat32(8 + 4 * i, v, true));
  bytes.setUint32(28, frames, true);
  bytes.setFloat64(32, clock, true);
  return bytes.buffer;
}

// A State (see lap.js) and where it belongs, or { trial, first, points }; null for what is neither.
export function unpack(buffer) {
  const bytes = new DataView(buffer);
  if (buffer.byteLength < STROKES_HEAD_BYTES || bytes.getUint8(1) !== VERSION) return null;
  const kind = bytes.getUint8(0);
  if (kind === STATE && buffer.byteLength === STATE_BYTES) return { state: unpackState(bytes) };
  if (kind === STROKES) return { strokes: unpackStrokes(bytes) };
  return null;
}

function unpackState(bytes) {
  const flags = bytes.getUint8(2);
  const float = (i) => bytes.getFloat32(16 + 4 * i, true);
  const [t, y, z, tiltY, tiltZ, handY, handZ, pull, speed, share] = Array.from({ length: 10 }, (_, i) => float(i));
  return {
    trial: bytes.getUint32(4, true),
    frame: bytes.getUint32(8, true),
    inputSeq: bytes.getUint32(12, true),
    t,
    y,
    z,
    tilt: Math.hypot(tiltY, tiltZ),
    direction: Math.atan2(-tiltZ, -tiltY),
    hand: { y: handY, z: handZ },
    pull,
    speed,
    share,
    moving: (flags & 1) !== 0,
    spraying: (flags & 2) !== 0,
    resting: (flags & 4) !== 0,
    ended: (flags & 8) !== 0,
    q: Array.from({ length: JOINTS }, (_, joint) => float(10 + joint)),
  };
}

function unpackStrokes(bytes) {
  const float = (point, i) => bytes.getFloat32(STROKES_HEAD_BYTES + POINT_BYTES * point + 4 * i, true);
  const points = Array.from({ length: bytes.getUint16(2, true) }, (_, point) => ({
    y: float(point, 0),
    z: float(point, 1),
    speed: float(point, 2),
    lifted: float(point, 3) > 0.5,
  }));
  return { trial: bytes.getUint32(4, true), first: bytes.getUint32(8, true), points };
}
