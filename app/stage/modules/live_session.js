// Where the participant is with the robot: which trial is under way, what was stored, and what is waited for.

import { Exposure } from './exposure.js';
import { LiveSource } from './live_source.js';

export class LiveSession {
  // data: the page's; hear: what to do when something happens:
  //   left()            no trial is under way any more: let go
  //   began()           a trial is under way
  //   ended()           a lap has ended; see `ended`
  //   stored()          exposure and laps are as the server has them
  //   away(isAway)      the connection is lost, or back
  //   elsewhere()       another window took over; goOn() comes back
  //   practised()       practice is stored
  //   finished()        everything is stored on the way to the questions
  //   gone()            what was open here is not open any more
  constructor(data, hear) {
    this.hear = hear;
    this.exposure = new Exposure(data.exposure);
    this.laps = { ...data.laps };
    this.slot = null;
    this.trial = null; // { slot, lap } under way
    this.ended = null; // { slot, lap, outcome, until [ms] }: how the last one ended, until the next begins
    this.source = new LiveSource(data.live_address, {
      welcome: (message) => this.#welcome(message),
      trial: (message) => this.#begin(message),
      ended: (message) => this.#end(message),
      stored: (message) => this.#agree(message),
      finished: (message) => this.#finished(message),
      practised: () => this.#practised(),
      elsewhere: () => this.#elsewhere(),
      away: (isAway) => this.#away(isAway),
      gone: () => hear.gone(),
    });
  }

  // Stuck, or stopped by itself: the robot is on its way back to the start.
  get isResetting() {
    return this.ended !== null && this.ended.outcome !== 'completed';
  }

  // A state of the trial under way was taken.
  pass(state) {
    this.exposure.run(this.trial.slot, state.t);
  }

  choose(slot) {
    if (this.isFinishing || this.isElsewhere) return;
    if (slot !== this.slot || !(this.trial || this.ended)) this.#open(slot);
  }

  restart() {
    if (!this.trial) return;
    this.#leave();
    this.source.say({ type: 'restart' });
  }

  finish() {
    this.isFinishing = true;
    this.#leave();
    this.source.say({ type: 'finish' });
  }

  // After another window took over.
  goOn() {
    this.isElsewhere = false;
    this.source.connect();
  }

  #welcome({ slot, exposure, laps }) {
    this.#agree({ exposure, laps });
    if (this.isFinishing) this.source.say({ type: 'finish' });
    else this.#open(this.slot ?? slot ?? 'A');
  }

  #open(slot) {
    this.slot = slot;
    this.#leave();
    this.source.say({ type: 'open', slot });
  }

  #begin({ slot, lap }) {
    this.slot = slot;
    this.trial = { slot, lap };
    this.ended = null;
    this.hear.began();
  }

  #leave() {
    this.exposure.end();
    this.trial = null;
    this.ended = null;
    this.hear.left();
  }

  #end({ slot, outcome, next_in_s: wait }) {
    const lap = this.trial?.lap ?? 1;
    this.#leave();
    if (this.isFinishing) return;
    this.ended = { slot, lap, outcome, until: performance.now() + 1000 * wait };
    this.hear.ended();
  }

  #agree({ exposure, laps }) {
    this.exposure.agree(exposure);
    this.laps = laps ?? this.laps;
    this.hear.stored();
  }

  #finished(message) {
    this.isFinishing = false;
    this.#agree(message);
    this.hear.finished();
  }

  #practised() {
    this.isPractised = true;
    this.hear.practised();
  }

  #elsewhere() {
    this.isElsewhere = true;
    this.#leave();
    this.source.close();
    this.hear.elsewhere();
  }

  #away(isAway) {
    if (isAway) this.#leave();
    this.isAway = isAway;
    this.hear.away(isAway);
  }
}
