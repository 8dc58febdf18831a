// The chosen foot's disk in numbers: when it lifts and lands, and its duty.

import { disksOf, isDrawn, rounded } from "/page/disks.js";
import { Figure } from "/page/figure.js";
import { FootChoice } from "/page/foot_choice.js";
import { shown, whenShown } from "/page/switches.js";

export class FootNumbers extends FootChoice {
  constructor(store, editor, mark) {
    super(store, mark);
    this.editor = editor;
    this.show([
      this.makeFigure("Lifts at", ({ start }) => start, (phase) => editor.put(this.foot, "start", phase)),
      this.makeFigure("Lands at", ({ start, extent }) => start + extent, (phase) => editor.put(this.foot, "finish", phase)),
      this.makeFigure("Stands for", ({ extent }) => 1 - extent, (duty) => this.putDuty(duty)),
    ]);
    const follow = () => { if (!isDrawn(store) && shown(this.element)) this.refresh(); };
    store.on("frame", follow);
    whenShown(follow);
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
}
