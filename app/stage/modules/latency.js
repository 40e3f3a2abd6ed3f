// The time from an input to the first picture that shows it [ms]: measured here, told to the server with later inputs.

const MOST_WAITING = 500;
const LONGEST_MS = 60_000; // a page that slept for longer measures nothing that the server would take

export class Latency {
  constructor() {
    this.sent = [];
    this.measured = [];
  }

  // An input went out; now: when the hand did what it says.
  began(seq, now) {
    this.sent.push({ seq, now });
    if (this.sent.length > MOST_WAITING) this.sent.shift();
  }

  // A picture of a state is drawn, computed with this input.
  drew(seq, now) {
    while (this.sent.length && this.sent[0].seq <= seq) this.measured.push(now - this.sent.shift().now);
    if (this.measured.length > MOST_WAITING) this.measured.splice(0, this.measured.length - MOST_WAITING);
  }

  // The oldest measurement not told yet; -1 if there is none.
  take() {
    return Math.min(this.measured.shift() ?? -1, LONGEST_MS);
  }

  // The robot rests, or is gone: what was sent is not going to be shown soon.
  forget() {
    this.sent = [];
  }
}
