// Where states come from. Every source has
//   open(slot, lap) -> Promise        gets ready at the start of a lap
//   advance(dt) -> Step               lets dt seconds pass
// with Step = { state, sprayed: points { y, z, speed, lifted } since the last step, share 0..1 of the lap, ended: null or
// an outcome }.
// A recorded source plays a lap back; dt is the clock of the page.

import { Lap } from './lap.js';

export class RecordedSource {
  // address(slot, lap): where the server keeps a lap.
  constructor(address) {
    this.address = address;
    this.laps = new Map();
  }

  async open(slot, lap) {
    this.lap = await this.#load(slot, lap);
    this.time = 0;
    this.row = -1;
  }

  // Gets a lap before it is needed; a failure shows when it is opened.
  prepare(slot, lap) {
    this.#load(slot, lap).catch(() => {});
  }

  advance(dt) {
    const { lap } = this;
    this.time = Math.min(lap.duration, this.time + dt);
    const last = Math.min(lap.count - 1, Math.floor(this.time * lap.hz));
    const sprayed = [];
    while (this.row < last) {
      const { y, z, speed, spraying } = lap.at(++this.row / lap.hz);
      const goesOn = this.row + 1 < lap.count && lap.at((this.row + 1) / lap.hz).spraying;
      if (spraying) sprayed.push({ y, z, speed, lifted: !goesOn });
    }
    const ended = this.time >= lap.duration ? lap.outcome : null;
    return { state: lap.at(this.time), sprayed, share: this.time / lap.duration, ended };
  }

  #load(slot, lap) {
    const key = `${slot}${lap}`;
    if (!this.laps.has(key)) {
      const loading = this.#fetch(slot, lap);
      loading.catch(() => this.laps.delete(key));
      this.laps.set(key, loading);
    }
    return this.laps.get(key);
  }

  async #fetch(slot, lap) {
    const answer = await fetch(this.address(slot, lap), { credentials: 'same-origin' });
    if (!answer.ok) throw new Error(`lap ${slot}${lap}: ${answer.status}`);
    return new Lap(await answer.arrayBuffer());
  }
}
