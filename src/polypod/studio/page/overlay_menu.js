// The menu of overlays: a switch for each, with its colours and their meaning.

import { make, makeButton, makeTick } from "/page/elements.js";
import { OVERLAYS } from "/page/overlays.js";

export class OverlayMenu {
  constructor(overlays) {
    this.overlays = overlays;
    this.button = makeButton("Overlays", () => this.open(this.menu.hidden), {
      "aria-haspopup": "true", "aria-controls": "overlay-menu",
    });
    this.menu = make("div", {
      id: "overlay-menu", class: "menu", role: "group", "aria-label": "Overlays",
    });
    this.ticks = new Map();
    for (const [name, { title, legend }] of Object.entries(OVERLAYS)) this.add(name, title, legend);
    this.element = make("div", { class: "menuholder" }, this.button, this.menu);
    this.element.addEventListener("keydown", (event) => this.key(event));
    document.addEventListener("pointerdown", (event) => {
      if (!this.element.contains(event.target)) this.open(false);
    });
    overlays.onChange(() => this.refresh());
    this.open(false);
    this.refresh();
  }

  add(name, title, legend) {
    const { element, box } = makeTick(title, (on) => this.overlays.set(name, on));
    const colours = legend.map(([colour, words]) => {
      const patch = make("i", { "aria-hidden": "true" });
      patch.style.background = colour;
      return make("span", {}, patch, words);
    });
    this.ticks.set(name, box);
    this.menu.append(make("div", { class: "choice" }, element, make("div", { class: "legend" }, ...colours)));
  }

  open(on) {
    this.menu.hidden = !on;
    this.button.setAttribute("aria-expanded", String(on));
    if (on) this.ticks.values().next().value.focus();
  }

  key(event) {
    if (event.key !== "Escape" || this.menu.hidden) return;
    event.stopPropagation();
    this.open(false);
    this.button.focus();
  }

  refresh() {
    let shown = 0;
    for (const [name, box] of this.ticks) {
      box.checked = this.overlays.has(name);
      if (box.checked) shown += 1;
    }
    this.button.textContent = `Overlays (${shown})`;
  }
}
