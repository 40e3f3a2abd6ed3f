// The elements of the page where the robot is guided: in a comparison with A and B, in practice with what to try.

import { el } from './elements.js';
import { barParts, headParts, lowParts, wallParts } from './stage_layout.js';

const CONTROLS = ['move', 'release', 'spray', 'tilt', 'tilt_up'];

// words: the texts of the device in use; device: its element, if it has one; practice: null in a comparison.
export function guideLayout(data, words, { device, practice }) {
  const { texts } = data;
  const title = practice ? texts.practice_title : texts.title;
  const bar = practice ? { bar: el('section.bar', {}, practice.element) } : barParts(texts, texts.not_guided);
  const parts = { ...headParts(data, words.line, title), ...bar, ...wallParts(texts, words.keys), ...lowParts(texts) };
  const moves = trigger(texts.robot_waits, words.key_hold);
  const sprays = trigger(texts.spray_off, words.key_spray);
  const triggers = el('div.triggers', {}, moves.element, sprays.element);
  const controls = practice && !device ? controlList(texts, words) : null;
  const lowest = [device, parts.robot, controls, parts.card].filter(Boolean);
  const low = el(`div.low${lowest.length > 2 ? '.three' : ''}${device ? '.hands' : ''}`, {}, lowest);
  const page = el('div.stage.guide', {}, parts.head, parts.bar, parts.stand, low);
  return { ...parts, page, triggers, moves, sprays };
}

function trigger(state, key) {
  const text = el('b', {}, state);
  const element = el('div.trigger', {}, el('i.dot'), text, el('span.grow'), el('span.key', {}, key));
  return { element, text };
}

function controlList(texts, words) {
  const rows = CONTROLS.filter((each) => words[`key_${each}`]).map((each) => {
    const key = words[`key_${each}`];
    return el('div', {}, el('dt', {}, texts[`control_${each}`]), el('dd.key', {}, key));
  });
  return el('section.card.keys', { 'aria-label': texts.controls }, el('span.label', {}, texts.controls), el('dl', {}, rows));
}
