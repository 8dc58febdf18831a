// Switches that this computer remembers, and whether anybody can see an element, or sees another now.

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

const lookers = [];

// Call `look` whenever something else of the page may have come into view: while time stands nothing
// else would bring what is shown there up to date.
export function whenShown(look) {
  lookers.push(look);
}

export function tellShown() {
  for (const look of lookers) look();
}

document.addEventListener("toggle", tellShown, true); // a section; that event rises to nobody
document.addEventListener("visibilitychange", tellShown);
