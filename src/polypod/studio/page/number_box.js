// A number with its unit, typed. Enter or leaving the box takes it, Escape gives it up.

import { make } from "/page/elements.js";
import { withUnit } from "/page/units.js";

export class NumberBox {
  // `read` gives the value or null (shown empty), `write` takes a new one; both in the document's
  // units, of which `factor` makes those shown. `words` are shown in place of a missing value, `tag`
  // beside the box in place of the unit, where that is said once for several.
  constructor({
    label, unit = "", factor = 1, decimals = 3, read, write, words = "", tag = null, step = null,
  }) {
    Object.assign(this, { label, read, write, tag });
    this.input = make("input", { type: "number", step: "any", class: "number", placeholder: words });
    this.unit = make("span", { class: "unit", "aria-hidden": "true" });
    this.element = make("span", { class: "numberbox" }, this.input, this.unit);
    this.dirty = false;
    this.show({ unit, factor, decimals, step });
    this.input.addEventListener("input", () => { this.dirty = true; });
    this.input.addEventListener("change", () => this.take());
    this.input.addEventListener("blur", () => { this.dirty = false; this.refresh(); });
    this.input.addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !this.dirty) return;
      event.stopPropagation();
      this.dirty = false;
      this.refresh();
    });
  }

  // Show values in another unit. `step` is what the box's own arrows go by, in what is shown.
  show({ unit, factor, decimals, step = null }) {
    Object.assign(this, { factor, decimals });
    this.unit.textContent = this.tag ?? unit;
    this.named = unit;
    this.input.setAttribute("aria-label", withUnitNamed(this.label, unit));
    this.input.step = step ?? "any";
  }

  async take() {
    const typed = this.input.valueAsNumber;
    this.dirty = false;
    if (Number.isFinite(typed)) await this.write(typed / this.factor);
    else if (this.input.placeholder && this.input.value === "" && !this.input.validity.badInput) {
      await this.write(null);
    }
    // What was refused, or is no number, gives way to what holds.
    if (!this.dirty) this.refresh();
  }

  refresh() {
    if (this.dirty) return;
    const value = this.read();
    const text = this.text(value);
    if (this.input.value !== text) this.input.value = text;
  }

  text(value) {
    if (value === null || value === undefined) return "";
    const text = (value * this.factor).toFixed(this.decimals);
    // No "-0.00".
    return Number(text) === 0 ? (0).toFixed(this.decimals) : text;
  }

  spoken(value) {
    return withUnit(this.text(value), this.named);
  }
}

function withUnitNamed(label, unit) {
  const named = unit === "°" ? "degrees" : unit === "°/s" ? "degrees a second" : unit;
  return named && named !== "×" ? `${label} in ${named}` : label;
}
