// A number with its name, its unit and a button back to its default, in a line without a slider.

import { make, makeButton } from "/page/elements.js";
import { NumberBox } from "/page/number_box.js";
import { withUnit } from "/page/units.js";

export class Figure {
  // As of `NumberBox`; `standard` gives the default in the document's units, null where there is
  // none to go back to.
  constructor({ label, standard, ...box }) {
    this.standard = standard;
    this.write = box.write;
    this.label = label;
    this.box = new NumberBox({ label, ...box });
    this.reset = makeButton("↺", () => this.write(this.standard()), { class: "reset" });
    this.element = make("div", { class: "figure-line", role: "group", "aria-label": label },
      make("span", { "aria-hidden": "true" }, label), this.box.element, this.reset);
    this.refresh();
  }

  refresh() {
    this.box.refresh();
    const [value, standard] = [this.box.read(), this.standard()];
    this.reset.disabled = standard === null || this.box.text(value) === this.box.text(standard);
    const words = standard === null ? "none" : withUnit(this.box.text(standard), this.box.named);
    if (this.reset.title === `Default: ${words}`) return;
    this.reset.title = `Default: ${words}`;
    this.reset.setAttribute("aria-label", `${this.label}: back to default, ${words}`);
  }
}
