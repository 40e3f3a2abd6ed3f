// Nozzle, speed and pull beside the robot. Words change at most twice a second.

import { drawCursor } from './cursor.js';
import { el, say } from './elements.js';
import { fitted } from './frame.js';
import { WALL } from './palette.js';

const STANDING_M_S = 0.01;
const SLOW_M_S = 0.04; // below it the robot creeps; untuned
const PULL = [[0.05, 'none'], [0.4, 'light'], [0.9, 'strong'], [Infinity, 'full']];
const WORD_MS = 500;
const NOZZLE_PX = 17; // with ticks all around it just fits

export class Gauges {
  // limits: { solidUpTo, faintFrom } [m/s]; texts: the gauges' words.
  constructor(limits, texts) {
    this.limits = limits;
    this.texts = texts;
    this.most = 0;
    this.changed = -Infinity;
    this.nozzle = el('canvas', { 'aria-hidden': 'true' });
    this.nozzleWord = el('span.value');
    this.speed = gauge(texts.speed, [texts.slow, texts.solid_line, texts.too_fast]);
    this.pull = gauge(texts.pull, [texts.pull_low, texts.most_in_this_lap, texts.pull_high]);
    this.speed.track.append(el('i.window'), el('i.mark'));
    this.pull.track.append(el('i.fill'), el('i.most'));
    const percent = (speed) => `${(100 * speed) / limits.faintFrom}%`;
    this.speed.track.style.setProperty('--from', percent(SLOW_M_S));
    this.speed.track.style.setProperty('--to', percent(limits.solidUpTo));
    this.element = el(
      'div.gauges',
      {},
      el('div.nozzle', {}, el('span.label', {}, texts.nozzle), this.nozzle, this.nozzleWord),
      el('div.bars', {}, this.speed.element, this.pull.element),
    );
  }

  newLap() {
    this.most = 0;
  }

  // The next words don't wait for their turn: what stands still must not say otherwise.
  speakNow() {
    this.words = null;
  }

  // look: how the cursor looks. Returns the words shown.
  draw(state, look, now = performance.now()) {
    const { texts, limits } = this;
    this.most = Math.max(this.most, state.pull);
    this.#drawNozzle(look);
    const share = Math.min(1, state.speed / limits.faintFrom);
    this.speed.track.style.setProperty('--at', `${100 * share}%`);
    this.pull.track.style.setProperty('--at', `${100 * Math.min(1, state.pull)}%`);
    this.pull.track.style.setProperty('--most', `${100 * Math.min(1, this.most)}%`);
    if (!this.words || now - this.changed >= WORD_MS) {
      this.words = {
        nozzle: look.idle ? texts.waiting : { straight: texts.straight, little: texts.little, too: texts.too }[look.look],
        speed: this.#speedWord(state),
        pull: texts[PULL.find(([limit]) => state.pull < limit)[1]],
      };
      this.changed = now;
      say(this.nozzleWord, this.words.nozzle);
      say(this.speed.word, this.words.speed);
      say(this.pull.word, this.words.pull);
    }
    return this.words;
  }

  #speedWord({ speed, moving }) {
    const { texts, limits } = this;
    if (!moving || speed < STANDING_M_S) return texts.stopped;
    if (speed < SLOW_M_S) return texts.slow_now;
    if (speed <= limits.solidUpTo) return texts.just_right;
    return speed < limits.faintFrom ? texts.a_bit_fast : texts.too_fast_now;
  }

  #drawNozzle(look) {
    const view = fitted(this.nozzle);
    if (!view) return;
    const { context: g, width, height } = view;
    g.fillStyle = WALL.bottom;
    g.fillRect(0, 0, width, height);
    drawCursor(g, width / 2, height / 2, { ...look, radius: NOZZLE_PX });
  }
}

function gauge(name, [low, middle, high]) {
  const word = el('span.value');
  const track = el('div.track', { 'aria-hidden': 'true' });
  const element = el(
    'div.gauge',
    {},
    el('div.ends', {}, el('span.label', {}, name), word),
    track,
    el('div.ends.tiny', { 'aria-hidden': 'true' }, el('span', {}, low), el('span', {}, middle), el('span', {}, high)),
  );
  return { element, track, word };
}
