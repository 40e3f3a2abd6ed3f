// A live trial at the other end of a socket. It connects again by itself; then the trial goes on where it was, and its
// strokes come again from the first.

import { packInput, unpack } from './wire.js';

const FIRST_RETRY_MS = 250;
const LONGEST_RETRY_MS = 1000;
const SILENT_MS = 2000; // a robot that is held says something at least 25 times a second
const MOST_WAITING_BYTES = 4096;
const ELSEWHERE = 4001;
const GONE = [4002, 4003];

export class LiveSource {
  // address: of the socket; hear: { welcome, trial, ended, stored, finished, practised, elsewhere, gone, away }: what to
  // do about each message; away(isAway) when the connection is lost or back.
  constructor(address, hear) {
    this.address = new URL(address, window.location.href);
    this.address.protocol = this.address.protocol.replace('http', 'ws');
    this.hear = hear;
    this.retry = FIRST_RETRY_MS;
    this.isOpen = false;
    this.#forget();
  }

  connect() {
    clearTimeout(this.timer);
    const socket = new WebSocket(this.address);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    this.seq = 0;
    socket.onmessage = ({ data }) => {
      if (socket !== this.socket) return;
      if (typeof data === 'string') this.#text(JSON.parse(data));
      else this.#binary(unpack(data));
    };
    socket.onclose = ({ code }) => socket === this.socket && this.#closed(code);
  }

  // message: { type, ... }. Returns whether it could be sent.
  say(message) {
    if (!this.isOpen) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  // input as for packInput. Returns its number, or 0 if it wasn't sent: no trial, or a line so slow that inputs queue up.
  send(input, facts) {
    if (!this.isOpen || this.trial === null) return 0;
    const isUrgent = !input.enable && this.wasEnabled;
    if (this.socket.bufferedAmount > MOST_WAITING_BYTES && !isUrgent) return 0;
    this.wasEnabled = input.enable;
    this.socket.send(packInput(input, { ...facts, seq: ++this.seq }));
    this.#listenForSilence(input.enable);
    return this.seq;
  }

  // The points that came since the last call, in order.
  takePoints() {
    return this.points.splice(0);
  }

  close() {
    const { socket } = this;
    this.socket = null;
    this.isOpen = false;
    clearTimeout(this.timer);
    socket?.close();
  }

  #text(message) {
    const { type } = message;
    if (type === 'welcome') {
      this.isOpen = true;
      this.retry = FIRST_RETRY_MS;
      this.hear.away(false);
    }
    if (type === 'trial') {
      this.#forget();
      this.trial = message.trial;
    }
    if (type === 'ended' && message.trial === this.trial) this.trial = null;
    if (type === 'moved') this.hear.gone();
    else this.hear[type]?.(message);
  }

  #binary(frame) {
    if (frame?.state && frame.state.trial === this.trial) {
      this.heard = performance.now();
      if (!this.state || frame.state.frame > this.state.frame) this.state = frame.state;
    }
    if (frame?.strokes?.trial === this.trial) this.#strokes(frame.strokes);
  }

  #strokes({ first, points }) {
    if (first > this.nextPoint) {
      this.#lost(); // some are missing: after connecting again all of them come
      return;
    }
    const news = points.slice(this.nextPoint - first);
    this.nextPoint += news.length;
    this.points.push(...news);
  }

  #listenForSilence(isHeld) {
    const now = performance.now();
    if (!isHeld || !this.held) this.heard = now;
    this.held = isHeld;
    if (now - this.heard > SILENT_MS) this.#lost();
  }

  #lost() {
    const { socket } = this;
    this.#closed();
    socket.close();
  }

  #closed(code) {
    this.socket = null;
    this.isOpen = false;
    this.#forget();
    if (code === ELSEWHERE) return;
    if (GONE.includes(code)) {
      this.hear.gone();
      return;
    }
    this.hear.away(true);
    this.timer = setTimeout(() => this.connect(), this.retry);
    this.retry = Math.min(2 * this.retry, LONGEST_RETRY_MS);
  }

  #forget() {
    this.trial = null;
    this.state = null;
    this.points = [];
    this.nextPoint = 0;
    this.held = false;
    this.wasEnabled = false;
  }
}
