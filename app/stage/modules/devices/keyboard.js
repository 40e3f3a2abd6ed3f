// The keyboard alone: arrows take the nozzle and move the hand, Enter takes it and lets it go, Space sprays, four letters
// tilt, Escape lets go of everything. A tap on Space switches the spray; held, it sprays as long as it is down.

import { HeldKeys, isArrow, isLetter } from './held_keys.js';
import { Lean } from './lean.js';
import { Reach } from './reach.js';

const SPEED_M_S = 0.1;
const TAP_MS = 300;
const KEYS = [' ', 'enter', 'escape'];

export class Keyboard {
  constructor(onChange) {
    this.onChange = onChange;
    this.lean = new Lean();
    this.blast = false;
  }

  start(wall, sight) {
    this.reach = new Reach(sight);
    this.keys = new HeldKeys(wall, {
      owns: (key) => KEYS.includes(key) || isArrow(key) || isLetter(key),
      onDown: (key, at) => this.#down(key, at),
      onUp: (key, at) => this.#up(key, at),
    });
  }

  read(now) {
    const { y, z } = this.keys.arrows;
    const speed = SPEED_M_S / (Math.hypot(y, z) || 1);
    const hand = this.reach.at(now, { y: y * speed, z: z * speed });
    const tilt = this.lean.at(now);
    return { ...hand, tiltY: tilt.y, tiltZ: tilt.z, enable: this.reach.isHolding, blast: this.blast };
  }

  release() {
    this.reach.release();
    this.keys.release();
    this.lean.release();
    this.blast = false;
  }

  dispose() {
    this.keys.dispose();
  }

  #down(key, at) {
    if (key === 'escape' || (key === 'enter' && this.reach.isHolding)) this.release();
    else if (key === 'enter' || isArrow(key)) this.reach.take();
    else if (key === ' ') this.#switchSpray(at);
    this.#changed();
  }

  #up(key, at) {
    if (key === ' ' && at - this.switched > TAP_MS) this.blast = false;
    this.#changed();
  }

  #switchSpray(at) {
    this.blast = !this.blast;
    this.switched = at;
  }

  #changed() {
    const { y, z } = this.keys.letters;
    this.lean.hold(y, z);
    this.onChange();
  }
}
