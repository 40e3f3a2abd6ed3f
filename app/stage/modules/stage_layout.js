// The elements that the robot pages share, without any behaviour but the labels.

import { badge, el, icon } from './elements.js';

export const SLOTS = ['A', 'B'];

export function steps(comparison, of, texts) {
  const state = (i) => (i < comparison - 1 ? '.done' : i === comparison - 1 ? '.now' : '');
  const marks = Array.from({ length: of }, (_, i) => el(`i${state(i)}`));
  return el('div.steps', { role: 'img', 'aria-label': texts.done }, marks);
}

// The choice between A and B, to be made a radio group of; first: what is said of a method at first.
export function methodParts(texts, first) {
  const status = Object.fromEntries(
    SLOTS.map((slot) => [slot, { dial: icon('dial'), check: icon('check'), text: el('span', {}, first) }]),
  );
  const options = SLOTS.map((slot) => ({
    value: slot,
    label: texts[`method_${slot.toLowerCase()}`],
    classes: `.${slot.toLowerCase()}`,
    content: [
      badge(slot),
      el(
        'div',
        {},
        el('b', {}, texts[`method_${slot.toLowerCase()}`]),
        el('span.status', {}, status[slot].check, status[slot].dial, status[slot].text),
      ),
    ],
  }));
  return { methods: el('div.methods'), options, status };
}

// The bar above the wall: A and B, restart, and the way to the questions.
export function barParts(texts, first) {
  const choice = methodParts(texts, first);
  const restart = el('button.button', { type: 'button' }, icon('restart'), texts.restart);
  const unlock = el('p.unlock', { id: 'unlock' });
  const answerLock = icon('lock');
  const answer = el('button.button.answer', { type: 'button', 'aria-describedby': 'unlock' }, answerLock, texts.answer);
  const bar = el('section.bar', {}, choice.methods, restart, el('span.grow'), unlock, answer);
  return { ...choice, restart, unlock, answer, answerLock, bar };
}

// The wall with the lap's chip and a message in its empty middle, and a notice over all of it; keys: what its keys do.
export function wallParts(texts, keys) {
  const canvas = el('canvas', { 'aria-hidden': 'true' });
  const chip = { badge: el('i.badge.small', { hidden: true }), lap: el('span'), time: el('span.time') };
  const message = el('p.message');
  const veil = el('div.veil', { hidden: true });
  const notice = {
    icon: icon('dial'),
    title: el('h2'),
    text: el('span'),
    next: el('span.next'),
    act: el('button.button.primary', { type: 'button', hidden: true }),
  };
  const words = el('div', {}, notice.title, el('p', {}, notice.text, el('br'), notice.next), notice.act);
  notice.element = el('div.notice', { hidden: true }, notice.icon, words);
  const wall = el(
    'section.wall',
    { tabindex: '0', role: 'group', 'aria-label': texts.wall, 'aria-describedby': 'wall-keys' },
    canvas,
    el('div.middle', {}, el('div.chip', {}, chip.badge, chip.lap, chip.time), message),
    el('span.unseen', { id: 'wall-keys' }, keys),
  );
  const stand = el('div.stand', {}, wall, veil, notice.element);
  return { stand, wall, canvas, chip, message, veil, notice };
}

// Where the robot is drawn, and the card of the gauges beside it.
export function lowParts(texts) {
  const robot = el('div.robot', { role: 'img', 'aria-label': texts.robot });
  const card = el('section.card.instruments', { 'aria-label': texts.instruments });
  return { robot, card };
}

// Title, what is done already, and at the right what the page says: trouble, or else a hint.
export function headParts(data, hint, title = data.texts.title) {
  const { texts } = data;
  const trouble = el('p.trouble', { role: 'status', hidden: true });
  const marks = data.practice ? null : steps(data.comparison, data.comparisons, texts);
  const head = el('header.head', {}, el('h1', {}, title), marks, el('span.grow'), trouble, el('span.hint', {}, hint));
  return { head, trouble };
}
