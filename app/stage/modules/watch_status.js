// What the page of watched laps says: how much was watched, what plays, what happens next.

import { icon, say, words } from './elements.js';
import { SLOTS } from './stage_layout.js';
import { StageStatus } from './stage_status.js';

export class WatchStatus extends StageStatus {
  // laps: how many there are.
  constructor(parts, texts, unlock, laps) {
    super(parts, texts, unlock);
    this.laps = laps;
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

  showLap(slot, lap, seconds, share) {
    this.showTime(slot, words(this.texts.lap, { lap }), seconds);
    this.parts.laps[lap - 1].style.setProperty('--share', share);
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
