// How often the robot is drawn. The wall comes first: where frames are slow, as without a graphics card, the robot is
// drawn less often than the wall.

const QUICK_MS = 30;
const SLOW_MS = 200;
const SLOW_FRAME_MS = 45;
const SMOOTHING = 0.2;

export class Pace {
  constructor() {
    this.frame = 0;
    this.restart();
  }

  // The next frame is drawn whatever the pace.
  restart() {
    this.before = null;
    this.drawn = -Infinity;
  }

  // now: time of the frame [ms].
  isDue(now) {
    if (this.before !== null) this.frame += SMOOTHING * (now - this.before - this.frame);
    this.before = now;
    if (now - this.drawn < (this.frame > SLOW_FRAME_MS ? SLOW_MS : QUICK_MS)) return false;
    this.drawn = now;
    return true;
  }
}
