// What there is to try in practice: a short list that ticks itself off.

import { el, icon, say } from './elements.js';

const MOVED_M = 0.08;
const STRAIGHT_AGAIN_DEG = 4;
const STEPS = ['hold', 'move', 'spray', 'tilt', 'lap'];

export class Practice {
  // texts: the page's; words: those of the device; tilt: { greenBelow } [deg].
  constructor(texts, words, tilt) {
    Object.assign(this, { words, tilt, done: new Set() });
    this.items = STEPS.map((step, i) => {
      const state = el('span.unseen');
      const number = el('i.number', { 'aria-hidden': 'true' }, String(i + 1));
      const item = el('li', {}, number, icon('check'), el('span', {}, texts[`step_${step}`]), state);
      return { step, item, state, done: texts.step_done };
    });
    this.element = el('ol.try', { 'aria-label': texts.steps }, this.items.map(({ item }) => item));
    this.#show();
  }

  // What to do now; nothing once all is done.
  get text() {
    const step = STEPS.find((each) => !this.done.has(each));
    return step ? this.words[`do_${step}`] : '';
  }

  newLap() {
    this.from = null;
  }

  // Looks at a State of the source.
  see(state) {
    this.from ??= { y: state.y, z: state.z };
    if (state.tilt >= this.tilt.greenBelow) this.wasTilted = true;
    const found = {
      hold: state.moving,
      move: Math.hypot(state.y - this.from.y, state.z - this.from.z) > MOVED_M,
      spray: state.spraying,
      tilt: this.wasTilted && state.tilt < STRAIGHT_AGAIN_DEG,
    };
    for (const [step, isDone] of Object.entries(found)) if (isDone) this.tick(step);
  }

  tick(step) {
    if (this.done.has(step)) return;
    this.done.add(step);
    this.#show();
  }

  #show() {
    const now = STEPS.find((each) => !this.done.has(each));
    for (const { step, item, state, done } of this.items) {
      item.className = this.done.has(step) ? 'done' : '';
      if (step === now) item.setAttribute('aria-current', 'step');
      else item.removeAttribute('aria-current');
      say(state, this.done.has(step) ? `, ${done}` : '');
    }
  }
}
