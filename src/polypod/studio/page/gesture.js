// A drag as edits: one step of undo.

import { newGesture } from "/page/store.js";

const PAUSE = 500; // ms without an edit after which keys begin a new step of undo

export class Gesture {
  constructor(store) {
    this.store = store;
    this.name = newGesture();
    this.last = 0;
  }

  // Begin a new step of undo.
  begin() {
    this.name = newGesture();
  }

  // Begin a new step of undo unless the last edit was a moment ago: for keys held down.
  continue() {
    if (performance.now() - this.last > PAUSE) this.begin();
  }

  // Edit a place; resolves when that is answered.
  edit(at, to) {
    this.last = performance.now();
    return this.store.edit(at, to, this.name);
  }
}
