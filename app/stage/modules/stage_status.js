// What a robot page says about itself: the lap on the wall, when the questions open, and a notice over the wall.

import { say, words } from './elements.js';
import { SLOTS } from './stage_layout.js';

export class StageStatus {
  // parts: the page's elements; unlock: when the questions open.
  constructor(parts, texts, unlock) {
    Object.assign(this, { parts, texts, unlock });
  }

  // slot: A, B, or null where there is no choice; seconds since the lap began.
  showTime(slot, name, seconds) {
    const { chip } = this.parts;
    const whole = Math.floor(seconds);
    chip.badge.hidden = !slot;
    if (slot) {
      say(chip.badge, slot);
      chip.badge.className = `badge small ${slot.toLowerCase()}`;
    }
    say(chip.lap, name);
    say(chip.time, `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}`);
  }

  // exposure: { A, B } [s].
  showUnlock(exposure) {
    const { parts, unlock } = this;
    const open = unlock.isOpen(exposure);
    say(parts.unlock, unlock.text(exposure));
    parts.answer.classList.toggle('primary', open);
    parts.answer.classList.toggle('locked', !open);
    parts.answer.setAttribute('aria-disabled', String(!open));
    parts.answerLock.style.display = open ? 'none' : '';
    for (const slot of SLOTS) {
      const share = unlock.share(exposure, slot);
      const { dial, check } = parts.status[slot];
      dial.querySelector('.arc').setAttribute('stroke-dasharray', `${100 * share} 100`);
      dial.style.display = share >= 1 ? 'none' : '';
      check.style.display = share >= 1 ? '' : 'none';
    }
  }

  // outcome: stuck, or another one (the robot stopped by itself). Returns what it says.
  showStuck(outcome, next, values = {}) {
    const { texts } = this;
    const title = outcome === 'stuck' ? texts.stuck_title : texts.stopped_title;
    return this.showNotice({ title, text: words(texts.stuck_text, values), next });
  }

  // act: the label of the notice's button, if it has one. Returns what it says.
  showNotice({ title, text, next = '', act = '' }) {
    const { veil, notice } = this.parts;
    veil.hidden = false;
    notice.element.hidden = false;
    notice.icon.style.display = act ? 'none' : '';
    notice.act.hidden = !act;
    say(notice.title, title);
    say(notice.text, text);
    say(notice.next, next);
    say(notice.act, act);
    return `${title}. ${text} ${next}`;
  }

  hideNotice() {
    this.parts.veil.hidden = true;
    this.parts.notice.element.hidden = true;
  }
}
