// A number with its name, unit, box and default; with `slide` a slider beside it.

import { button, html } from "/page/svg.js";
import { newGesture } from "/page/store.js";

let count = 0;

export class NumberField {
  // `commit(value, gesture)` is called with a number, or with null where `empty` (a word for what
  // holds then, such as "by speed") is given. `scale` shown units make one of the document's.
  constructor({ label, unit, range, commit, empty = null, slide = false, scale = 1, digits = 3, fallback = null }) {
    Object.assign(this, { label, commit, empty, scale, digits, fallback, value: null, gesture: undefined });
    count += 1;
    const id = `number-${count}`;
    this.unit = html("span", { class: "quiet number-unit" }, unit);
    this.box = html("input", { type: "number", id, step: "any", inputmode: "decimal" });
    this.back = button("↺", () => this.give(this.fallback), {
      "aria-label": `${label}: back to the default`, title: "Back to the default", class: "number-back",
    });
    this.element = html("div", { class: "row number" }, html("label", { for: id }, label));
    if (slide) this.element.append(this.makeSlider());
    this.element.append(this.box, this.unit, this.back);
    this.dirty = false; // typed into, and not yet given
    this.box.addEventListener("input", () => { this.dirty = true; });
    this.box.addEventListener("change", () => this.read());
    this.box.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.write();
    });
    if (range) this.bound(range);
    this.write();
  }

  makeSlider() {
    this.slider = html("input", { type: "range", "aria-label": `${this.label} slider` });
    this.slider.addEventListener("pointerdown", () => { this.gesture = newGesture(); });
    this.slider.addEventListener("input", () => {
      this.gesture ??= newGesture();
      this.commit(Number(this.slider.value) / this.scale, this.gesture);
    });
    this.slider.addEventListener("change", () => { this.gesture = undefined; });
    return this.slider;
  }

  // Take over least, most, step, unit and default as the server states them.
  bound({ least, most, step, unit, default: fallback }) {
    for (const input of [this.box, this.slider]) {
      if (!input) continue;
      input.min = this.scale * least;
      input.max = this.scale * most;
    }
    if (this.slider) this.slider.step = step ? this.scale * step : "any";
    this.box.step = "any";
    if (unit !== undefined) this.unit.textContent = unit;
    this.fallback = fallback ?? null;
    this.write();
  }

  // What the document says, and the default where that changes too.
  show(value, fallback = this.fallback) {
    if (value === this.value && fallback === this.fallback) return;
    this.value = value;
    this.fallback = fallback;
    if (!this.dirty) this.write();
    if (this.slider && value !== null) this.slider.value = this.scale * value;
    this.back.disabled = this.atDefault;
  }

  // Without a default there is nothing to return to.
  get atDefault() {
    const { value, fallback } = this;
    if (value === null || fallback === null) return fallback === null && (value === null || this.empty === null);
    return Math.abs(value - fallback) < 1e-9;
  }

  // What holds while nothing is asked, such as the period by speed.
  hint(value) {
    const words = value === null ? this.empty : `${this.format(value)} ${this.empty}`;
    if (this.box.placeholder !== words) this.box.placeholder = words;
  }

  format(value) {
    return String(Number((this.scale * value).toFixed(this.digits)));
  }

  write() {
    this.dirty = false;
    this.box.value = this.value === null ? "" : this.format(this.value);
    this.back.disabled = this.atDefault;
  }

  read() {
    const { valid, badInput } = this.box.validity;
    if (this.box.value === "" && !badInput) {
      this.give(this.empty === null ? this.fallback : null);
    } else if (valid) {
      this.give(Number(this.box.value) / this.scale);
    } else {
      this.box.reportValidity();
      this.write();
    }
  }

  // After a refusal the box shows what the document still says.
  async give(value) {
    await this.commit(value, undefined);
    this.write();
  }
}
