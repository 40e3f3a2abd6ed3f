// What the robot page says about itself: how much was watched, what plays, what happens next, when the questions open.

import { icon, say, words } from './elements.js';
import { SLOTS } from './watch_layout.js';

export class WatchStatus {
  // parts: the page's elements; unlock: when the questions open; laps: how many there are.
  constructor(parts, texts, unlock, laps) {
    Object.assign(this, { parts, texts, unlock, laps });
  }

  // slot and lap shown; seen: { A, B } sets of laps; watched: { A, B } [s].
  show({ slot, lap, seen, watched, playing, finished, resetting }) {
    const { parts, texts } = this;
    for (const each of SLOTS) {
      const here = each === slot ? this.#now(playing, resetting) : null;
      say(parts.status[each].text, here ?? this.#before(seen[each].size, watched[each]));
    }
    const again = !playing && finished && lap >= this.laps;
    const does = playing ? texts.pause : again ? texts.again : texts.play;
    parts.play.replaceChildren(icon(playing ? 'pause' : 'play'), does);
    parts.laps.forEach((button, i) => {
      const isNow = i + 1 === lap;
      button.setAttribute('aria-current', String(isNow));
      button.classList.toggle('seen', Boolean(slot) && seen[slot].has(i + 1));
      if (!isNow) button.style.setProperty('--share', 0);
    });
    this.showUnlock(watched);
  }

  showTime(slot, lap, seconds, share) {
    const { chip, laps } = this.parts;
    const whole = Math.floor(seconds);
    say(chip.badge, slot);
    chip.badge.className = `badge small ${slot.toLowerCase()}`;
    say(chip.lap, words(this.texts.lap, { lap }));
    say(chip.time, `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}`);
    laps[lap - 1].style.setProperty('--share', share);
  }

  showUnlock(watched) {
    const { parts, unlock } = this;
    const open = unlock.isOpen(watched);
    say(parts.unlock, unlock.text(watched));
    parts.answer.classList.toggle('primary', open);
    parts.answer.classList.toggle('locked', !open);
    parts.answer.setAttribute('aria-disabled', String(!open));
    parts.answerLock.style.display = open ? 'none' : '';
    for (const slot of SLOTS) {
      const share = unlock.share(watched, slot);
      const { dial, check } = parts.status[slot];
      dial.querySelector('.arc').setAttribute('stroke-dasharray', `${100 * share} 100`);
      dial.style.display = share >= 1 ? 'none' : '';
      check.style.display = share >= 1 ? '' : 'none';
    }
  }

  // outcome: stuck, or failed (the robot stopped by itself). Returns what it says.
  showStuck(outcome, next) {
    const { parts, texts } = this;
    const title = outcome === 'stuck' ? texts.stuck_title : texts.stopped_title;
    parts.veil.hidden = false;
    parts.stuck.hidden = false;
    say(parts.stuck.querySelector('h2'), title);
    say(parts.stuck.querySelector('.next'), next);
    return `${title}. ${texts.stuck_text} ${next}`;
  }

  hideStuck() {
    this.parts.veil.hidden = true;
    this.parts.stuck.hidden = true;
  }

  #now(playing, resetting) {
    if (resetting) return this.texts.being_reset;
    return playing ? this.texts.watching_now : null;
  }

  #before(laps, seconds) {
    const { texts } = this;
    if (laps) return words(laps === 1 ? texts.watched_lap : texts.watched_laps, { laps });
    return seconds > 0 ? texts.watched_a_little : texts.not_watched;
  }
}
