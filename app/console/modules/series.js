// Force, speed and sigma_min of a lap over time, one above the other, under one playhead. What is still to come is
// drawn faintly, so that the past stands out.

import { svg } from './svg.js';

const LEFT = 96; // of the plots: names and ticks stand there [px]
const RIGHT = 12;
const PHASES_Y = 4;
const MARKS_Y = 34;
const FIRST_Y = 44;
const GAP = 16;
const TIMES_HEIGHT = 24;
const LINEAR_PX = 62;
const LOG_PX = 76;
const TAG = { width: 56, height: 20, gap: 8 };

export const GUTTER = { left: LEFT, right: RIGHT };

export class Series {
  // data: the page's; replay: ReplayData; onSeek(time): somebody points at a time.
  constructor(data, replay, onSeek) {
    Object.assign(this, { data, replay, onSeek });
    this.duration = data.duration_s;
    this.element = svg('svg', { class: 'series', role: 'img', 'aria-label': 'Force, speed and sigma min over time' });
    this.panels = panelsOf(data, replay);
    this.marks = marksOf(data, replay);
    this.#listen();
  }

  // Draws all of it for a width [px].
  fit(width) {
    if (!width || width === this.width) return;
    this.width = width;
    let y = FIRST_Y;
    for (const panel of this.panels) {
      panel.y = y;
      y += panel.height + GAP;
    }
    this.bottom = y - GAP;
    const height = this.bottom + TIMES_HEIGHT;
    this.element.setAttribute('viewBox', `0 0 ${width} ${height}`);
    this.element.setAttribute('width', width);
    this.element.setAttribute('height', height);
    const past = svg('rect', { x: LEFT, y: 0, height, width: 0 });
    this.past = past;
    this.head = svg('g', { class: 'playhead' }, svg('path', { d: `M0 ${FIRST_Y - 6}V${this.bottom + 6}` }));
    this.tags = this.panels.map(() => new Tag(this.head));
    this.element.replaceChildren(
      svg('clipPath', { id: 'past' }, past),
      ...this.#drawStuck(),
      ...this.#drawPhases(),
      ...this.#drawMarks(),
      ...this.panels.flatMap((panel) => this.#drawPanel(panel)),
      ...this.#drawTimes(),
      this.head,
    );
    this.show(this.time ?? 0);
  }

  // Moves the playhead.
  show(time) {
    this.time = time;
    if (!this.width) return;
    const x = this.#x(time);
    const row = this.replay.row(time);
    this.past.setAttribute('width', Math.max(0, x - LEFT));
    this.head.setAttribute('transform', `translate(${x} 0)`);
    const isLeft = x + TAG.gap + TAG.width > this.width;
    this.panels.forEach((panel, k) => {
      const value = panel.values[row];
      this.tags[k].show(panel.at(value), panel.text(value), panel, isLeft);
    });
  }

  #x(time) {
    return LEFT + ((this.width - LEFT - RIGHT) * time) / this.duration;
  }

  #listen() {
    const seek = (event) => {
      const share = (event.clientX - this.element.getBoundingClientRect().left - LEFT) / (this.width - LEFT - RIGHT);
      this.onSeek(Math.min(1, Math.max(0, share)) * this.duration);
    };
    this.element.addEventListener('pointerdown', (event) => {
      this.element.setPointerCapture(event.pointerId);
      seek(event);
    });
    this.element.addEventListener('pointermove', (event) => {
      if (this.element.hasPointerCapture(event.pointerId)) seek(event);
    });
  }

  #drawStuck() {
    const { events, stuck } = this.data;
    const event = events.find(({ kind }) => kind === 'stuck');
    if (!event) return [];
    const from = this.#x(Math.max(0, event.time_s - stuck.dwell_s));
    const to = this.#x(event.time_s);
    const label = `below ${stuck.sigma_below} for ${stuck.dwell_s} s`;
    const x = Math.min(this.width - RIGHT, Math.max((from + to) / 2 + 62, from));
    return [
      svg('rect', { class: 'stuck', x: from, y: MARKS_Y - 13, width: to - from, height: this.bottom - MARKS_Y + 13 }),
      svg('text', { class: 'bad', x, y: MARKS_Y - 3, 'text-anchor': 'end' }, label),
    ];
  }

  #drawPhases() {
    return this.replay.phases.flatMap(({ name, from, to }) => {
      const [x0, x1] = [this.#x(from), this.#x(to)];
      const drawn = [svg('rect', { class: 'phase', x: x0, y: PHASES_Y, width: Math.max(1, x1 - x0 - 1), height: 15, rx: 3 })];
      if (x1 - x0 > 7 * name.length) {
        drawn.push(svg('text', { class: 'phase-name', x: (x0 + x1) / 2, y: PHASES_Y + 11.5, 'text-anchor': 'middle' }, name));
      }
      return drawn;
    });
  }

  // Labels that would lie on one another are left out: the buttons below name them, too.
  #drawMarks() {
    let free = LEFT;
    const stuck = this.data.events.find(({ kind }) => kind === 'stuck');
    const taken = stuck ? this.#x(stuck.time_s) - 130 : Infinity;
    return this.marks.flatMap(({ name, time, isLine }) => {
      if (!isLine) return [];
      const x = this.#x(time);
      const half = 3.3 * name.length;
      const drawn = [svg('path', { class: 'mark', d: `M${x} ${MARKS_Y + 2}V${this.bottom}` })];
      if (x - half >= free && x + half <= Math.min(taken, this.width)) {
        drawn.push(svg('text', { x, y: MARKS_Y - 3, 'text-anchor': 'middle' }, name));
        free = x + half + 8;
      }
      return drawn;
    });
  }

  #drawPanel(panel) {
    const right = this.width - RIGHT;
    const drawn = [
      svg('text', { class: 'name', x: 0, y: panel.y + 14 }, panel.name),
      svg('text', { class: 'unit', x: 0, y: panel.y + 31 }, panel.unit),
    ];
    if (panel.band) {
      const [low, high] = panel.band.map((value) => panel.at(value));
      drawn.push(
        svg('rect', { class: 'band', x: LEFT, y: high, width: right - LEFT, height: low - high }),
        svg('text', { x: LEFT + 6, y: high + 13 }, panel.bandName),
      );
    }
    for (const tick of panel.ticks) {
      const y = panel.at(tick);
      drawn.push(
        svg('path', { class: 'grid', d: `M${LEFT} ${y}H${right}` }),
        svg('text', { class: 'tick', x: LEFT - 8, y: y + 4, 'text-anchor': 'end' }, String(tick)),
      );
    }
    for (const { value, name, kind, atRight } of panel.limits) {
      const y = panel.at(value);
      const x = atRight ? right - 110 : LEFT + 6;
      drawn.push(
        svg('path', { class: `limit ${kind}`, d: `M${LEFT} ${y}H${right}` }),
        svg('text', { class: kind, x, y: y - 4, 'text-anchor': atRight ? 'end' : 'start' }, name),
      );
    }
    const d = this.#line(panel);
    drawn.push(svg('path', { class: 'line to-come', d }), svg('path', { class: 'line', d, 'clip-path': 'url(#past)' }));
    return drawn;
  }

  // A lap has some thousand rows at most: each is a point of the line.
  #line(panel) {
    const point = (value, row) => `${this.#x(row / this.replay.hz).toFixed(1)} ${panel.at(value).toFixed(1)}`;
    return `M${Array.from(panel.values, point).join('L')}`;
  }

  #drawTimes() {
    const step = [1, 2, 5, 10, 20, 30].find((s) => this.duration / s <= 10) ?? 60;
    const drawn = [];
    for (let time = 0; time <= this.duration; time += step) {
      drawn.push(
        svg('text', { class: 'tick', x: this.#x(time), y: this.bottom + 18, 'text-anchor': 'middle' }, `${time} s`),
      );
    }
    return drawn;
  }
}

// The value beside the playhead.
class Tag {
  constructor(head) {
    this.dot = svg('circle', { r: 4 });
    this.box = svg('rect', { class: 'tag', width: TAG.width, height: TAG.height, rx: 5 });
    this.text = svg('text', { class: 'tag', 'text-anchor': 'middle' });
    head.append(this.dot, this.box, this.text);
  }

  show(y, text, panel, isLeft) {
    const x = isLeft ? -TAG.gap - TAG.width : TAG.gap;
    const middle = Math.min(panel.y + panel.height - 8, Math.max(panel.y + 8, y));
    this.dot.setAttribute('cy', y);
    this.box.setAttribute('x', x);
    this.box.setAttribute('y', middle - TAG.height / 2);
    this.text.setAttribute('x', x + TAG.width / 2);
    this.text.setAttribute('y', middle + 4);
    this.text.textContent = text;
  }
}

function panelsOf(data, replay) {
  const force = linear({ top: niceTop(replay.force, 50, 25), step: 25 });
  const speed = linear({ top: niceTop(replay.speed, 0.3, 0.1), step: 0.1 });
  const sigma = logarithmic(replay.sigma);
  const limits = [{ value: data.stuck.sigma_below, name: `${data.stuck.sigma_below} stuck threshold`, kind: 'bad' }];
  if (data.damping_below) {
    const name = `${data.damping_below} damping threshold`;
    limits.push({ value: data.damping_below, name, kind: 'calm', atRight: true });
  }
  return [
    { name: 'Force', unit: 'N', values: replay.force, text: (v) => `${v.toFixed(0)} N`, limits: [], ...force },
    {
      name: 'Speed', unit: 'm/s', values: replay.speed, text: (v) => v.toFixed(3), limits: [],
      band: [0, data.path.solidUpTo], bandName: 'solid line', ...speed,
    },
    { name: 'σ min', unit: 'log scale', values: replay.sigma, text: (v) => v.toFixed(4), limits, ...sigma },
  ];
}

function linear({ top, step }) {
  const ticks = Array.from({ length: Math.round(top / step) + 1 }, (_, k) => Number((k * step).toFixed(3)));
  return {
    height: LINEAR_PX,
    ticks: ticks.length > 5 ? ticks.filter((_, k) => k % 2 === 0) : ticks,
    at(value) {
      return this.y + this.height * (1 - Math.min(1, Math.max(0, value / top)));
    },
  };
}

function logarithmic(values) {
  const lowest = Math.max(1e-5, values.reduce((least, value) => Math.min(least, value), 1));
  const bottom = Math.min(-3, Math.floor(Math.log10(lowest)));
  const top = Math.log10(0.5);
  const ticks = Array.from({ length: -bottom }, (_, k) => Number(`1e${bottom + k}`));
  return {
    height: LOG_PX,
    ticks,
    at(value) {
      const share = (Math.log10(Math.max(value, 1e-9)) - bottom) / (top - bottom);
      return this.y + this.height * (1 - Math.min(1, Math.max(0, share)));
    },
  };
}

function niceTop(values, least, step) {
  const most = values.reduce((top, value) => Math.max(top, value), 0);
  return Math.max(least, step * Math.ceil(most / step));
}

// Moments to jump to: [{ name, time [s], isLine: whether a line marks it }], in order of time.
export function marksOf(data, replay) {
  const found = [];
  for (const { name, from } of replay.phases) {
    if (!found.some((mark) => mark.name === name)) found.push({ name, time: from, isLine: false });
  }
  const damped = data.damping_below ? replay.sigma.findIndex((value) => value < data.damping_below) : -1;
  if (damped >= 0) found.push({ name: 'damping begins', time: damped / replay.hz, isLine: true });
  for (const { name, time_s: time, kind } of data.events) found.push({ name, time, isLine: kind !== 'stuck' });
  return found.sort((a, b) => a.time - b.time);
}
