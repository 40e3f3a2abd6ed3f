// When the questions open: after a least time with A and with B. Says what is still missing.

import { words } from './elements.js';

const ROUNDING_S = 0.02; // less than the server allows for

export class Unlock {
  constructor(requiredS, texts) {
    this.required = requiredS;
    this.texts = texts;
  }

  // watched: { A, B } [s].
  missing(watched) {
    return { A: Math.ceil(this.required - watched.A - ROUNDING_S), B: Math.ceil(this.required - watched.B - ROUNDING_S) };
  }

  isOpen(watched) {
    const { A, B } = this.missing(watched);
    return A <= 0 && B <= 0;
  }

  // Share of the least time with a method, 0..1.
  share(watched, slot) {
    return this.required > 0 ? Math.min(1, watched[slot] / this.required) : 1;
  }

  text(watched) {
    const { A, B } = this.missing(watched);
    if (A <= 0 && B <= 0) return this.texts.open;
    if (A > 0 && B > 0) return words(this.texts.both, { a: A, b: B });
    const [seconds, slot] = A > 0 ? [A, 'A'] : [B, 'B'];
    return words(seconds === 1 ? this.texts.one_second : this.texts.one, { seconds, slot });
  }
}
