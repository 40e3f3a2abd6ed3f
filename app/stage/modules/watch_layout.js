// The elements of the page where laps are watched.

import { el, icon } from './elements.js';
import { barParts, headParts, lowParts, wallParts } from './stage_layout.js';

export function watchLayout(data) {
  const { texts } = data;
  const parts = {
    ...headParts(data, texts.watching),
    ...barParts(texts, texts.not_watched),
    ...wallParts(texts, texts.wall_keys),
    ...lowParts(texts),
  };
  const play = el('button.button.play', { type: 'button' });
  const laps = Array.from({ length: data.laps }, (_, i) => {
    const name = texts.lap.replace('{lap}', i + 1);
    return el('button.lap', { type: 'button' }, el('span', {}, name), icon('check'), el('i.progress'));
  });
  const controls = el('div.controls', {}, play, el('div.laps', { role: 'group', 'aria-label': texts.laps }, laps));
  const low = el('div.low', {}, parts.robot, parts.card);
  const page = el('div.stage', {}, parts.head, parts.bar, parts.stand, low);
  return { ...parts, page, controls, play, laps };
}
