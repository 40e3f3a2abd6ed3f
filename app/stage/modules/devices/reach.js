// A hand that is moved at a rate, as with arrows or a stick: it starts at the nozzle and never gets far from it, so that
// it is at hand again as soon as the other way is pushed.

const FARTHEST_M = 0.35;
const LONGEST_STEP_S = 0.1;

export class Reach {
  constructor(sight) {
    this.sight = sight;
    this.release();
  }

  get isHolding() {
    return this.hand !== null;
  }

  take() {
    if (this.hand) return;
    this.hand = { ...this.sight.nozzle };
    this.time = performance.now();
  }

  release() {
    this.hand = null;
  }

  // velocity { y, z } [m/s]; now [ms]. Returns where the hand is.
  at(now, velocity) {
    const { nozzle } = this.sight;
    if (!this.hand) return nozzle;
    const dt = Math.min(LONGEST_STEP_S, Math.max(0, now - this.time) / 1000);
    this.time = Math.max(this.time, now);
    const dy = this.hand.y + velocity.y * dt - nozzle.y;
    const dz = this.hand.z + velocity.z * dt - nozzle.z;
    const share = Math.min(1, FARTHEST_M / (Math.hypot(dy, dz) || 1));
    this.hand = { y: nozzle.y + dy * share, z: nozzle.z + dz * share };
    return this.hand;
  }
}
