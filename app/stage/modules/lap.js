// A recorded lap as the server sends it: a small header, then rows of 32-bit floats at a fixed rate.
// The same layout is written by app/server/lap_wire.py.

const MAGIC = 0x50414c45; // "ELAP"
const HEADER_BYTES = 24;
const OUTCOMES = ['completed', 'stuck', 'failed'];
const COLUMNS = ['y', 'z', 'tiltY', 'tiltZ', 'handY', 'handZ', 'pull', 'speed', 'spraying', 'moving'];
const JOINTS = 6;
const WIDTH = COLUMNS.length + JOINTS;

export class Lap {
  // bytes: ArrayBuffer.
  constructor(bytes) {
    const header = new DataView(bytes, 0, HEADER_BYTES);
    if (header.getUint32(0, true) !== MAGIC || header.getUint16(6, true) !== WIDTH) {
      throw new Error('this is no recorded lap');
    }
    this.count = header.getUint32(8, true);
    this.hz = header.getFloat32(12, true);
    this.duration = header.getFloat32(16, true);
    this.outcome = OUTCOMES[header.getUint8(20)];
    this.rows = new Float32Array(bytes, HEADER_BYTES, this.count * WIDTH);
  }

  // The state at a time [s]; between two rows it is interpolated. A State is what every source yields:
  // t [s], y z [m], tilt [deg], direction (screen angle of the tilt [rad]), hand { y, z } [m], pull 0..1,
  // speed [m/s], spraying, moving, q (six joint angles [rad]).
  at(t) {
    const place = Math.min(this.count - 1, Math.max(0, t * this.hz));
    const row = Math.min(this.count - 2, Math.floor(place));
    const share = place - row;
    const value = (column) => {
      const i = row * WIDTH + column;
      return this.rows[i] + (this.rows[i + WIDTH] - this.rows[i]) * share;
    };
    const named = Object.fromEntries(COLUMNS.map((name, column) => [name, value(column)]));
    return {
      t,
      y: named.y,
      z: named.z,
      tilt: Math.hypot(named.tiltY, named.tiltZ),
      direction: Math.atan2(-named.tiltZ, -named.tiltY),
      hand: { y: named.handY, z: named.handZ },
      pull: named.pull,
      speed: named.speed,
      spraying: named.spraying > 0.5,
      moving: named.moving > 0.5,
      q: Array.from({ length: JOINTS }, (_, joint) => value(COLUMNS.length + joint)),
    };
  }
}
