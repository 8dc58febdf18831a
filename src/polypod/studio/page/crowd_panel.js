// Creatures beside the first: kinds and how many of each.

import { fillChoice, make, makeButton, makeChoice } from "/page/elements.js";
import { NumberBox } from "/page/number_box.js";
import { nameOfRig } from "/page/rig_draft.js";

const MOST = 200; // creatures, the first one among them

export class CrowdPanel {
  constructor(store) {
    this.store = store;
    this.list = make("ul", { class: "list", "aria-label": "Creatures beside it" });
    this.words = make("p", { class: "quiet" });
    this.add = makeButton("Add a kind", () => this.grow());
    this.element = make("div", {}, this.list, make("div", { class: "row" }, this.add), this.words);
    this.rows = [];
  }

  // How many more there may be.
  room() {
    return MOST - 1 - this.store.wanted.crowd.reduce((sum, { count }) => sum + count, 0);
  }

  grow() {
    const { crowd, creature } = this.store.wanted;
    const kind = { ...this.asRead(creature.rig), count: Math.min(10, this.room()) };
    this.store.edit(["crowd"], [...crowd, kind]);
  }

  // A rig as it walks here already: its size, front, legs, spine and limits are those.
  asRead(rig) {
    const { creature, crowd } = this.store.wanted;
    const here = [creature, ...crowd].find((one) => one.rig === rig) ?? { rig };
    const { count, ...kind } = here;
    return Object.fromEntries(Object.entries(kind).filter(([, value]) => value !== null));
  }

  count(i, count) {
    const { crowd } = this.store.wanted;
    return this.store.edit(["crowd"], crowd.with(i, { ...crowd[i], count }));
  }

  // Kinds to choose from: built-in ones, and the rigs that are here already.
  kinds() {
    const { creature, crowd } = this.store.wanted;
    const own = [creature.rig, ...crowd.map(({ rig }) => rig)];
    return [...new Set([...this.store.welcome.rigs, ...own])].map((rig) => [rig, nameOfRig(rig)]);
  }

  refresh() {
    const { crowd } = this.store.wanted;
    if (this.rows.length !== crowd.length) this.build(crowd.length);
    this.rows.forEach(({ choice, box }, i) => {
      fillChoice(choice, this.kinds(), crowd[i].rig);
      box.refresh();
    });
    const room = this.room();
    this.add.disabled = room < 1;
    this.words.textContent = crowd.length
      ? `${MOST - room} creatures in all; ${MOST} at most.`
      : `It walks alone. Up to ${MOST} may walk here.`;
  }

  build(count) {
    this.rows = Array.from({ length: count }, (_, i) => this.row(i));
    this.list.replaceChildren(...this.rows.map(({ element }) => element));
  }

  row(i) {
    const choice = makeChoice(`Kind ${i + 1}`, async (rig) => {
      const { crowd } = this.store.wanted;
      await this.store.edit(["crowd"], crowd.with(i, { ...this.asRead(rig), count: crowd[i].count }));
      this.refresh();
    });
    const box = new NumberBox({
      label: `How many of kind ${i + 1}`, decimals: 0, step: 1,
      read: () => this.store.wanted.crowd[i]?.count ?? null,
      write: (count) => this.count(i, Math.round(count)),
    });
    const remove = makeButton("✕", () => {
      this.store.edit(["crowd"], this.store.wanted.crowd.toSpliced(i, 1));
    }, { "aria-label": `Delete kind ${i + 1}` });
    return { choice, box, element: make("li", {}, choice, box.element, remove) };
  }
}
