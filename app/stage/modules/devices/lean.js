// The wanted tilt of the nozzle: it follows what is pushed, and springs back as soon as nothing is.

export const LIMIT_DEG = 25;
const RATE_DEG_S = 80;
const MOMENT_MS = 180; // between two notches of a wheel
const LONGEST_STEP_S = 0.1;

export class Lean {
  constructor() {
    this.release();
  }

  // Pushed as long as it is held: shares of the limit along base y (left) and z (up), -1..1.
  hold(y, z) {
    const long = Math.max(1, Math.hypot(y, z));
    this.held = { y: (LIMIT_DEG * y) / long, z: (LIMIT_DEG * z) / long };
  }

  // Pushed once, by degrees, as a wheel does.
  push(y, z, now) {
    this.at(now);
    this.#set(this.y + y, this.z + z);
    this.restsUntil = now + MOMENT_MS;
  }

  release() {
    Object.assign(this, { y: 0, z: 0, held: { y: 0, z: 0 }, restsUntil: -Infinity, time: performance.now() });
  }

  // The wanted tilt { y, z } [deg] at a time [ms].
  at(now) {
    const dt = Math.min(LONGEST_STEP_S, Math.max(0, now - this.time) / 1000);
    this.time = Math.max(this.time, now);
    const { held } = this;
    const isHeld = held.y !== 0 || held.z !== 0;
    if (isHeld || now > this.restsUntil) this.#approach(held, RATE_DEG_S * dt);
    return { y: this.y, z: this.z };
  }

  #approach(wanted, most) {
    const dy = wanted.y - this.y;
    const dz = wanted.z - this.z;
    const share = Math.min(1, most / (Math.hypot(dy, dz) || 1));
    this.#set(this.y + dy * share, this.z + dz * share);
  }

  #set(y, z) {
    const share = Math.min(1, LIMIT_DEG / (Math.hypot(y, z) || 1));
    this.y = y * share;
    this.z = z * share;
  }
}
