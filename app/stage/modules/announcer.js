// What the canvases show, in words for those who don't see them: at most one message in two seconds, the newest.

import { el } from './elements.js';

const PAUSE_MS = 2000;

export class Announcer {
  constructor() {
    this.polite = el('div.unseen', { 'aria-live': 'polite', role: 'status' });
    this.assertive = el('div.unseen', { 'aria-live': 'assertive', role: 'alert' });
    this.element = el('div', {}, this.polite, this.assertive);
    this.spoken = -Infinity;
    this.timer = 0;
  }

  say(text) {
    if (text === this.waiting || (!this.waiting && text === this.polite.textContent)) return;
    this.waiting = text;
    if (this.timer) return;
    const wait = Math.max(0, this.spoken + PAUSE_MS - performance.now());
    this.timer = setTimeout(() => {
      this.polite.textContent = this.waiting;
      this.waiting = null;
      this.timer = 0;
      this.spoken = performance.now();
    }, wait);
  }

  interrupt(text) {
    this.assertive.textContent = text;
  }

  dispose() {
    clearTimeout(this.timer);
  }
}
