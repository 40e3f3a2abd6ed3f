// The replay of a trial: one playhead through the wall, the robot and the series.

import { mount } from '/stage/component.js';
import { TiltLook } from '/stage/cursor.js';
import { el, icon, say } from '/stage/elements.js';
import { Path } from '/stage/path.js';
import { Player } from '/stage/player.js';
import { RobotStage } from '/stage/robot_stage.js';
import { WallView } from '/stage/wall_view.js';

import { loadReplay } from './replay_data.js';
import { GUTTER, Series } from './series.js';

const RATES = [[0.25, '¼×'], [1, '1×'], [4, '4×']];
const PAGE_S = 1;

export default function (component) {
  const { data } = component;
  return mount({ ...component, data: { ...data, comparison: data.trial } }, (root) => {
    const view = new Replay(root, data);
    view.open();
    return view;
  });
}

class Replay {
  constructor(root, data) {
    Object.assign(this, { root, data, time: 0, rate: 1, painted: -1 });
    this.#build();
    this.path = new Path(data.path);
    this.tilt = new TiltLook(data.tilt);
    this.wall = new WallView(this.canvas, data.maze, this.path, { start: 'Start and finish' });
    this.robot = new RobotStage(this.robotPlace, { wall_x: data.wall_x, maze: data.maze, path: data.path });
    this.player = new Player({ advance: (dt) => this.time + dt * this.rate }, (time) => this.#pass(time));
    this.resizing = new ResizeObserver(() => this.update());
    this.resizing.observe(this.plots);
  }

  async open() {
    try {
      this.replay = await loadReplay(this.data.address);
    } catch (error) {
      say(this.status, `This trial can't be replayed: ${error.message}`);
      this.status.classList.add('trouble');
      return;
    }
    this.status.replaceChildren(...this.#verdict());
    this.series = new Series(this.data, this.replay, (time) => this.#seek(time));
    this.plots.replaceChildren(this.series.element);
    this.jumps.append(...this.#jumps());
    this.slider.step = 1 / this.replay.hz;
    for (const control of this.root.querySelectorAll('button, input')) control.disabled = false;
    this.update();
  }

  update() {
    if (!this.replay) {
      this.wall.draw(null);
      return;
    }
    this.series.fit(this.plots.clientWidth);
    this.#draw();
  }

  dispose() {
    this.player.pause();
    this.robot.dispose();
    this.resizing.disconnect();
  }

  #build() {
    const { data } = this;
    this.canvas = el('canvas', { 'aria-hidden': 'true' });
    this.robotPlace = el('div.robot', { role: 'img', 'aria-label': 'Robot' });
    this.status = el('span', { role: 'status' }, 'getting the recording ready');
    const facts = data.facts.map(([word, value]) => el('span', {}, `${word} `, el('b', {}, value)));
    this.plots = el('div.plots');
    this.slider = el('input', {
      type: 'range', min: '0', max: String(data.duration_s), value: '0', 'aria-label': 'Time', disabled: true,
      style: `margin-left: ${GUTTER.left - 9}px; width: calc(100% - ${GUTTER.left + GUTTER.right - 18}px)`,
      oninput: () => this.#seek(Number(this.slider.value)),
    });
    this.playButton = el('button.play', { type: 'button', disabled: true, onclick: () => this.#toggle() });
    this.clock = el('b.clock', {}, stamp(0));
    this.jumps = el('div.jumps');
    this.rates = RATES.map(([rate, name]) =>
      el('button', { type: 'button', disabled: true, 'aria-pressed': String(rate === 1), onclick: () => this.#hurry(rate) }, name),
    );
    const step = (name, rows) =>
      el('button.button.small', { type: 'button', disabled: true, onclick: () => this.#step(rows) }, name);
    this.controls = el(
      'div.controls',
      {},
      this.playButton,
      step('−1 frame', -1),
      step('+1 frame', 1),
      this.clock,
      el('span.of', {}, `of ${stamp(data.duration_s)}`),
      el('span.grow'),
      this.jumps,
      el('div.rates', { role: 'group', 'aria-label': 'Speed of the replay' }, this.rates),
    );
    const card = el('section.card.time', { 'aria-label': 'Time series' }, this.plots, this.slider, this.controls);
    this.root.append(
      el(
        'div.replay',
        { onkeydown: (event) => this.#key(event) },
        el('p.facts', {}, facts, el('span', {}, 'recording ', el('code', {}, data.recording), ' ', this.status)),
        el(
          'div.views',
          {},
          el('section.wall', { tabindex: '0', role: 'group', 'aria-label': 'Wall' }, this.canvas),
          this.robotPlace,
        ),
        card,
      ),
    );
    this.#showPlaying();
  }

  #verdict() {
    const { doubt } = this.replay;
    if (!doubt) return [icon('check'), 'runs again bit for bit'];
    this.status.classList.add('trouble');
    return [doubt];
  }

  #jumps() {
    const jumps = this.series.marks.map(({ name, time }) =>
      el('button.button.small', { type: 'button', onclick: () => this.#seek(time) }, name),
    );
    return jumps.length ? [el('span', {}, 'Jump to'), ...jumps] : [];
  }

  #key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || !this.replay) return;
    const onSlider = event.target === this.slider;
    const acts = {
      ' ': event.target.tagName === 'BUTTON' ? null : () => this.#toggle(),
      ArrowLeft: onSlider ? null : () => this.#step(-1),
      ArrowRight: onSlider ? null : () => this.#step(1),
      PageDown: () => this.#seek(this.time - PAGE_S),
      PageUp: () => this.#seek(this.time + PAGE_S),
      Home: () => this.#seek(0),
      End: () => this.#seek(this.data.duration_s),
    };
    const act = acts[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  }

  #toggle() {
    if (this.player.playing) this.player.pause();
    else {
      if (this.time >= this.data.duration_s) this.#seek(0);
      this.player.play();
    }
    this.#showPlaying();
  }

  #showPlaying() {
    const { playing } = this.player ?? {};
    this.playButton.replaceChildren(icon(playing ? 'pause' : 'play'));
    this.playButton.setAttribute('aria-label', playing ? 'Pause' : 'Play');
  }

  #hurry(rate) {
    this.rate = rate;
    RATES.forEach(([other], k) => this.rates[k].setAttribute('aria-pressed', String(other === rate)));
  }

  #step(rows) {
    this.player.pause();
    this.#showPlaying();
    this.#seek((this.replay.row(this.time) + rows) / this.replay.hz);
  }

  #pass(time) {
    this.#seek(time);
    if (time < this.data.duration_s) return;
    this.player.pause();
    this.#showPlaying();
  }

  #seek(time) {
    this.time = Math.min(this.data.duration_s, Math.max(0, time));
    this.#draw();
  }

  #draw() {
    const { replay, time, data } = this;
    const state = replay.lap.at(time);
    this.#paintTo(replay.row(time));
    const look = {
      look: this.tilt.at(state.tilt),
      elongation: state.tilt / data.tilt.fullEllipse,
      direction: state.direction,
      spraying: state.spraying,
      idle: !state.moving,
    };
    this.wall.draw(state, look);
    const { y, z, q, spraying } = state;
    this.robot.show({ y, z, q, spraying }, look, this.root.dataset.theme);
    this.series.show(time);
    this.#tellTime();
  }

  // The path as it was at a row; going back, it is painted anew.
  #paintTo(row) {
    if (row < this.painted) {
      this.path.clear();
      this.robot.clear();
      this.painted = -1;
    }
    const points = this.replay.strokes.slice(this.painted + 1, row + 1).filter((point) => point !== null);
    this.painted = row;
    if (!points.length) return;
    for (const { y, z, speed, lifted } of points) {
      this.path.sprayTo(y, z, speed);
      if (lifted) this.path.lift();
    }
    this.robot.spray(points);
  }

  #tellTime() {
    const { replay, time } = this;
    const row = replay.row(time);
    const force = `force ${replay.force[row].toFixed(0)} N`;
    const speed = `speed ${replay.speed[row].toFixed(3)} m/s`;
    this.slider.value = String(time);
    this.slider.style.setProperty('--share', `${(100 * time) / this.data.duration_s}%`);
    this.slider.setAttribute('aria-valuetext', `${time.toFixed(2)} s, ${force}, ${speed}, sigma min ${replay.sigma[row].toFixed(4)}`);
    say(this.clock, stamp(time));
  }
}

// 0:38.40
function stamp(time) {
  const minutes = Math.floor(time / 60);
  return `${minutes}:${(time - 60 * minutes).toFixed(2).padStart(5, '0')}`;
}
