// What the page of a guided robot says: how long each method was in hand, who holds the robot, what happens next.

import { say, words } from './elements.js';
import { SLOTS } from './stage_layout.js';
import { StageStatus } from './stage_status.js';

export class GuideStatus extends StageStatus {
  // session: a LiveSession.
  showMethods(session) {
    const { parts, texts } = this;
    const { slot, laps, isResetting } = session;
    const exposure = session.exposure.total;
    const now = isResetting ? texts.being_reset : session.trial ? texts.guiding_now : null;
    for (const each of SLOTS) {
      const here = each === slot ? now : null;
      say(parts.status[each].text, here ?? this.#before(laps[each], exposure[each]));
    }
    parts.restart.classList.toggle('locked', !session.trial);
    parts.restart.setAttribute('aria-disabled', String(!session.trial));
    this.showUnlock(exposure);
  }

  // seconds of the lap on the wall.
  showLap(session, seconds, isPractice) {
    const { slot, lap } = session.trial ?? session.ended ?? session;
    const name = lap ? words(this.texts.lap, { lap }) : '';
    this.showTime(isPractice ? null : slot, isPractice ? this.texts.practice_title : name, seconds);
  }

  showTriggers({ moves, sprays }) {
    const { parts, texts } = this;
    parts.moves.element.classList.toggle('on', moves);
    parts.sprays.element.classList.toggle('on', sprays);
    say(parts.moves.text, moves ? texts.robot_moves : texts.robot_waits);
    say(parts.sprays.text, sprays ? texts.spray_on : texts.spray_off);
  }

  // What comes after a lap that ended, and when.
  next({ outcome, slot, lap, until }, isPractice) {
    const seconds = Math.max(1, Math.ceil((until - performance.now()) / 1000));
    const key = outcome === 'completed' ? 'lap_done' : isPractice ? 'practice_again' : 'again';
    return words(this.texts[seconds === 1 ? `${key}_one` : key], { slot, lap, seconds });
  }

  #before(laps, seconds) {
    const { texts } = this;
    if (laps) return words(laps === 1 ? texts.guided_lap : texts.guided_laps, { laps });
    return seconds > 0 ? texts.guided_a_little : texts.not_guided;
  }
}
