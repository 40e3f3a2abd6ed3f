// A pointer on the wall that takes the nozzle: the hand is where the pointer is, as long as it stays down.

const FARTHEST_M = 2; // beyond it the force has long been at its cap

// Some browsers tell of a pointer only once a frame, unless they are asked for more.
const MOVES = 'onpointerrawupdate' in window ? 'pointerrawupdate' : 'pointermove';

export class Grip {
  // onChange(at): the pointer took the nozzle, moved it, let go, or another of its buttons changed.
  constructor(wall, sight, onChange) {
    Object.assign(this, { wall, sight, onChange });
    this.release();
    this.acts = {
      pointerdown: (event) => this.#press(event),
      [MOVES]: (event) => this.#move(event),
      pointermove: (event) => this.#move(event),
      pointerup: (event) => this.#end(event),
      pointercancel: (event) => this.#end(event),
      lostpointercapture: (event) => this.#end(event),
      contextmenu: (event) => event.preventDefault(),
      blur: () => delete wall.dataset.pointed,
    };
    for (const [type, act] of Object.entries(this.acts)) wall.addEventListener(type, act);
  }

  release() {
    const { pointer } = this;
    Object.assign(this, { pointer: null, point: null, hand: null, buttons: 0 });
    if (this.wall.hasPointerCapture?.(pointer)) this.wall.releasePointerCapture(pointer);
  }

  dispose() {
    this.release();
    for (const [type, act] of Object.entries(this.acts)) this.wall.removeEventListener(type, act);
  }

  #press(event) {
    if (this.pointer !== null || !(event.buttons & 1) || !this.sight.frame) return;
    this.pointer = event.pointerId;
    // A pointer that is gone already can't be captured.
    if (event.isTrusted) this.wall.setPointerCapture(event.pointerId);
    event.preventDefault();
    this.wall.dataset.pointed = '';
    this.wall.focus({ preventScroll: true });
    this.#place(event);
  }

  // With another button down already, the first button comes as a move.
  #move(event) {
    if (event.button === 0 && this.pointer === null) this.#press(event);
    else if (event.pointerId !== this.pointer) return;
    else if (event.buttons & 1) this.#place(event);
    else this.#end(event);
  }

  #end(event) {
    if (event.pointerId !== this.pointer) return;
    this.release();
    this.onChange();
  }

  #place(event) {
    const box = this.wall.getBoundingClientRect();
    const { y, z } = this.sight.frame.wallAt(event.clientX - box.left, event.clientY - box.top);
    const limited = (v) => Math.min(FARTHEST_M, Math.max(-FARTHEST_M, v));
    const hand = { y: limited(y), z: limited(z) };
    // A move may be told twice, once at its time and once with the next picture.
    const isNews = hand.y !== this.hand?.y || hand.z !== this.hand?.z || event.buttons !== this.buttons;
    this.hand = hand;
    this.buttons = event.buttons;
    if (isNews) this.onChange(event.timeStamp);
  }
}
