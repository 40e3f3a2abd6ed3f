// The mouse: the first button takes the nozzle to where the pointer is, Space or the second button sprays, the wheel
// and four letters tilt.

import { Grip } from './grip.js';
import { HeldKeys, isLetter } from './held_keys.js';
import { Lean } from './lean.js';

const NOTCH_PX = 100;
const NOTCH_DEG = 6;
const LINE_PX = 33; // some browsers count a wheel in lines, three to a notch
const SECOND_BUTTON = 2;

export class Mouse {
  // onChange(): something changed that shouldn't wait to be read.
  constructor(onChange) {
    this.onChange = onChange;
    this.lean = new Lean();
  }

  // sight: { frame: where the wall is on the screen, nozzle: { y, z } where it was drawn last }.
  start(wall, sight) {
    this.wall = wall;
    this.sight = sight;
    this.grip = new Grip(wall, sight, this.onChange);
    this.keys = new HeldKeys(wall, {
      owns: (key) => key === ' ' || isLetter(key),
      onDown: () => this.#keysChanged(),
      onUp: () => this.#keysChanged(),
      late: [' '],
    });
    this.turned = (event) => this.#turn(event);
    wall.addEventListener('wheel', this.turned, { passive: false });
  }

  // Where the hand is [m], the wanted tilt [deg] and the triggers, at a time [ms].
  read(now) {
    const tilt = this.lean.at(now);
    const { hand } = this.grip;
    return {
      ...(hand ?? this.sight.nozzle),
      tiltY: tilt.y,
      tiltZ: tilt.z,
      enable: hand !== null,
      blast: this.keys.has(' ') || (this.grip.buttons & SECOND_BUTTON) !== 0,
    };
  }

  // Lets go of everything; it must be taken anew.
  release() {
    this.grip.release();
    this.keys.release();
    this.lean.release();
  }

  dispose() {
    this.grip.dispose();
    this.keys.dispose();
    this.wall.removeEventListener('wheel', this.turned);
  }

  #keysChanged() {
    const { y, z } = this.keys.letters;
    this.lean.hold(y, z);
    this.onChange();
  }

  // The wheel tilts left and right, with Shift up and down; some browsers make a sideways wheel of it themselves.
  #turn(event) {
    event.preventDefault();
    const unit = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? 1 : LINE_PX;
    const across = event.deltaX * unit;
    const along = event.deltaY * unit;
    const longer = Math.abs(across) > Math.abs(along) ? across : along;
    const notches = Math.min(2, Math.max(-2, longer / NOTCH_PX));
    const [y, z] = event.shiftKey ? [0, -notches] : [-notches, 0];
    this.lean.push(NOTCH_DEG * y, NOTCH_DEG * z, event.timeStamp);
    this.onChange();
  }
}
