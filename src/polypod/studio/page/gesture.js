// A drag as edits: one step of undo, one order on its way at a time, and only the latest value of
// each place after it. So a drag never runs ahead of the simulation nor floods the link.

import { newGesture } from "/page/store.js";

const PAUSE = 500; // ms without an edit after which keys begin a new step of undo

export class Gesture {
  // `settled` is called whenever nothing is on its way any more.
  constructor(store, settled = () => {}) {
    this.store = store;
    this.settled = settled;
    this.name = newGesture();
    this.waiting = new Map();
    this.asked = new Map(); // the last of each place that has not been answered
    this.busy = false;
    this.last = 0;
  }

  // Begin a new step of undo.
  begin() {
    this.name = newGesture();
  }

  // Edit a place. Without `begin`, edits that follow each other closely are one step of undo.
  edit(at, to) {
    const now = performance.now();
    this.last = now;
    this.waiting.set(JSON.stringify(at), { at, to, name: this.name });
    this.asked.set(JSON.stringify(at), to);
    this.flush();
  }

  // Begin a new step of undo unless the last edit was a moment ago: for keys held down.
  continue() {
    if (performance.now() - this.last > PAUSE) this.begin();
  }

  // What was asked for `at` and is not in the document yet, or undefined.
  pending(at) {
    return this.asked.get(JSON.stringify(at));
  }

  async flush() {
    if (this.busy) return;
    this.busy = true;
    while (this.waiting.size) {
      const [key, { at, to, name }] = this.waiting.entries().next().value;
      this.waiting.delete(key);
      await this.store.edit(at, to, name);
    }
    this.busy = false;
    this.asked.clear();
    this.settled();
  }
}
