// Hands on the feet: pointer and arrow keys move their preferred places.

import { Gesture } from "/page/gesture.js";
import { onDrag } from "/page/moves.js";
import { shiftedSpacing, shiftOf } from "/page/spacing.js";

const KEY_STEP = 0.01; // leg lengths
const PAUSE = 900; // ms between two key strokes that are still one gesture
const STEPS = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

export class SpacingEditor {
  // `symmetric` is the switch that says whether the partner goes along.
  constructor(store, symmetric) {
    this.store = store;
    this.symmetric = symmetric;
    this.gesture = new Gesture(store);
    this.stroked = null; // what keys are moving: the foot, all shifts before, and how far it went
  }

  // All shifts as they are when a gesture begins.
  begin() {
    this.gesture.begin();
    this.stroked = null;
    return this.store.creature.feet.map((_, k) => [...shiftOf(this.store, k)]);
  }

  // Move foot k by [left, forward] m from where it was when the gesture began.
  shift(begun, k, moved) {
    this.gesture.edit(["spacing"], shiftedSpacing(this.store, begun, k, moved, this.symmetric.on));
  }

  // A stroke of an arrow key: strokes in a row are one gesture and add up.
  stroke(k, [left, forward], steps) {
    const now = performance.now();
    if (this.stroked?.foot !== k || now - this.stroked.at > PAUSE) {
      this.stroked = { foot: k, begun: this.begin(), moved: [0, 0] };
    }
    const step = steps * KEY_STEP * this.store.creature.leg_length;
    const { begun, moved } = this.stroked;
    this.stroked = { foot: k, begun, moved: [moved[0] + left * step, moved[1] + forward * step], at: now };
    this.shift(begun, k, this.stroked.moved);
  }

  // Put foot k's shift to [left, forward] m.
  put(k, shift) {
    const begun = this.begin();
    this.shift(begun, k, [shift[0] - begun[k][0], shift[1] - begun[k][1]]);
  }

  resetAll() {
    this.gesture.edit(["spacing"], this.begin().map(() => [0, 0]));
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
    onDrag(handle, {
      take: (event) => ({ begun: this.begin(), from: place(event) }),
      follow: (event, { begun, from }) => {
        const [left, forward] = place(event);
        this.shift(begun, k, [left - from[0], forward - from[1]]);
      },
    });
    handle.addEventListener("dblclick", () => this.put(k, [0, 0]));
  }
}
