// Switches that this computer remembers, and whether anybody can see an element.

import { makeButton } from "/page/elements.js";

// A button that is pressed or not, kept under `name`. `change` hears of it.
export class Switch {
  constructor(words, name, first, change, attributes = {}) {
    const kept = localStorage.getItem(name);
    this.on = kept === null ? first : kept === "true";
    this.element = makeButton(words, () => {
      this.on = !this.on;
      localStorage.setItem(name, String(this.on));
      this.element.setAttribute("aria-pressed", String(this.on));
      change(this.on);
    }, { "aria-pressed": String(this.on), ...attributes });
  }
}

// True where an element can be seen at all: what is hidden need not be drawn.
export function shown(element) {
  return !document.hidden && element.getClientRects().length > 0;
}
