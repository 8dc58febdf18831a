// The chosen foot's disk in numbers: when it lifts and lands, and its duty.

import { disksOf, isDrawn, rounded } from "/page/disks.js";
import { fillChoice, make, makeChoice } from "/page/elements.js";
import { Figure } from "/page/figure.js";
import { shown } from "/page/switches.js";

export class FootNumbers {
  constructor(store, editor, mark) {
    this.store = store;
    this.editor = editor;
    this.mark = mark;
    this.foot = 0;
    this.choice = makeChoice("Foot", (k) => this.choose(Number(k)));
    this.figures = [
      this.makeFigure("Lifts at", ({ start }) => start, (phase) => editor.put(this.foot, "start", phase)),
      this.makeFigure("Lands at", ({ start, extent }) => start + extent, (phase) => editor.put(this.foot, "finish", phase)),
      this.makeFigure("Stands for", ({ extent }) => 1 - extent, (duty) => this.putDuty(duty)),
    ];
    this.element = make("div", { class: "figures" }, this.choice, ...this.figures.map((figure) => figure.element));
    store.on("creature", () => this.list());
    store.on("document", () => this.refresh());
    store.on("frame", () => { if (!isDrawn(store) && shown(this.element)) this.refresh(); });
    this.list();
  }

  // `of` gives the number out of a foot's disk. Its default is what it was before it was drawn anew.
  makeFigure(label, of, write) {
    const read = (disks) => {
      if (!disks || this.foot >= disks.start.length) return null;
      return rounded(of({ start: disks.start[this.foot], extent: disks.extent[this.foot] }));
    };
    return new Figure({
      label, unit: "%", factor: 100, decimals: 1, write,
      read: () => read(disksOf(this.store)),
      standard: () => (isDrawn(this.store) ? read(this.editor.origin) : null),
    });
  }

  // A stance of another length keeps its touchdown, as gaits of the library do.
  putDuty(duty) {
    const disks = disksOf(this.store);
    this.editor.put(this.foot, "start", disks.start[this.foot] + disks.extent[this.foot] - 1 + duty);
  }

  list() {
    const feet = this.store.creature?.feet ?? [];
    if (this.foot >= feet.length) this.foot = 0;
    fillChoice(this.choice, feet.map(({ name }, k) => [String(k), name]), String(this.foot));
    this.choose(this.foot);
  }

  choose(k) {
    this.foot = k;
    this.choice.value = String(k);
    this.mark(k);
    this.refresh();
  }

  refresh() {
    for (const figure of this.figures) figure.refresh();
  }
}
