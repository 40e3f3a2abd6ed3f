// The devices that the robot can be guided with. Each has
//   start(wall, sight)   the wall's element; sight: { frame, nozzle } as drawn last
//   read(now) -> { y, z, tiltY, tiltZ, enable, blast }
//   release()            lets go of everything at once; it must be taken anew
//   dispose()
// and, if it needs some on the page, an element of its own.

import { Gamepad } from './gamepad.js';
import { Keyboard } from './keyboard.js';
import { Mouse } from './mouse.js';
import { Touch } from './touch.js';

const DEVICES = { mouse: Mouse, keyboard: Keyboard, touch: Touch, gamepad: Gamepad };

// onChange(): the device has news that shouldn't wait to be read.
export function newDevice(name, onChange, texts) {
  return new DEVICES[name](onChange, texts);
}
