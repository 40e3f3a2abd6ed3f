// How often the robot is drawn: by what drawing it costs, so that it never takes more than its share of the time.

const MOST_OFTEN_MS = 30;
const SHARE = 0.25;
const SMOOTHING = 0.3;

export class Pace {
  constructor() {
    this.cost = 0;
    this.restart();
  }

  // The next picture is due at once, whatever the pace.
  restart() {
    this.due = -Infinity;
  }

  // Milliseconds from now until the next picture is due.
  wait(now) {
    return Math.max(0, this.due - now);
  }

  // A picture was begun at a time and took so long [ms].
  drew(begun, took) {
    this.cost += SMOOTHING * (took - this.cost);
    this.due = begun + Math.max(MOST_OFTEN_MS, Math.max(took, this.cost) / SHARE);
  }
}
