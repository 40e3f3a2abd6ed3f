// The elements of the robot page, without any behaviour but the labels.

import { badge, el, icon } from './elements.js';

export const SLOTS = ['A', 'B'];

export function steps(comparison, of, texts) {
  const state = (i) => (i < comparison - 1 ? '.done' : i === comparison - 1 ? '.now' : '');
  const marks = Array.from({ length: of }, (_, i) => el(`i${state(i)}`));
  return el('div.steps', { role: 'img', 'aria-label': texts.done }, marks);
}

export function watchLayout(data) {
  const { texts } = data;
  const status = Object.fromEntries(
    SLOTS.map((slot) => [slot, { dial: icon('dial'), check: icon('check'), text: el('span', {}, texts.not_watched) }]),
  );
  const methods = el('div.methods');
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
  const restart = el('button.button', { type: 'button' }, icon('restart'), texts.restart);
  const unlock = el('p.unlock', { id: 'unlock' });
  const answerLock = icon('lock');
  const answer = el('button.button.answer', { type: 'button', 'aria-describedby': 'unlock' }, answerLock, texts.answer);
  const canvas = el('canvas', { 'aria-hidden': 'true' });
  const chip = { badge: el('i.badge.small'), lap: el('span'), time: el('span.time') };
  const message = el('p.message');
  const veil = el('div.veil', { hidden: true });
  const stuck = el(
    'div.stuck',
    { hidden: true },
    icon('dial'),
    el('div', {}, el('h2'), el('p', {}, texts.stuck_text, el('br'), el('span.next'))),
  );
  const wall = el(
    'section.wall',
    { tabindex: '0', role: 'group', 'aria-label': texts.wall, 'aria-describedby': 'wall-keys' },
    canvas,
    el('div.middle', {}, el('div.chip', {}, chip.badge, chip.lap, chip.time), message),
    veil,
    stuck,
    el('span.unseen', { id: 'wall-keys' }, texts.wall_keys),
  );
  const robot = el('canvas', { 'aria-hidden': 'true' });
  const play = el('button.button.play', { type: 'button' });
  const laps = Array.from({ length: data.laps }, (_, i) => {
    const name = texts.lap.replace('{lap}', i + 1);
    return el('button.lap', { type: 'button' }, el('span', {}, name), icon('check'), el('i.progress'));
  });
  const card = el('section.card.instruments', { 'aria-label': texts.instruments });
  const controls = el('div.controls', {}, play, el('div.laps', { role: 'group', 'aria-label': texts.laps }, laps));
  const trouble = el('p.trouble', { role: 'status', hidden: true });
  const header = el(
    'header.head',
    {},
    el('h1', {}, texts.title),
    steps(data.comparison, data.comparisons, texts),
    el('span.grow'),
    trouble,
    el('span.hint', {}, texts.watching),
  );
  const bar = el('section.bar', {}, methods, restart, el('span.grow'), unlock, answer);
  const low = el('div.low', {}, el('div.robot', { role: 'img', 'aria-label': texts.robot }, robot), card);
  const page = el('div.watch', {}, header, bar, wall, low);
  return {
    page, methods, options, status, restart, unlock, answer, answerLock, wall, canvas, chip, message, veil, stuck,
    robot, card, controls, play, laps, trouble,
  };
}
