// What a page shows of a state: the wall first, then the gauges and the robot.

import { TiltLook } from './cursor.js';
import { Gauges } from './gauges.js';
import { Path } from './path.js';
import { RobotStage } from './robot_stage.js';
import { WallView } from './wall_view.js';

export class Scene {
  // parts: { canvas of the wall, robot: the robot's place }; data: the page's.
  constructor(root, parts, data) {
    this.root = root;
    this.limits = data.tilt;
    this.path = new Path(data.path);
    this.tilt = new TiltLook(data.tilt);
    this.wall = new WallView(parts.canvas, data.maze, this.path, data.texts);
    this.robot = new RobotStage(parts.robot, { wall_x: data.wall_x, maze: data.maze, path: data.path });
    this.gauges = new Gauges(data.path, data.texts);
  }

  newLap() {
    this.path.clear();
    this.robot.clear();
    this.gauges.newLap();
  }

  // points: [{ y, z, speed, lifted }]: the nozzle sprayed there, in order; lifted ends a stroke.
  spray(points) {
    if (!points.length) return;
    for (const { y, z, speed, lifted } of points) {
      this.path.sprayTo(y, z, speed);
      if (lifted) this.path.lift();
    }
    this.robot.spray(points);
  }

  // An empty wall, before the first state.
  drawEmpty() {
    this.wall.draw(null);
  }

  // state: a State of a source; onWall: the same, or with the hand where the page knows it to be. Returns the words of
  // the gauges.
  draw(state, onWall = state) {
    const look = {
      look: this.tilt.at(state.tilt),
      elongation: state.tilt / this.limits.fullEllipse,
      direction: state.direction,
      spraying: state.spraying,
      idle: !state.moving,
    };
    this.wall.draw(onWall, look);
    if (state.q) this.robot.show({ y: state.y, z: state.z, q: state.q, spraying: state.spraying }, look, this.root.dataset.theme);
    return this.gauges.draw(state, look);
  }

  dispose() {
    this.robot.dispose();
  }
}
