// A gamepad: the left trigger takes the nozzle, the left stick moves the hand, the right trigger sprays, the right stick
// tilts. It is asked at every reading, since it tells nothing by itself.

import { Lean } from './lean.js';
import { Reach } from './reach.js';

const SPEED_M_S = 0.15;
const DEAD = 0.15;
const PRESSED = 0.35;
const RELEASED = 0.2;
const LEFT_TRIGGER = 6;
const RIGHT_TRIGGER = 7;

// A stick's push, -1..1 to the right and down, without its dead zone.
export function stick(x, y) {
  const push = Math.hypot(x, y);
  if (push <= DEAD) return { x: 0, y: 0 };
  const share = Math.min(1, (push - DEAD) / (1 - DEAD)) / push;
  return { x: x * share, y: y * share };
}

export class Gamepad {
  constructor() {
    this.lean = new Lean();
    this.pressed = [];
    this.mustLetGo = false;
  }

  start(wall, sight) {
    this.reach = new Reach(sight);
  }

  read(now) {
    // Some browsers have none on a page without TLS that comes from another machine.
    const pads = navigator.getGamepads?.() ?? [];
    const pad = pads.find((each) => each?.connected && each.axes.length >= 4);
    this.isMissing = !pad;
    const [moveX, moveY, tiltX, tiltY] = pad?.axes ?? [0, 0, 0, 0];
    const holds = this.#isPressed(pad, LEFT_TRIGGER);
    const blast = this.#isPressed(pad, RIGHT_TRIGGER);
    if (!holds) this.mustLetGo = false;
    if (holds && !this.mustLetGo) this.reach.take();
    else this.reach.release();
    const move = stick(moveX, moveY);
    const push = stick(tiltX, tiltY);
    const hand = this.reach.at(now, { y: -SPEED_M_S * move.x, z: -SPEED_M_S * move.y });
    this.lean.hold(-push.x, -push.y);
    const tilt = this.lean.at(now);
    return { ...hand, tiltY: tilt.y, tiltZ: tilt.z, enable: this.reach.isHolding, blast };
  }

  // The trigger must be let go before it takes the nozzle again.
  release() {
    this.reach.release();
    this.lean.release();
    this.mustLetGo = true;
  }

  dispose() {}

  #isPressed(pad, button) {
    const value = pad?.buttons[button]?.value ?? 0;
    this.pressed[button] = value > (this.pressed[button] ? RELEASED : PRESSED);
    return this.pressed[button];
  }
}
