// The robot page of a comparison: method A and B on the same wall, watched as often as wanted.

import { Announcer } from './announcer.js';
import { mount } from './component.js';
import { say, words } from './elements.js';
import { Player } from './player.js';
import { radioGroup } from './radio_group.js';
import { Scene } from './scene.js';
import { RecordedSource } from './source.js';
import { SLOTS } from './stage_layout.js';
import { Unlock } from './unlock.js';
import { watchLayout } from './watch_layout.js';
import { WatchLog } from './watch_log.js';
import { WatchStatus } from './watch_status.js';

const RESET_S = 4;
const NEXT_LAP_S = 1.5;

export default function (component) {
  return mount(component, (root, { data, setTriggerValue }) => {
    const page = new WatchPage(root, data, setTriggerValue);
    page.start();
    return page;
  });
}

class WatchPage {
  constructor(root, data, setTriggerValue) {
    this.data = data;
    this.texts = data.texts;
    this.root = root;
    this.tell = setTriggerValue;
    this.parts = watchLayout(data);
    root.append(this.parts.page);
    this.scene = new Scene(root, this.parts, data);
    this.parts.card.append(this.scene.gauges.element, this.parts.controls);
    this.announcer = new Announcer();
    root.append(this.announcer.element);
    this.unlock = new Unlock(data.required_s, this.texts.unlock);
    this.status = new WatchStatus(this.parts, this.texts, this.unlock, data.laps);
    this.log = new WatchLog({
      address: data.watched_address,
      comparison: data.comparison,
      watched: data.watched,
      runs: data.runs,
      switches: data.switches,
      onTrouble: (what) => this.#trouble(what),
    });
    this.seen = { A: new Set(data.seen.A), B: new Set(data.seen.B) };
    this.source = new RecordedSource((slot, lap) => `${data.laps_address}/${slot}/${lap}`);
    this.player = new Player(this.source, (step, dt) => this.#step(step, dt));
    this.lap = { A: 1, B: 1 };
    this.slot = null;
    this.timers = new Set();
    this.#listen();
  }

  async start() {
    this.#showStatus();
    const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
    await this.#choose('A', { play: !still, isFirst: true });
    for (const lap of this.parts.laps.keys()) for (const slot of SLOTS) this.source.prepare(slot, lap + 1);
  }

  update() {
    this.#redraw();
  }

  dispose() {
    this.gone = true;
    this.log.leave();
    this.player.pause();
    this.#clearTimers();
    this.announcer.dispose();
    this.scene.dispose();
    this.resizing.disconnect();
    for (const [target, type, act] of this.listeners) target.removeEventListener(type, act);
  }

  #listen() {
    const { parts } = this;
    this.methods = radioGroup(parts.methods, {
      label: this.texts.method,
      options: parts.options,
      chosen: null,
      onChoose: (slot) => this.#choose(slot),
    });
    parts.restart.addEventListener('click', () => this.#open(this.lap[this.slot]));
    parts.play.addEventListener('click', () => this.#toggle());
    parts.answer.addEventListener('click', () => this.#answer());
    parts.laps.forEach((button, i) => button.addEventListener('click', () => this.#open(i + 1)));
    parts.wall.addEventListener('keydown', (event) => this.#key(event));
    this.listeners = [
      [document, 'visibilitychange', () => document.hidden && this.#pause()],
      [window, 'pagehide', () => this.log.leave()],
    ];
    for (const [target, type, act] of this.listeners) target.addEventListener(type, act);
    this.resizing = new ResizeObserver(() => this.#redraw());
    this.resizing.observe(parts.wall);
  }

  #key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target !== this.parts.wall) return;
    const acts = {
      ' ': () => this.#toggle(),
      a: () => this.#choose('A'),
      b: () => this.#choose('B'),
      r: () => this.#open(this.lap[this.slot]),
    };
    const act = acts[event.key.toLowerCase()];
    if (!act) return;
    event.preventDefault();
    act();
  }

  // The first lap with a method that was not yet seen to its end comes first.
  async #choose(slot, { play = true, isFirst = false } = {}) {
    if (slot === this.slot) {
      if (!this.player.playing && play) this.#play();
      return;
    }
    this.log.end();
    this.slot = slot;
    this.methods.choose(slot);
    if (!isFirst || play) this.log.switchTo(slot);
    const lap = this.parts.laps.findIndex((_, i) => !this.seen[slot].has(i + 1));
    await this.#open(lap < 0 ? 1 : lap + 1, { play });
  }

  async #open(lap, { play = true } = {}) {
    const { slot } = this;
    this.player.pause();
    this.log.end();
    this.#clearTimers();
    this.lap[slot] = lap;
    this.finished = false;
    this.scene.newLap();
    this.#showStuck(null);
    this.#showStatus();
    this.opening = `${slot}${lap}`;
    const slow = setTimeout(() => say(this.parts.message, this.texts.loading), 300);
    try {
      await this.source.open(slot, lap);
    } catch {
      if (this.opening === `${slot}${lap}`) {
        say(this.parts.message, this.texts.offline);
        this.#later(3, () => this.#open(lap, { play }));
      }
      return;
    } finally {
      clearTimeout(slow);
    }
    if (this.opening !== `${slot}${lap}` || this.gone) return;
    say(this.parts.message, play ? '' : this.texts.intro);
    this.player.show();
    if (play) this.#play();
  }

  #play() {
    if (this.finished) {
      this.#open(this.seen[this.slot].size >= this.data.laps ? 1 : this.lap[this.slot]);
      return;
    }
    if (!this.log.run) this.log.begin(this.slot, this.lap[this.slot]);
    say(this.parts.message, '');
    this.player.play();
    this.#showStatus();
  }

  #pause() {
    if (!this.player.playing) return;
    this.player.pause();
    this.#showStatus();
  }

  #toggle() {
    if (this.player.playing) this.#pause();
    else this.#play();
  }

  #step(step, dt) {
    this.log.pass(dt);
    this.scene.spray(step.sprayed);
    this.#draw(step);
    this.status.showLap(this.slot, this.lap[this.slot], step.state.t, step.share);
    this.status.showUnlock(this.log.watched);
    if (step.ended && !this.finished) this.#end(step.ended);
  }

  #redraw() {
    if (this.shown) this.#draw(this.shown);
  }

  #draw(step) {
    this.shown = step;
    const said = this.scene.draw(step.state);
    if (this.player.playing) {
      this.announcer.say(words(this.texts.twin, { slot: this.slot, lap: this.lap[this.slot], ...said }));
    }
  }

  #end(outcome) {
    const { slot, texts } = this;
    const lap = this.lap[slot];
    this.player.pause();
    this.finished = true;
    this.log.end();
    this.seen[slot].add(lap);
    const isLast = lap >= this.data.laps;
    const other = slot === 'A' ? 'B' : 'A';
    const all = words(this.seen[other].size ? texts.laps_done : texts.laps_done_other, { slot, other });
    if (outcome === 'completed') {
      say(this.parts.message, isLast ? all : words(texts.lap_done, { lap, next: lap + 1 }));
    } else {
      const still = { moving: false, spraying: false, pull: 0, speed: 0 };
      this.shown = { ...this.shown, state: { ...this.shown.state, ...still } };
      this.scene.gauges.speakNow();
      this.#redraw();
      this.#showStuck(outcome, isLast ? all : words(texts.next_lap_in, { lap: lap + 1, slot, seconds: RESET_S }));
    }
    this.#showStatus();
    const wait = outcome === 'completed' ? NEXT_LAP_S : RESET_S;
    this.#later(wait, () => {
      this.#showStuck(null);
      if (!isLast) this.#open(lap + 1);
      else say(this.parts.message, all);
      this.#showStatus();
    });
  }

  async #answer() {
    if (!this.unlock.isOpen(this.log.watched)) {
      this.announcer.interrupt(this.unlock.text(this.log.watched));
      return;
    }
    this.#pause();
    this.log.end();
    await this.log.send();
    if (this.unlock.isOpen(this.log.watched)) this.tell('answer', this.data.comparison);
  }

  #showStatus() {
    const { slot, seen, finished, resetting } = this;
    const { watched } = this.log;
    this.status.show({ slot, lap: this.lap[slot], seen, watched, playing: this.player.playing, finished, resetting });
  }

  // outcome: stuck or failed; null hides the message.
  #showStuck(outcome, next) {
    this.resetting = outcome !== null;
    if (this.resetting) this.announcer.interrupt(this.status.showStuck(outcome, next));
    else this.status.hideNotice();
  }

  #trouble(what) {
    if (what === 'moved') this.tell('moved', this.data.comparison);
    this.parts.trouble.hidden = what !== 'offline';
    if (what === 'offline') say(this.parts.trouble, this.texts.offline);
    this.#showStatus();
  }

  #later(seconds, act) {
    const timer = setTimeout(() => {
      this.timers.delete(timer);
      act();
    }, 1000 * seconds);
    this.timers.add(timer);
  }

  #clearTimers() {
    for (const timer of this.timers) clearTimeout(timer);
    this.timers.clear();
  }
}
