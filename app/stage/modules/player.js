// Lets a source run in the page's own time. It stops while the page is hidden: what nobody sees doesn't count.

const LONGEST_STEP_S = 0.5;

export class Player {
  // onStep(step, dt): called at every drawn frame while it plays.
  constructor(source, onStep) {
    this.source = source;
    this.onStep = onStep;
    this.playing = false;
    this.request = 0;
  }

  play() {
    if (this.playing) return;
    this.playing = true;
    this.last = null;
    this.#next();
  }

  pause() {
    this.playing = false;
    cancelAnimationFrame(this.request);
  }

  // One frame without time passing, to draw where the source stands.
  show() {
    this.onStep(this.source.advance(0), 0);
  }

  #next() {
    this.request = requestAnimationFrame((now) => {
      if (!this.playing) return;
      const dt = this.last === null ? 0 : Math.min(LONGEST_STEP_S, (now - this.last) / 1000);
      this.last = now;
      this.onStep(this.source.advance(dt), dt);
      if (this.playing) this.#next();
    });
  }
}
