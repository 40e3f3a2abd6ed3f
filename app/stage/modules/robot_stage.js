// The robot's place on the page: hands everything on to a painter, in a worker or, in a browser that can't, in the page.

import { el } from './elements.js';
import { RobotPainter } from './robot_painter.js';

export class RobotStage {
  // place: the element that the robot fills; stage: { wall_x, maze, path }.
  constructor(place, stage) {
    Object.assign(this, { place, stage });
    this.sprayed = [];
    this.#openWorker();
  }

  spray(points) {
    this.sprayed.push(...points);
    this.#tell('spray', points);
  }

  clear() {
    this.sprayed = [];
    this.#tell('clear');
  }

  show(state, look, theme) {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (!width || !height) return;
    this.#tell('show', { state, look, theme, size: { width, height, ratio: window.devicePixelRatio || 1 } });
  }

  dispose() {
    this.worker?.terminate();
    this.painter?.dispose();
  }

  #tell(act, ...given) {
    if (this.worker) this.worker.postMessage([act, ...given]);
    else this.painter[act](...given);
  }

  #openWorker() {
    const canvas = this.#newCanvas();
    if (!window.Worker || !canvas.transferControlToOffscreen) {
      this.painter = new RobotPainter(canvas, this.stage);
      return;
    }
    this.worker = new Worker(new URL('./robot_worker.js', import.meta.url), { type: 'module' });
    this.worker.onerror = () => this.#openHere();
    const offscreen = canvas.transferControlToOffscreen();
    this.worker.postMessage(['start', offscreen, this.stage], [offscreen]);
  }

  // The worker didn't start, or failed: a canvas that was given away can't be had back.
  #openHere() {
    this.worker.terminate();
    this.worker = null;
    this.painter = new RobotPainter(this.#newCanvas(), this.stage);
    this.painter.spray(this.sprayed);
  }

  #newCanvas() {
    const canvas = el('canvas', { 'aria-hidden': 'true' });
    this.place.replaceChildren(canvas);
    return canvas;
  }
}
