// A slider: label, range, number box with its unit, and a button back to its default. A drag is one
// step of undo. What follows by itself (a tempo by speed) shows what it is until someone takes hold.

import { make, makeButton, makeTick } from "/page/elements.js";
import { Gesture } from "/page/gesture.js";
import { MOVE } from "/page/moves.js";
import { NumberBox } from "/page/number_box.js";
import { decimalsOf, shownAs, withUnit } from "/page/units.js";

const KNOB = 16; // px wide, in browsers that tell of moves at once

let sliders = 0;

export class Slider {
  // `range` gives {least, most, default, unit, step}, `read` the value, `write(value, fresh)` takes
  // one: `fresh` is true where a new step of undo begins. With `automatic` {words, live}, null is
  // a value too: `live` gives the number that then holds, or null where none is known. With
  // `unset`, null stands for the default, and the button writes it.
  constructor({ label, range, read, write, automatic = null, unset = false }) {
    Object.assign(this, { label, range, read, write, automatic, unset });
    this.held = false;
    this.build();
  }

  build() {
    sliders += 1;
    const id = `slider-${sliders}`;
    this.input = make("input", { type: "range", id });
    this.box = new NumberBox({
      label: this.label,
      read: () => this.shown(),
      write: (value) => this.write(value, true),
    });
    this.reset = makeButton("↺", () => this.write(this.unset ? null : this.standard(), true), {
      class: "reset",
    });
    this.element = make(
      "div", { class: "slider", role: "group", "aria-label": this.label },
      make("label", { for: id }, this.label), this.input, this.box.element, this.reset,
    );
    if (this.automatic) {
      this.tick = makeTick(this.automatic.words, (on) => {
        this.write(on ? null : this.pinned(), true);
      });
      this.tick.box.setAttribute("aria-label", `${this.label} ${this.automatic.words}`);
      this.element.append(this.tick.element);
    }
    this.listen();
  }

  listen() {
    this.input.addEventListener("pointerdown", () => { this.held = true; this.fresh = true; });
    this.input.addEventListener("keydown", (event) => { this.fresh = !event.repeat; });
    this.input.addEventListener("input", () => {
      this.write(Number(this.input.value), this.fresh ?? true);
      this.fresh = false;
      this.spell(Number(this.input.value));
    });
    this.input.addEventListener(MOVE, (event) => this.follow(event));
    const release = () => { this.held = false; };
    this.input.addEventListener("pointerup", release);
    this.input.addEventListener("change", release);
    this.input.addEventListener("pointercancel", release);
    this.input.addEventListener("blur", release);
  }

  // The browser moves its knob only once a picture, and then finds it where it would have it.
  follow({ type, pointerType, clientX }) {
    if (!this.held || type === "pointermove" || pointerType === "touch") return;
    const { input } = this;
    const along = clientX - input.getBoundingClientRect().left - input.clientLeft - KNOB / 2;
    const { least, most } = this.range();
    const before = input.value;
    input.value = least + ((most - least) * along) / (input.clientWidth - KNOB);
    if (input.value !== before) input.dispatchEvent(new Event("input", { bubbles: true }));
  }

  // What holds by itself, as a number to keep: no more digits than are shown.
  pinned() {
    const { least, most, step } = this.range();
    return Number((this.automatic.live() ?? (least + most) / 2).toFixed(decimalsOf(step)));
  }

  // What the default button goes back to.
  standard() {
    return this.automatic ? null : this.range().default;
  }

  // The number to show: what is asked for, else what holds by itself, else the default.
  shown() {
    const asked = this.read();
    if (asked !== null && asked !== undefined) return asked;
    return this.automatic ? this.automatic.live() : this.range().default;
  }

  // Show what holds now. While it is being dragged the slider stays with the pointer.
  refresh() {
    const range = this.range();
    const asked = this.read();
    const value = this.shown();
    const unit = shownAs(range);
    this.box.show({ ...unit, step: range.step * unit.factor });
    if (!this.held) {
      Object.assign(this.input, { min: range.least, max: range.most, step: range.step });
      this.input.value = value ?? range.least;
      this.spell(value);
    }
    this.box.refresh();
    if (this.tick) this.tick.box.checked = asked === null;
    this.element.classList.toggle("automatic", Boolean(this.tick) && asked === null);
    this.markDefault(asked, range, unit);
  }

  spell(value) {
    this.input.setAttribute("aria-valuetext", value === null ? "unknown" : this.box.spoken(value));
  }

  markDefault(asked, range, { factor, unit }) {
    const standard = this.standard();
    const near = 1e-6 * (range.most - range.least);
    const same = standard === null || asked === null
      ? asked === standard || standard !== null
      : Math.abs(asked - standard) <= near;
    this.reset.disabled = same;
    const words = standard === null
      ? this.automatic.words
      : withUnit((standard * factor).toFixed(decimalsOf(range.step * factor)), unit);
    if (this.reset.title === `Default: ${words}`) return;
    this.reset.title = `Default: ${words}`;
    this.reset.setAttribute("aria-label", `${this.label}: back to default, ${words}`);
  }
}

// A slider of a place in the document.
export function documentSlider(store, { label, at, range, automatic, unset }) {
  const gesture = new Gesture(store);
  return new Slider({
    label,
    range,
    automatic,
    unset,
    read: () => at.reduce((part, key) => part?.[key], store.wanted) ?? null,
    write: (value, fresh) => {
      if (fresh) gesture.begin();
      return gesture.edit(at, value);
    },
  });
}
