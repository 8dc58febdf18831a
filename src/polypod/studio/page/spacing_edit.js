// Hands on the feet: pointer and arrow keys move their preferred places.

import { KeyGesture, Newest } from "/page/newest.js";
import { shiftedSpacing, shiftOf } from "/page/spacing.js";
import { newGesture } from "/page/store.js";

const KEY_STEP = 0.01; // leg lengths
const STEPS = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

export class SpacingEditor {
  // `options.symmetric` says whether the partner goes along.
  constructor(store, options) {
    this.store = store;
    this.options = options;
    this.keys = new KeyGesture();
    this.sender = new Newest(({ spacing, gesture }) => store.edit(["spacing"], spacing, gesture));
  }

  // All shifts as they are when a gesture begins.
  begin() {
    return this.store.creature.feet.map((_, k) => [...shiftOf(this.store, k)]);
  }

  // Move foot k by [left, forward] m from where it was when the gesture began.
  shift(begun, k, moved, gesture) {
    const spacing = shiftedSpacing(this.store, begun, k, moved, this.options.symmetric);
    this.sender.push({ spacing, gesture });
  }

  stroke(k, [left, forward], steps) {
    const { name, fresh } = this.keys.stroke(k);
    if (fresh) {
      this.begun = this.begin();
      this.moved = [0, 0];
    }
    const step = steps * KEY_STEP * this.store.creature.leg_length;
    this.moved = [this.moved[0] + left * step, this.moved[1] + forward * step];
    this.shift(this.begun, k, this.moved, name);
  }

  // Put foot k's shift to [left, forward] m.
  put(k, shift) {
    const begun = this.begin();
    this.keys.end();
    this.shift(begun, k, [shift[0] - begun[k][0], shift[1] - begun[k][1]], newGesture());
  }

  resetAll() {
    this.keys.end();
    this.sender.push({ spacing: this.begin().map(() => [0, 0]), gesture: newGesture() });
  }

  bindKeys(handle, k) {
    handle.addEventListener("keydown", (event) => {
      const step = STEPS[event.key];
      if (event.ctrlKey || event.metaKey || (!step && event.key !== "Delete")) return;
      event.preventDefault();
      event.stopPropagation();
      if (step) this.stroke(k, step, event.shiftKey ? 5 : 1);
      else this.put(k, [0, 0]);
    });
  }

  // `place(event)` is the pointer's [left, forward], m.
  bindPointer(handle, k, place) {
    let drag = null;
    handle.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      event.preventDefault();
      handle.focus({ preventScroll: true });
      handle.setPointerCapture(event.pointerId);
      this.keys.end();
      drag = { begun: this.begin(), from: place(event), gesture: newGesture() };
    });
    handle.addEventListener("pointermove", (event) => {
      if (!drag) return;
      const [left, forward] = place(event);
      this.shift(drag.begun, k, [left - drag.from[0], forward - drag.from[1]], drag.gesture);
    });
    for (const kind of ["pointerup", "pointercancel"]) handle.addEventListener(kind, () => { drag = null; });
    handle.addEventListener("dblclick", () => this.put(k, [0, 0]));
  }
}
