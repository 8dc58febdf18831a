// A slider over what was recorded: drag or keys show a frame of it.

import { make } from "/page/elements.js";
import { tapeRate } from "/page/history.js";
import { onDrag } from "/page/moves.js";

const PATIENCE = 1000; // ms for which the next stroke goes on from where the last one is to lead

export class Scrubber {
  constructor(store) {
    this.store = store;
    this.wanted = null;
    this.busy = false;
    this.waits = false;
    this.knob = make("div", { class: "scrub-knob" });
    this.element = make("div", {
      class: "scrub", role: "slider", tabindex: 0, "aria-label": "Recorded time",
      "aria-valuemin": 0, "aria-orientation": "horizontal",
    }, this.knob);
    this.element.addEventListener("keydown", (event) => this.press(event));
  }

  get last() {
    return Math.max(this.store.tape.frames - 1, 0);
  }

  get rate() {
    return tapeRate(this.store);
  }

  // Where the tape is shown at; null while the simulation is.
  get frame() {
    return this.store.frame?.tapeFrame ?? this.store.tape.scrub;
  }

  go(frame) {
    const wanted = Math.min(Math.max(Math.round(frame), 0), this.last);
    this.wanted = { frame: wanted, at: performance.now() };
    this.order(wanted);
  }

  live() {
    this.wanted = null;
    this.order(null);
  }

  // One order is on its way at a time, and only the newest after it.
  async order(frame) {
    this.next = frame;
    this.waits = true;
    if (this.busy) return;
    this.busy = true;
    while (this.waits) {
      this.waits = false;
      const order = { do: "scrub", frame: this.next };
      await this.store.send(order).catch((refusal) => this.store.say(refusal.message));
    }
    this.busy = false;
  }

  press(event) {
    const second = Math.round(this.rate);
    const step = event.shiftKey ? 10 : 1;
    // Strokes in a row add up before the first of them is answered.
    const recent = this.wanted && performance.now() - this.wanted.at < PATIENCE;
    const at = recent ? this.wanted.frame : this.frame ?? this.last;
    const to = {
      ArrowRight: at + step, ArrowUp: at + step, ArrowLeft: at - step, ArrowDown: at - step,
      PageUp: at + second, PageDown: at - second, Home: 0, End: this.last,
    }[event.key];
    if (to === undefined && event.key !== "Escape") return;
    event.preventDefault();
    event.stopPropagation();
    if (to === undefined) this.live();
    else this.go(to);
  }

  // `share` of an element's width from `gutter` on, as a drag on it.
  bind(element, gutter, enabled) {
    const follow = (event) => {
      const box = element.getBoundingClientRect();
      this.go(((event.clientX - box.left - gutter) / (box.width - gutter)) * this.last);
    };
    const take = (event) => {
      if (!enabled()) return null;
      follow(event);
      return true;
    };
    onDrag(element, { take, follow, focused: this.element });
  }

  show() {
    const { frames, seconds } = this.store.tape;
    const at = this.frame;
    this.element.setAttribute("aria-valuemax", String(this.last));
    this.element.setAttribute("aria-valuenow", String(at ?? this.last));
    const words = at === null
      ? `live; ${seconds.toFixed(2)} s are recorded`
      : `${(at / this.rate).toFixed(2)} s of ${seconds.toFixed(2)} s`;
    this.element.setAttribute("aria-valuetext", words);
    this.knob.style.left = `${frames > 1 ? (100 * (at ?? this.last)) / this.last : 0}%`;
    this.knob.classList.toggle("away", at === null);
  }
}
