// Sends what a device says: at once when something changes, and as a heartbeat while nothing does.

const LEAST_GAP_MS = 8;
const HEARTBEAT_MS = 16;

export class InputPump {
  // send(now, since): sends one input; since when there was something to send.
  constructor(send) {
    this.send = send;
    this.sent = -Infinity;
    this.told = -Infinity; // when the last change was sent: heartbeats between don't hold the next one up
    this.changed = null;
    this.pending = 0;
    this.beating = 0;
  }

  start() {
    if (this.beating) return;
    this.beating = setInterval(() => {
      if (performance.now() - this.sent >= HEARTBEAT_MS - 3) this.#send();
    }, HEARTBEAT_MS);
  }

  stop() {
    clearInterval(this.beating);
    clearTimeout(this.pending);
    this.beating = 0;
    this.pending = 0;
    this.changed = null;
  }

  // Something changed, when the event says. Changes closer together than the least gap go out as one.
  poke(at = performance.now()) {
    if (!this.beating) return;
    this.changed ??= at;
    if (this.pending) return;
    const wait = this.told + LEAST_GAP_MS - performance.now();
    if (wait <= 0) this.#send();
    else this.pending = setTimeout(() => this.#send(), wait);
  }

  // Sends whatever the gap: letting go must not wait.
  flush() {
    if (this.beating) this.#send();
  }

  #send() {
    clearTimeout(this.pending);
    this.pending = 0;
    this.sent = performance.now();
    const since = Math.min(this.changed ?? this.sent, this.sent);
    if (this.changed !== null) this.told = this.sent;
    this.changed = null;
    this.send(this.sent, since);
  }
}
