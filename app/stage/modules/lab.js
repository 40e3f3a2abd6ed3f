// The page beside a robot in the lab: which method is wanted, what happens at the robot, and when the questions open.

import { mount } from './component.js';
import { badge, el, icon, say, words } from './elements.js';
import { radioGroup } from './radio_group.js';
import { SLOTS, steps } from './stage_layout.js';
import { Unlock } from './unlock.js';

const REPEAT_MS = 3000;

export default function (component) {
  // Streamlit's own trigger for a turn: the page stays, and says itself when to repeat what got lost.
  return mount(component, (root, wrapped) => new LabPage(root, component, wrapped.setTriggerValue));
}

class LabPage {
  constructor(root, { data, setTriggerValue }, leave) {
    this.texts = data.texts;
    this.tell = setTriggerValue;
    this.unlock = new Unlock(data.required_s, this.texts.unlock);
    this.turn = null;
    root.append(this.#page(data, leave));
    this.group = radioGroup(this.methods, {
      label: this.texts.method,
      chosen: data.wanted,
      options: SLOTS.map((slot) => this.#option(slot)),
      onChoose: (slot) => this.#choose(slot),
    });
  }

  // data.wanted: the slot as stored; step: load, reset, start or run; exposure: { A, B } [s].
  update(data) {
    this.data = data;
    this.#followTurn();
    const slot = this.turn?.slot ?? data.wanted;
    const step = this.turn ? 'load' : data.step;
    this.group.choose(slot);
    this.card.className = `scene card ${slot.toLowerCase()} ${step}`;
    this.sign.className = `badge ${slot.toLowerCase()}`;
    say(this.sign, slot);
    say(this.what, words(this.texts[step], { slot }));
    say(this.how, words(this.texts[`${step}_text`], { slot, other: slot === 'A' ? 'B' : 'A' }));
    for (const each of SLOTS) this.#showExposure(each, data.exposure[each]);
    this.#showUnlock(data);
    this.trouble.hidden = !data.trouble;
  }

  dispose() {}

  #page({ comparison, comparisons, texts }, leave) {
    this.trouble = el('p.trouble', { role: 'status', hidden: true }, texts.trouble);
    this.methods = el('div.methods');
    this.sign = el('i.badge', { 'aria-hidden': 'true' });
    this.what = el('h2');
    this.how = el('p');
    this.card = el('section', {}, this.sign, el('div', { 'aria-live': 'polite', role: 'status' }, this.what, this.how));
    this.lock = icon('lock');
    this.reason = el('p.unlock', { id: 'unlock' });
    this.answer = el(
      'button.button.answer',
      { type: 'button', 'aria-describedby': 'unlock', onclick: () => this.isOpen && leave('answer', comparison) },
      this.lock,
      texts.answer,
    );
    return el(
      'div.lab',
      {},
      el('header.head', {}, el('h1', {}, texts.title), steps(comparison, comparisons, texts), el('span.grow'), this.trouble),
      this.methods,
      this.card,
      el('footer.foot', {}, el('span.hint', {}, texts.turn), el('span.grow'), this.reason, this.answer),
    );
  }

  #option(slot) {
    const name = this.texts[`method_${slot.toLowerCase()}`];
    const share = el('i.share', { 'aria-hidden': 'true' });
    const tried = el('span');
    const check = icon('check');
    this.shown = { ...this.shown, [slot]: { share, tried, check } };
    const status = el('span.status', {}, check, tried);
    return {
      value: slot,
      label: name,
      classes: `.${slot.toLowerCase()}`,
      content: [badge(slot), el('div', {}, el('b', {}, name), status), el('i.pick', { 'aria-hidden': 'true' }), share],
    };
  }

  #choose(slot) {
    const stands = this.turn ? this.turn.slot : this.data.wanted;
    if (slot === stands) return;
    this.turn = { slot };
    this.#sendTurn();
    this.update(this.data);
  }

  // Until the store has the turn it is shown as made; what got lost on the way is sent again.
  #followTurn() {
    if (!this.turn) return;
    if (this.data.wanted === this.turn.slot) this.turn = null;
    else if (performance.now() - this.turn.sent > REPEAT_MS) this.#sendTurn();
  }

  #sendTurn() {
    this.turn.sent = performance.now();
    this.tell('turned', this.turn.slot);
  }

  #showExposure(slot, seconds) {
    const { share, tried, check } = this.shown[slot];
    const whole = Math.floor(seconds);
    const clock = `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}`;
    say(tried, seconds > 0 ? words(this.texts.tried, { clock }) : this.texts.not_tried);
    const done = this.unlock.share({ [slot]: seconds }, slot);
    share.style.setProperty('--share', done);
    check.style.display = done >= 1 && seconds > 0 ? '' : 'none';
  }

  #showUnlock({ exposure }) {
    this.isOpen = this.unlock.isOpen(exposure);
    say(this.reason, this.unlock.text(exposure));
    this.answer.classList.toggle('primary', this.isOpen);
    this.answer.classList.toggle('locked', !this.isOpen);
    this.answer.setAttribute('aria-disabled', String(!this.isOpen));
    this.lock.style.display = this.isOpen ? 'none' : '';
  }
}
