// The robot painter in a worker: without a graphics card a picture takes three frames, which the wall must not wait for.

import { RobotPainter } from './robot_painter.js';

let painter = null;

self.onmessage = ({ data }) => {
  const [act, ...given] = data;
  if (act === 'start') painter = new RobotPainter(...given);
  else painter[act](...given);
};
