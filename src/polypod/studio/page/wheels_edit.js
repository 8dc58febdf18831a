// Hands on the wheels: pointer and keys move a sector's start, its finish or the whole of it.

import { disksOf, eventsOf, isDrawn, partnerOf, shiftedDisks, shortWay, snappedShift, wrap } from "/page/disks.js";
import { Gesture } from "/page/gesture.js";
import { onDrag } from "/page/moves.js";

const DRAWN = "edited"; // what a gait is called that was changed by hand
const PAUSE = 900; // ms between two key strokes that are still one gesture
const KEY_STEP = 0.01; // of the cycle
const STEPS = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };

// Changes of the gait: every edit states all disks, so that what is asked for is whole.
export class GaitEditor {
  // `snap` and `mirror` are switches.
  constructor(store, snap, mirror) {
    this.store = store;
    this.snap = snap;
    this.mirror = mirror;
    this.gesture = new Gesture(store);
    this.stroked = null; // what keys are moving: the grip, and how far it went
    this.origin = null; // the disks before they were drawn anew: what a number's default is
    store.on("creature", () => { this.origin = null; });
  }

  // What a gesture on foot k begins from, or null while nothing is known.
  begin(k) {
    const disks = disksOf(this.store);
    if (!disks) return null;
    this.gesture.begin();
    this.stroked = null;
    if (!isDrawn(this.store)) this.origin = disks;
    const partner = this.mirror.on ? partnerOf(this.store.creature.feet, k) : -1;
    return { k, disks: { start: [...disks.start], extent: [...disks.extent] }, partner };
  }

  // Where other feet lift and land, to which this gesture snaps.
  events({ disks, k, partner }) {
    return eventsOf(disks, [k, partner]);
  }

  shift(grip, part, delta) {
    const disks = shiftedDisks(grip.disks, grip.k, part, delta, grip.partner);
    this.gesture.edit(["gait"], { name: DRAWN, ...disks });
  }

  drag(grip, part, delta, free) {
    const disk = { start: grip.disks.start[grip.k], extent: grip.disks.extent[grip.k] };
    const snaps = this.snap.on && !free;
    this.shift(grip, part, snaps ? snappedShift(disk, part, delta, this.events(grip)) : delta);
  }

  // A stroke of an arrow key. Strokes in a row are one gesture and add up, though the server may
  // not have answered the first yet.
  stroke(k, part, delta) {
    const now = performance.now();
    const goes = this.stroked?.handle === `${k} ${part}` && now - this.stroked.at < PAUSE;
    if (!goes) {
      const grip = this.begin(k);
      if (!grip) return;
      this.stroked = { handle: `${k} ${part}`, grip, moved: 0 };
    }
    this.stroked.at = now;
    this.stroked.moved += delta;
    this.shift(this.stroked.grip, part, this.stroked.moved);
  }

  // A phase typed for a start or a finish.
  put(k, part, phase) {
    const grip = this.begin(k);
    if (!grip) return;
    const start = grip.disks.start[k];
    const extent = grip.disks.extent[k];
    // A swing from lift-off to touchdown, wherever on the circle both are.
    const delta = part === "start"
      ? extent - wrap(start + extent - phase)
      : wrap(phase - start) - extent;
    this.shift(grip, part, delta);
  }
}

export function bindWheel(wheel, editor) {
  for (const [part, handle] of Object.entries(wheel.handles)) {
    bindPointer(wheel, part, handle, editor);
    handle.addEventListener("keydown", (event) => {
      const step = STEPS[event.key];
      if (step === undefined || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      event.stopPropagation();
      editor.stroke(wheel.index, part, step * KEY_STEP * (event.shiftKey ? 5 : 1));
    });
  }
}

function bindPointer(wheel, part, handle, editor) {
  const phaseAt = (event) => {
    const box = wheel.picture.getBoundingClientRect();
    const x = event.clientX - box.left - box.width / 2;
    const y = event.clientY - box.top - box.height / 2;
    return Math.atan2(x, -y) / (2 * Math.PI);
  };
  onDrag(handle, {
    take: (event) => {
      const grip = editor.begin(wheel.index);
      if (!grip) return null;
      const { feet } = editor.store.creature;
      wheel.showEvents(editor.events(grip).map(({ phase, foot }) => ({ phase, colour: feet[foot].colour })));
      wheel.element.classList.add("held");
      return { grip, last: phaseAt(event), turned: 0 };
    },
    follow: (event, drag) => {
      const phase = phaseAt(event);
      // Turns add up, so that a hand that goes round past the top goes on.
      drag.turned += shortWay(phase - drag.last);
      drag.last = phase;
      editor.drag(drag.grip, part, drag.turned, event.altKey);
    },
    release: () => {
      wheel.showEvents([]);
      wheel.element.classList.remove("held");
    },
  });
}
