// Draws the robot at its own pace, always the newest state it was shown. It runs in a worker where it can, so it
// keeps a path of its own.

import { Pace } from './pace.js';
import { Path } from './path.js';
import { robotView } from './robot_view.js';

const SLOW_MS = 25; // without a graphics card
const COARSE = 0.6; // then a coarser picture, but a livelier one

export class RobotPainter {
  // stage: { wall_x, maze, path } as the page's data have them.
  constructor(canvas, stage) {
    this.robot = robotView(canvas, stage.wall_x, stage.maze);
    this.path = new Path(stage.path);
    this.pace = new Pace();
    this.timer = 0;
    this.detail = 1;
  }

  // points: [{ y, z, speed, lifted }] of the wall's path, in order.
  spray(points) {
    for (const point of points) {
      this.path.sprayTo(point.y, point.z, point.speed);
      if (point.lifted) this.path.lift();
    }
  }

  clear() {
    this.path.clear();
    this.pace.restart();
  }

  // picture: { state, look, theme, size }, see RobotView.draw.
  show(picture) {
    this.picture = picture;
    if (!this.timer) this.timer = setTimeout(() => this.#draw(), this.pace.wait(performance.now()));
  }

  dispose() {
    clearTimeout(this.timer);
    this.robot.dispose();
  }

  #draw() {
    this.timer = 0;
    const { state, look, theme, size } = this.picture;
    const begun = performance.now();
    this.robot.draw(state, this.path, look, theme, { ...size, ratio: size.ratio * this.detail });
    this.robot.finish();
    this.pace.drew(begun, performance.now() - begun);
    if (this.pace.cost > SLOW_MS) this.detail = COARSE;
  }
}
