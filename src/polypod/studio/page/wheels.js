// All wheels, laid out as the creature stands: left and right by side, fore above hind.

import { redraw } from "/page/canvas.js";
import { Circle } from "/page/circle.js";
import { disksInUse, disksOf, isDrawn, needleNow, wrap } from "/page/disks.js";
import { make } from "/page/elements.js";
import { shortNames } from "/page/foot_names.js";
import { shown } from "/page/switches.js";
import { HALF, Wheel } from "/page/wheel.js";
import { bindWheel } from "/page/wheels_edit.js";

const SIZES = [[2, 132], [3, 108]]; // rows, and pixels of a wheel
const SMALLEST = 84;
const FRAMES_A_SECOND = 60;
const FINGER = 12; // px round a handle's middle

export class Wheels {
  constructor(store, editor, chosen) {
    this.store = store;
    this.editor = editor;
    this.chosen = chosen; // called with the foot whose wheel is touched
    this.wheels = [];
    this.element = make("div", { class: "wheels", role: "group", "aria-label": "Gait wheels" });
    this.circle = new Circle(store);
    store.on("creature", () => this.build());
    store.on("document", () => this.showAsked());
    store.on("frame", redraw(FRAMES_A_SECOND, () => this.showFrame()));
    this.build();
    const turn = () => {
      requestAnimationFrame(turn);
      if (this.wheels.length === 0 || !shown(this.element)) return;
      const needle = needleNow(store) + this.circle.turn;
      for (const wheel of this.wheels) wheel.showNeedle(needle);
    };
    turn();
  }

  build() {
    const feet = this.store.creature?.feet ?? [];
    // The same feet again: what has the focus keeps it.
    const made = JSON.stringify(feet);
    if (made === this.made) return;
    this.made = made;
    const rows = [...new Set(feet.map((foot) => foot.row))].sort((a, b) => b - a);
    const size = SIZES.find(([count]) => rows.length <= count)?.[1] ?? SMALLEST;
    const short = shortNames(feet);
    this.wheels = feet.map((foot, k) => new Wheel(foot, k, (2 * HALF * FINGER) / size, short[k]));
    this.element.style.setProperty("--wheel", `${size}px`);
    this.element.replaceChildren(...rows.map((row) => this.makeRow(row)));
    for (const wheel of this.wheels) {
      bindWheel(wheel, this.editor);
      wheel.element.addEventListener("focusin", () => this.chosen(wheel.index));
    }
    this.showAsked();
    this.showFrame();
  }

  makeRow(row) {
    const line = make("div", { class: "wheel-row" });
    for (const side of [1, 0, -1]) {
      const there = this.wheels.filter(({ foot }) => foot.row === row && Math.sign(foot.side) === side);
      line.append(...there.map(({ element }) => element));
    }
    return line;
  }

  mark(k) {
    for (const wheel of this.wheels) wheel.element.classList.toggle("chosen", wheel.index === k);
  }

  showAsked() {
    const disks = disksOf(this.store);
    if (!disks || disks.start.length !== this.wheels.length) return;
    // What was drawn by hand is where the hand put it.
    const turn = isDrawn(this.store) ? 0 : this.circle.turn;
    this.wheels.forEach((wheel, k) => wheel.showAsked(wrap(disks.start[k] + turn), disks.extent[k]));
  }

  showFrame() {
    const disks = disksInUse(this.store);
    if (!disks || disks.start.length !== this.wheels.length || !shown(this.element)) return;
    const { feet } = this.store.frame.focus;
    this.wheels.forEach((wheel, k) => {
      const { start, extent } = this.circle.shown(k, feet[k]);
      wheel.showDisk(start, extent);
      wheel.showState(!feet[k].stance, feet[k].next);
    });
    if (!isDrawn(this.store)) this.showAsked();
  }
}
