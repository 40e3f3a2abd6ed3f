// The page where a person guides the robot: method A and B on the same wall, or a lap of practice.

import { Announcer } from './announcer.js';
import { mount } from './component.js';
import { newDevice } from './devices/choice.js';
import { say, words } from './elements.js';
import { guideLayout } from './guide_layout.js';
import { GuideStatus } from './guide_status.js';
import { InputPump } from './input_pump.js';
import { Latency } from './latency.js';
import { LiveSession } from './live_session.js';
import { Practice } from './practice.js';
import { radioGroup } from './radio_group.js';
import { Scene } from './scene.js';
import { Unlock } from './unlock.js';

const STILL = { moving: false, spraying: false, pull: 0, speed: 0 };
const PATIENCE_MS = 300; // a wait that is over sooner isn't worth a word
const COUNT_MS = 250;

export default function (component) {
  return mount(component, (root, { data, setTriggerValue }) => {
    const page = new GuidePage(root, data, setTriggerValue);
    page.start();
    return page;
  });
}

class GuidePage {
  constructor(root, data, tell) {
    Object.assign(this, { data, tell, texts: data.texts, words: data.texts[data.device] });
    this.device = newDevice(data.device, (at) => this.pump.poke(at), this.words);
    this.practice = data.practice ? new Practice(this.texts, this.words, data.tilt) : null;
    this.parts = guideLayout(data, this.words, { device: this.device.element, practice: this.practice });
    root.append(this.parts.page);
    this.scene = new Scene(root, this.parts, data);
    this.parts.card.append(this.scene.gauges.element, this.parts.triggers);
    this.announcer = new Announcer();
    root.append(this.announcer.element);
    this.unlock = new Unlock(data.required_s, this.texts.unlock);
    this.status = new GuideStatus(this.parts, this.texts, this.unlock);
    this.latency = new Latency();
    this.frames = 0;
    this.quietSince = performance.now();
    this.session = new LiveSession(data, {
      left: () => this.#leave(),
      began: () => this.#begin(),
      ended: () => this.#end(),
      stored: () => this.update(),
      away: (isAway) => this.#away(isAway),
      elsewhere: () => this.#elsewhere(),
      practised: () => this.#practised(),
      finished: () => this.#finished(),
      gone: () => tell('moved', data.comparison || true),
    });
    this.pump = new InputPump((now, since) => this.#send(now, since));
    this.#atStart();
    this.#listen();
  }

  start() {
    const page = this;
    this.scene.drawEmpty();
    this.device.start(this.parts.wall, {
      get frame() {
        return page.scene.wall.frame;
      },
      get nozzle() {
        return { y: page.state.y, z: page.state.z };
      },
    });
    this.session.source.connect();
    this.#frame();
  }

  update() {
    this.isStale = true;
  }

  dispose() {
    cancelAnimationFrame(this.request);
    clearInterval(this.counting);
    this.pump.stop();
    this.session.source.close();
    this.device.dispose();
    this.announcer.dispose();
    this.scene.dispose();
    this.resizing.disconnect();
    for (const [target, type, act] of this.listeners) target.removeEventListener(type, act);
  }

  #listen() {
    const { parts, session } = this;
    if (!this.practice) {
      this.methods = radioGroup(parts.methods, {
        label: this.texts.method,
        options: parts.options,
        chosen: null,
        onChoose: (slot) => session.choose(slot),
      });
      parts.restart.addEventListener('click', () => session.restart());
      parts.answer.addEventListener('click', () => this.#answer());
    }
    parts.notice.act.addEventListener('click', () => this.onNotice());
    parts.wall.addEventListener('keydown', (event) => this.#key(event));
    const letGo = () => this.#letGo();
    this.listeners = [
      [window, 'blur', letGo],
      [window, 'pagehide', letGo],
      [document, 'visibilitychange', () => this.#showOrHide()],
    ];
    for (const [target, type, act] of this.listeners) target.addEventListener(type, act);
    this.resizing = new ResizeObserver(() => this.update());
    this.resizing.observe(parts.wall);
    this.counting = setInterval(() => this.#countDown(), COUNT_MS);
  }

  #key(event) {
    if (this.data.device !== 'keyboard' || event.ctrlKey || event.altKey || event.metaKey || event.repeat) return;
    const key = event.key.toLowerCase();
    if (key === 'r') this.session.restart();
    if ('12'.includes(key) && !this.practice) this.session.choose(key === '1' ? 'A' : 'B');
  }

  // One picture: the newest state, and the hand where it is by now.
  #frame() {
    this.request = requestAnimationFrame(() => this.#frame());
    this.frames += 1;
    const { trial, source } = this.session;
    const { state } = source;
    const points = source.takePoints();
    if (trial && state && state !== this.state) this.#take(state);
    const input = trial ? this.device.read(performance.now()) : null;
    this.scene.spray(points);
    if (this.isStale || points.length || input?.enable) this.#draw(input);
    if (state) this.latency.drew(state.inputSeq, performance.now());
    this.#say(input);
  }

  #take(state) {
    this.isStale = true;
    this.state = state;
    this.session.pass(state);
    this.practice?.see(state);
  }

  #draw(input) {
    const { state } = this;
    const holds = Boolean(input?.enable);
    const hand = holds ? { y: input.y, z: input.z } : state.hand;
    const handLabel = this.practice ? this.texts.hand : '';
    const said = this.scene.draw(state, { ...state, hand, handLabel, moving: holds });
    this.parts.page.classList.toggle('holding', holds);
    this.status.showTriggers({ moves: state.moving, sprays: state.spraying });
    this.status.showLap(this.session, state.t, this.practice !== null);
    if (!this.practice) this.status.showMethods(this.session);
    if (state.moving) {
      const twin = this.practice ? this.texts.twin_practice : this.texts.twin;
      this.announcer.say(words(twin, { ...this.session.trial, ...said }));
    }
    // A hand that was let go is taken away by one more picture.
    this.isStale = holds;
  }

  // The message in the middle of the wall.
  #say(input) {
    const text = this.#message(input);
    if (text && text !== this.parts.message.textContent) this.announcer.say(text);
    say(this.parts.message, text);
  }

  #message(input) {
    const { texts, session } = this;
    if (input?.enable) this.quietSince = performance.now();
    const isLong = performance.now() - this.quietSince > PATIENCE_MS;
    if (session.isAway) return texts.offline;
    if (session.isElsewhere || session.isPractised || session.isResetting) return '';
    if (session.isFinishing) return texts.storing;
    if (session.ended) return this.status.next(session.ended, this.practice !== null);
    if (!session.trial) return isLong ? texts.getting_ready : '';
    if (this.device.isMissing) return this.words.missing;
    if (this.practice?.text) return this.practice.text;
    return isLong ? this.words.begin : '';
  }

  #send(now, since) {
    const input = this.device.read(now);
    const facts = { device: this.data.device, latency: this.latency.take(), frames: this.frames, clock: now };
    const seq = this.session.source.send(input, facts);
    if (seq && input.enable) this.latency.began(seq, since);
    else this.latency.forget();
  }

  // Whatever the device, the robot is let go at once.
  #letGo() {
    this.device.release();
    this.pump.flush();
    this.latency.forget();
  }

  #showOrHide() {
    if (document.hidden) {
      this.#letGo();
      this.pump.stop();
    } else if (this.session.trial) {
      this.pump.start();
    }
  }

  #leave() {
    this.#letGo();
    this.pump.stop();
    this.methods?.choose(this.session.slot);
    if (!this.session.isPractised) this.status.hideNotice();
    this.quietSince = performance.now();
    this.state = { ...this.state, ...STILL };
    this.scene.gauges.speakNow();
    // At once: who reads that the robot is in hand takes it, and what is taken before a trial begins doesn't count.
    if (!this.practice) this.status.showMethods(this.session);
    this.isStale = true;
  }

  #begin() {
    this.device.release();
    this.methods?.choose(this.session.slot);
    this.#atStart();
    this.scene.newLap();
    this.practice?.newLap();
    if (!this.session.isPractised) this.status.hideNotice();
    this.#showOrHide();
  }

  // Before the first state of a trial the nozzle is at the start, and the robot stays as drawn.
  #atStart() {
    const { left, top } = this.data.maze;
    const start = { y: left, z: top };
    this.state = { ...start, hand: start, t: 0, tilt: 0, direction: 0, ...STILL };
    this.isStale = true;
  }

  #end() {
    if (this.session.ended.outcome === 'completed') this.practice?.tick('lap');
    const said = this.#countDown();
    if (said) this.announcer.interrupt(said);
  }

  // While the robot is being reset. Returns what it says.
  #countDown() {
    const { session, words: own } = this;
    if (!session.isResetting || session.isPractised) return '';
    const next = this.status.next(session.ended, this.practice !== null);
    return this.status.showStuck(session.ended.outcome, next, { let_go: own.let_go });
  }

  #answer() {
    const { session, unlock } = this;
    if (session.isFinishing) return;
    if (unlock.isOpen(session.exposure.total)) session.finish();
    else this.announcer.interrupt(unlock.text(session.exposure.total));
  }

  #finished() {
    const { session } = this;
    if (this.unlock.isOpen(session.exposure.total)) this.tell('answer', this.data.comparison);
    else session.choose(session.slot);
  }

  #practised() {
    const { texts } = this;
    this.practice.tick('lap');
    this.#notice({ title: texts.practised_title, text: texts.practised_text, act: texts.next }, () =>
      this.tell('practised', true),
    );
  }

  #elsewhere() {
    const { texts } = this;
    this.#notice({ title: texts.elsewhere_title, text: texts.elsewhere_text, act: texts.go_on_here }, () => {
      this.status.hideNotice();
      this.session.goOn();
    });
  }

  #notice(notice, act) {
    this.device.release();
    this.onNotice = act;
    this.announcer.interrupt(this.status.showNotice(notice));
    this.parts.notice.act.focus();
  }

  #away(isAway) {
    this.parts.trouble.hidden = !isAway;
    say(this.parts.trouble, isAway ? this.texts.offline : '');
  }
}
