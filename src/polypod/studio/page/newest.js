// Orders that follow the pointer: one is under way, and of those that wait only the newest goes.

import { newGesture } from "/page/store.js";

const PAUSE = 900; // ms between two key strokes that are still one gesture

export class Newest {
  // `send` takes a value and returns a promise.
  constructor(send) {
    this.send = send;
    this.busy = false;
    this.waits = false;
  }

  push(value) {
    this.value = value;
    this.waits = true;
    if (!this.busy) this.go();
  }

  async go() {
    this.busy = true;
    while (this.waits) {
      this.waits = false;
      await this.send(this.value);
    }
    this.busy = false;
  }
}

// Names of gestures for keys: strokes on one handle in quick succession are one step of undo.
export class KeyGesture {
  constructor() {
    this.last = -Infinity;
    this.of = null;
    this.name = "";
  }

  // The gesture that a stroke on `handle` belongs to, and whether it is its first.
  stroke(handle) {
    const now = performance.now();
    const fresh = handle !== this.of || now - this.last > PAUSE;
    if (fresh) this.name = newGesture();
    this.of = handle;
    this.last = now;
    return { name: this.name, fresh };
  }

  end() {
    this.of = null;
  }
}
