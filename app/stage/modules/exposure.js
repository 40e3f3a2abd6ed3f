// How long each method was in hand [s]: what the server has stored, and what it can't have stored yet.

export class Exposure {
  constructor(stored) {
    this.agree(stored);
    this.running = { slot: null, seconds: 0 };
  }

  // What is stored now: all but the trial under way.
  agree(stored) {
    this.stored = { ...stored };
    this.ended = { A: 0, B: 0 };
  }

  // The trial under way has lasted so long.
  run(slot, seconds) {
    this.running = { slot, seconds };
  }

  // The trial under way is over; it counts on until it is stored.
  end() {
    const { slot, seconds } = this.running;
    if (slot) this.ended[slot] += seconds;
    this.running = { slot: null, seconds: 0 };
  }

  get total() {
    const { slot, seconds } = this.running;
    const of = (each) => this.stored[each] + this.ended[each] + (each === slot ? seconds : 0);
    return { A: of('A'), B: of('B') };
  }
}
