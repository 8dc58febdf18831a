// The scene's own words and buttons: which tool the pointer is, what to do with it, the grid's size.

import { make, makeButton } from "/page/elements.js";
import { MODES } from "/page/tools.js";

export class Toolbar {
  constructor(element, choose) {
    this.element = element;
    this.buttons = new Map();
    const bar = make("div", { class: "tools", role: "toolbar", "aria-label": "What the pointer does" });
    for (const [mode, { title, hint }] of Object.entries(MODES)) {
      const button = makeButton(title, () => choose(mode), { title: hint });
      this.buttons.set(mode, button);
      bar.append(button);
    }
    bar.addEventListener("keydown", (event) => this.along(event));
    this.hint = make("p", { class: "hint" });
    this.grid = make("p", { class: "grid" });
    this.tag = make("div", { class: "tag", "aria-hidden": "true" });
    element.append(bar, this.hint, this.grid, this.tag);
  }

  show(mode) {
    for (const [name, button] of this.buttons) {
      button.setAttribute("aria-pressed", String(name === mode));
      button.tabIndex = name === mode ? 0 : -1;
    }
    this.hint.textContent = MODES[mode].hint;
  }

  // Arrow keys move along the buttons, as in any toolbar.
  along(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    const buttons = [...this.buttons.values()];
    const at = buttons.indexOf(document.activeElement);
    buttons[(at + step + buttons.length) % buttons.length].focus();
  }

  // A short word beside the pointer; "" takes it away.
  note(text, event) {
    this.tag.textContent = text;
    this.tag.hidden = text === "";
    if (!event) return;
    const frame = this.element.getBoundingClientRect();
    this.tag.style.transform = `translate(${event.clientX - frame.left + 16}px, ${event.clientY - frame.top + 12}px)`;
  }

  showGrid(metres) {
    const words = metres >= 1 ? `${metres} m` : metres >= 0.01 ? `${Math.round(100 * metres)} cm` : `${+(1000 * metres).toPrecision(1)} mm`;
    this.grid.textContent = `Grid ${words}`;
  }
}
