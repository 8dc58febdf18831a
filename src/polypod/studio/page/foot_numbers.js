// The chosen foot's disk in numbers: when it lifts and lands, and its duty.

import { disksOf, isDrawn, rounded } from "/page/disks.js";
import { NumberField } from "/page/number_field.js";
import { html } from "/page/svg.js";

export class FootNumbers {
  constructor(store, editor, mark) {
    this.store = store;
    this.editor = editor;
    this.mark = mark;
    this.foot = 0;
    this.choice = html("select", { id: "gait-foot" });
    this.choice.addEventListener("change", () => this.choose(Number(this.choice.value)));
    const make = (label, commit) => new NumberField({
      label, unit: "%", scale: 100, digits: 1, range: { least: 0, most: 1 },
      commit: async (value) => commit(value),
    });
    this.lifts = make("Lifts at", (phase) => editor.put(this.foot, "start", phase));
    this.lands = make("Lands at", (phase) => editor.put(this.foot, "finish", phase));
    this.duty = make("Stands", (duty) => this.putDuty(duty));
    this.element = html("div", { class: "foot-numbers" },
      html("div", { class: "row" }, html("label", { for: "gait-foot" }, "Foot"), this.choice),
      this.lifts.element, this.lands.element, this.duty.element);
    store.on("creature", () => this.list());
    store.on("document", () => this.show());
    store.on("frame", () => { if (!isDrawn(store)) this.show(); });
    this.list();
  }

  // A stance of another length keeps its touchdown, as gaits of the library do.
  putDuty(duty) {
    const disks = disksOf(this.store);
    if (disks) this.editor.put(this.foot, "start", disks.start[this.foot] + disks.extent[this.foot] - 1 + duty);
  }

  list() {
    this.editor.origin = null;
    const feet = this.store.creature?.feet ?? [];
    this.choice.replaceChildren(...feet.map(({ name }, k) => html("option", { value: k }, name)));
    this.choose(this.foot < feet.length ? this.foot : 0);
  }

  choose(k) {
    this.foot = k;
    this.choice.value = String(k);
    this.mark(k);
    this.show();
  }

  show() {
    const disks = disksOf(this.store);
    if (!disks || this.foot >= disks.start.length) return;
    const now = this.figures(disks);
    const before = this.editor.origin ? this.figures(this.editor.origin) : now;
    this.lifts.show(now.lifts, before.lifts);
    this.lands.show(now.lands, before.lands);
    this.duty.show(now.duty, before.duty);
  }

  figures({ start, extent }) {
    const k = this.foot;
    return { lifts: rounded(start[k]), lands: rounded(start[k] + extent[k]), duty: 1 - extent[k] };
  }
}
