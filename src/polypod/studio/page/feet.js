// The Feet panel: where feet prefer to stand, seen from above.

import { addStyle, button, html, kept } from "/page/svg.js";
import { NumberField } from "/page/number_field.js";
import { SpacingEditor } from "/page/spacing_edit.js";
import { SpacingView } from "/page/spacing_view.js";
import { shiftOf } from "/page/spacing.js";

export function mountFeet(element, store) {
  addStyle("gait.css");
  addStyle("feet.css");
  const symmetric = kept("Symmetric", "polypod.feet.symmetric", true, () => {}, { title: "The foot on the other side goes along, mirrored" });
  const editor = new SpacingEditor(store, { get symmetric() { return symmetric.on; } });
  const view = new SpacingView(store, editor, (k) => foot.choose(k));
  const foot = new FootPlace(store, editor, (k) => view.mark(k));
  element.append(
    html("div", { class: "row" }, symmetric.element,
      button("Reset this foot", () => foot.reset()), button("Reset all", () => editor.resetAll())),
    view.element,
    makeLegend(),
    foot.element,
    makeWidth(store),
  );
}

function makeLegend() {
  const item = (kind, words) => html("span", {}, html("span", { class: `legend-${kind}` }), words);
  return html("div", { class: "wheel-legend quiet", "aria-hidden": "true" },
    item("place", "preferred place: drag it"), item("sole", "foot now"), item("target", "target ×"),
    item("wish", "preferred on the way"), item("rest", "rest +"));
}

function makeWidth(store) {
  const width = new NumberField({
    label: "Stance width", unit: "", slide: true,
    commit: (value, gesture) => store.edit(["command", "stance_width"], value, gesture),
  });
  store.on("creature", () => width.bound(store.creature.ranges.stance_width));
  store.on("document", () => width.show(store.document.command.stance_width));
  return width.element;
}

// The chosen foot's shift in numbers.
class FootPlace {
  constructor(store, editor, mark) {
    this.store = store;
    this.editor = editor;
    this.mark = mark;
    this.foot = 0;
    this.choice = html("select", { id: "spacing-foot" });
    this.choice.addEventListener("change", () => this.choose(Number(this.choice.value)));
    const make = (label, axis) => new NumberField({
      label, unit: "m", digits: 4, fallback: 0, commit: async (value) => this.put(axis, value),
    });
    this.axes = [make("Left of rest", 0), make("Forward of rest", 1)];
    this.element = html("div", { class: "foot-numbers" },
      html("div", { class: "row" }, html("label", { for: "spacing-foot" }, "Foot"), this.choice),
      ...this.axes.map((axis) => axis.element));
    store.on("creature", () => this.list());
    store.on("document", () => this.show());
    this.list();
  }

  put(axis, value) {
    const shift = [...shiftOf(this.store, this.foot)];
    shift[axis] = value;
    this.editor.put(this.foot, shift);
  }

  reset() {
    this.editor.put(this.foot, [0, 0]);
  }

  list() {
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
    const shift = shiftOf(this.store, this.foot);
    this.axes.forEach((axis, n) => axis.show(shift[n]));
  }
}
