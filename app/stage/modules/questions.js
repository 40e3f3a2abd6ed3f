// The questions of a comparison: one radio group each. Submit stays enabled and points to the first open one.

import { mount } from './component.js';
import { Draft } from './draft.js';
import { badge, el, icon, say, words } from './elements.js';
import { radioGroup } from './radio_group.js';
import { steps } from './stage_layout.js';

export default function (component) {
  return mount(component, (root, { data, setTriggerValue }) => new QuestionsPage(root, data, setTriggerValue));
}

class QuestionsPage {
  constructor(root, data, setTriggerValue) {
    this.data = data;
    this.texts = data.texts;
    this.tell = setTriggerValue;
    this.draft = new Draft(data.draft_key);
    this.questions = data.questions.map((question, i) => this.#question(question, i));
    this.count = el('span', { role: 'status' });
    this.trouble = el('span.trouble', { role: 'alert' });
    this.submit = el('button.button.primary', { type: 'button', onclick: () => this.#submit() }, this.texts.submit);
    root.append(this.#page());
    this.#showCount();
  }

  update() {}

  dispose() {}

  #page() {
    const { data, texts } = this;
    const back = el('button.button', { type: 'button', onclick: () => this.tell('back', data.comparison) }, icon('back'), texts.back);
    return el(
      'div.questions',
      {},
      el('header.head', {}, el('h1', {}, texts.title), steps(data.comparison, data.comparisons, texts)),
      el('div.intro', {}, badge('A', 'small'), el('span.and', {}, texts.and), badge('B', 'small'), el('p', {}, texts.intro)),
      el(
        'div.key',
        { 'aria-hidden': 'true' },
        el('span'),
        el('span', {}, el('b.a', {}, 'A'), el('i'), texts.no_difference, el('i'), el('b.b', {}, 'B')),
      ),
      el('section.card', {}, this.questions.map((question) => question.element)),
      el('div.foot', {}, back, el('span', {}, texts.kept), el('span.grow'), this.trouble, this.count, this.submit),
    );
  }

  #question({ name, wording, emphasis, options }, i) {
    const id = `wording-${i}`;
    const text = el('span.text', { id }, emphasised(wording, emphasis));
    const scale = el('div.scale', { style: `--levels:${options.length}` });
    const missing = el('p.missing', { id: `missing-${i}` }, this.texts.missing);
    const number = el('span.number', { 'aria-hidden': 'true' }, String(i + 1));
    const element = el('div.question', {}, el('div', {}, el('div.wording', {}, number, text), missing), scale);
    const group = radioGroup(scale, {
      labelledBy: id,
      chosen: this.draft.answers[name],
      options: options.map(({ value, label, side, much }) => ({
        value,
        label,
        classes: `.${side}${much ? '.much' : ''}`,
        content: [el('span', {}, tick(), emphasised(label, { a: 'A', b: 'B' }[side] ?? ''))],
      })),
      onChoose: (answer) => {
        this.draft.set(name, answer);
        element.classList.remove('open');
        say(this.trouble, '');
        this.#showCount();
      },
    });
    return { name, element, group };
  }

  #showCount() {
    const answered = this.questions.filter(({ name }) => this.draft.answers[name]).length;
    say(this.count, words(this.texts.answered, { answered, of: this.questions.length }));
  }

  async #submit() {
    const open = this.questions.find(({ name }) => !this.draft.answers[name]);
    if (open) {
      for (const { element } of this.questions) element.classList.toggle('open', element === open.element);
      say(this.trouble, this.texts.missing);
      open.element.scrollIntoView({ block: 'nearest' });
      open.group.focus();
      return;
    }
    if (this.sending) return;
    this.sending = true;
    this.submit.setAttribute('aria-disabled', 'true');
    say(this.submit, this.texts.sending);
    const { comparison } = this.data;
    const answers = Object.fromEntries(this.questions.map(({ name }) => [name, this.draft.answers[name]]));
    const status = await this.#post({ comparison, answers });
    this.sending = false;
    if (status === 200 || status === 409) {
      if (status === 200) this.draft.forget();
      this.tell('submitted', comparison);
      return;
    }
    this.submit.removeAttribute('aria-disabled');
    say(this.submit, this.texts.submit);
    say(this.trouble, this.texts.not_stored);
  }

  async #post(body) {
    try {
      const headers = { 'Content-Type': 'application/json' };
      const answer = await fetch(this.data.answers_address, { method: 'POST', headers, body: JSON.stringify(body) });
      return answer.status;
    } catch {
      return 0;
    }
  }
}

function tick() {
  const mark = icon('check');
  mark.classList.add('tick');
  return mark;
}

// The text with its first occurrence of a part set off: <em> in a wording, <b> for the side in an answer.
function emphasised(text, part) {
  const at = part ? text.search(new RegExp(`(?<!\\w)${part.replace(/[.*+?^${}()|[\]\\]/g, '\\$&')}(?!\\w)`)) : -1;
  if (at < 0) return [text];
  const tag = part.length === 1 ? 'b' : 'em';
  return [text.slice(0, at), el(tag, {}, part), text.slice(at + part.length)];
}
