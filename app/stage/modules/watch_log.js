// What was watched, for how long, told to the server: one run for each stretch of a lap that was watched, one switch
// for each turn to A or B. They are numbered, so that the server keeps each once however often it is sent.

const RETRY_MS = 3000;

export class WatchLog {
  // address: where it is posted; comparison: which one; known to the server: watched { A, B } [s], runs { A, B }
  // and switches, how many there are.
  constructor({ address, comparison, watched, runs, switches, onTrouble }) {
    Object.assign(this, { address, comparison, switches, onTrouble });
    this.watched = { ...watched };
    this.runs = { ...runs };
    this.unsent = [];
    this.run = null;
  }

  begin(slot, lap) {
    this.run = { slot, lap, watched_s: 0 };
  }

  pass(dt) {
    if (!this.run) return;
    this.run.watched_s += dt;
    this.watched[this.run.slot] += dt;
  }

  // The lap's end, or a switch, a restart, leaving: whatever comes first.
  end() {
    const { run } = this;
    this.run = null;
    if (!run?.watched_s) return;
    this.unsent.push({ kind: 'run', number: ++this.runs[run.slot], ...run });
    this.send();
  }

  switchTo(slot) {
    this.unsent.push({ kind: 'switch', number: ++this.switches, slot });
    this.send();
  }

  // Resolves once the server has stored everything; one request at a time, in order.
  send() {
    this.sending ??= this.#drain().finally(() => {
      this.sending = null;
    });
    return this.sending;
  }

  // The page is going away: no time to wait for an answer.
  leave() {
    this.closed = true;
    this.end();
    if (!this.unsent.length) return;
    const body = new Blob([this.#body(this.unsent)], { type: 'application/json' });
    navigator.sendBeacon(this.address, body);
  }

  async #drain() {
    while (this.unsent.length && !this.closed) {
      const batch = this.unsent.slice();
      let answer = null;
      try {
        const headers = { 'Content-Type': 'application/json' };
        answer = await fetch(this.address, { method: 'POST', headers, body: this.#body(batch), keepalive: true });
      } catch {
        // No connection: the batch stays in the queue and is sent again below.
      }
      if (answer?.status === 409) return this.onTrouble('moved');
      if (answer?.ok || answer?.status === 422) {
        this.unsent.splice(0, batch.length);
        const { watched } = await answer.json();
        if (watched) this.#agree(watched);
        this.onTrouble(null);
      } else {
        this.onTrouble('offline');
        await new Promise((resolve) => setTimeout(resolve, RETRY_MS));
      }
    }
    return null;
  }

  // The server counts, since it refuses what two windows watched at the same time; what it hasn't heard of is added.
  #agree(watched) {
    this.watched = { ...watched };
    for (const run of [...this.unsent, this.run]) if (run?.watched_s) this.watched[run.slot] += run.watched_s;
  }

  #body(events) {
    return JSON.stringify({ comparison: this.comparison, events });
  }
}
