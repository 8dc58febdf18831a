// A foot chosen from a list, and numbers of it.

import { fillChoice, make, makeChoice } from "/page/elements.js";
import { foreToHind } from "/page/foot_order.js";

export class FootChoice {
  // `mark` hears which foot is chosen; `figures` are lines with numbers of it.
  constructor(store, mark) {
    this.store = store;
    this.mark = mark;
    this.foot = 0;
    this.figures = [];
    this.list = makeChoice("Foot", (k) => this.choose(Number(k)));
    this.element = make("div", { class: "figures" }, this.list);
    store.on("creature", () => this.fill());
    store.on("document", () => this.refresh());
  }

  show(figures) {
    this.figures = figures;
    this.element.append(...figures.map(({ element }) => element));
    this.fill();
  }

  fill() {
    const feet = this.store.creature?.feet ?? [];
    if (this.foot >= feet.length) this.foot = 0;
    fillChoice(this.list, foreToHind(feet).map((k) => [String(k), feet[k].name]), String(this.foot));
    this.choose(this.foot);
  }

  choose(k) {
    this.foot = k;
    this.list.value = String(k);
    this.mark(k);
    this.refresh();
  }

  refresh() {
    for (const figure of this.figures) figure.refresh();
  }
}
