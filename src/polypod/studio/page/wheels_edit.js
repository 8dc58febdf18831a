// Hands on the wheels: pointer and keys move a sector's start, its finish or the whole of it.

import { disksOf, eventsOf, isDrawn, partnerOf, shiftedDisks, shortWay, snappedShift, wrap } from "/page/disks.js";
import { KeyGesture, Newest } from "/page/newest.js";
import { newGesture } from "/page/store.js";

const EDITED = "edited"; // what a gait is called that was changed by hand
const KEY_STEP = 0.01; // of the cycle
const STEPS = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };

// Changes of the gait: every edit states all disks, so that what is asked for is whole.
export class GaitEditor {
  // `options` says `snap` and `mirror` as they are now.
  constructor(store, options) {
    this.store = store;
    this.options = options;
    this.keys = new KeyGesture();
    this.origin = null; // the disks before they were edited: what a number's default is
    this.sender = new Newest(({ disks, gesture }) => (
      store.edit(["gait"], { name: EDITED, start: disks.start, extent: disks.extent }, gesture)));
  }

  // What a gesture on foot k begins from, or null while nothing is known.
  begin(k) {
    const disks = disksOf(this.store);
    if (!disks) return null;
    if (!isDrawn(this.store)) this.origin = disks;
    const partner = this.options.mirror ? partnerOf(this.store.creature.feet, k) : -1;
    return { k, disks: { start: [...disks.start], extent: [...disks.extent] }, partner };
  }

  // Where other feet lift and land, to which this gesture snaps.
  events({ disks, k, partner }) {
    return eventsOf(disks, [k, partner]);
  }

  shift(grip, part, delta, gesture) {
    this.sender.push({ disks: shiftedDisks(grip.disks, grip.k, part, delta, grip.partner), gesture });
  }

  drag(grip, part, delta, free, gesture) {
    const disk = { start: grip.disks.start[grip.k], extent: grip.disks.extent[grip.k] };
    const snaps = this.options.snap && !free;
    const moved = snaps ? snappedShift(disk, part, delta, this.events(grip)) : delta;
    this.shift(grip, part, moved, gesture);
  }

  // A stroke of an arrow key: strokes in a row add up, though the server may not have answered yet.
  stroke(k, part, delta) {
    const { name, fresh } = this.keys.stroke(`${k} ${part}`);
    if (fresh) {
      this.grip = this.begin(k);
      this.moved = 0;
    }
    if (!this.grip) return;
    this.moved += delta;
    this.shift(this.grip, part, this.moved, name);
  }

  // A phase typed for a start or a finish.
  put(k, part, phase) {
    const grip = this.begin(k);
    if (!grip) return;
    const { start, extent } = grip.disks;
    // A swing from lift-off to touchdown, wherever on the circle both are.
    const delta = part === "start"
      ? extent[k] - wrap(start[k] + extent[k] - phase)
      : wrap(phase - start[k]) - extent[k];
    this.shift(grip, part, delta, newGesture());
    this.keys.end();
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
  let drag = null;
  const phaseAt = (event) => {
    const box = wheel.picture.getBoundingClientRect();
    const x = event.clientX - box.left - box.width / 2;
    const y = event.clientY - box.top - box.height / 2;
    return Math.atan2(x, -y) / (2 * Math.PI);
  };
  handle.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    const grip = editor.begin(wheel.index);
    if (!grip) return;
    event.preventDefault();
    handle.focus({ preventScroll: true });
    handle.setPointerCapture(event.pointerId);
    editor.keys.end();
    drag = { grip, gesture: newGesture(), last: phaseAt(event), turned: 0 };
    const { feet } = editor.store.creature;
    wheel.showEvents(editor.events(grip).map(({ phase, foot }) => ({ phase, colour: feet[foot].colour })));
    wheel.element.classList.add("held");
  });
  handle.addEventListener("pointermove", (event) => {
    if (!drag) return;
    const phase = phaseAt(event);
    // Turns add up, so that a hand that goes round past the top goes on.
    drag.turned += shortWay(phase - drag.last);
    drag.last = phase;
    editor.drag(drag.grip, part, drag.turned, event.altKey, drag.gesture);
  });
  const end = () => {
    drag = null;
    wheel.showEvents([]);
    wheel.element.classList.remove("held");
  };
  handle.addEventListener("pointerup", end);
  handle.addEventListener("pointercancel", end);
}
