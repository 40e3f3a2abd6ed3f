// Fingers: one on the wall takes the nozzle to where it is, another one pushes the pad that tilts, a tap switches the spray.

import { el } from '../elements.js';
import { Grip } from './grip.js';
import { Lean } from './lean.js';

export class Touch {
  // texts: { pad, spray }: the labels of what is on the page.
  constructor(onChange, texts) {
    this.onChange = onChange;
    this.lean = new Lean();
    this.blast = false;
    this.knob = el('i.knob');
    this.pad = el('div.pad', { 'aria-hidden': 'true' }, el('span.label', {}, texts.pad), this.knob);
    this.button = el('button.button.switch', { type: 'button', 'aria-pressed': 'false' }, el('i.dot'), texts.spray);
    this.element = el('section.card.touch', {}, this.pad, this.button);
    this.finger = null;
    this.#listen();
  }

  start(wall, sight) {
    this.sight = sight;
    this.grip = new Grip(wall, sight, this.onChange);
  }

  read(now) {
    const tilt = this.lean.at(now);
    const { hand } = this.grip;
    return { ...(hand ?? this.sight.nozzle), tiltY: tilt.y, tiltZ: tilt.z, enable: hand !== null, blast: this.blast };
  }

  release() {
    this.grip.release();
    this.#leave();
    this.lean.release();
    this.#spray(false);
  }

  dispose() {
    this.grip.dispose();
  }

  #listen() {
    const { pad, button } = this;
    pad.addEventListener('pointerdown', (event) => {
      if (this.finger !== null) return;
      this.finger = event.pointerId;
      if (event.isTrusted) pad.setPointerCapture(event.pointerId);
      this.#push(event);
    });
    pad.addEventListener('pointermove', (event) => event.pointerId === this.finger && this.#push(event));
    for (const type of ['pointerup', 'pointercancel', 'lostpointercapture']) {
      pad.addEventListener(type, (event) => event.pointerId === this.finger && this.#leave());
    }
    // A second finger makes no click; a key or a screen reader makes one without a pointer.
    button.addEventListener('pointerdown', (event) => event.isPrimary || this.#spray(!this.blast));
    button.addEventListener('click', () => this.#spray(!this.blast));
  }

  #push(event) {
    const box = this.pad.getBoundingClientRect();
    const radius = Math.min(box.width, box.height) / 2;
    const x = (event.clientX - box.left - box.width / 2) / radius;
    const y = (event.clientY - box.top - box.height / 2) / radius;
    const far = Math.max(1, Math.hypot(x, y));
    this.#show(x / far, y / far);
    this.lean.hold(-x / far, -y / far);
    this.onChange();
  }

  #leave() {
    this.finger = null;
    this.#show(0, 0);
    this.lean.hold(0, 0);
    this.onChange();
  }

  #show(x, y) {
    this.knob.style.setProperty('--x', x);
    this.knob.style.setProperty('--y', y);
  }

  #spray(isOn) {
    this.blast = isOn;
    this.button.setAttribute('aria-pressed', String(isOn));
    this.onChange();
  }
}
