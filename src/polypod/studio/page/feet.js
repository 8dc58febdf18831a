// The Feet panel: where feet prefer to stand, seen from above.

import { addStyle, make, makeButton, makeSection } from "/page/elements.js";
import { Figure } from "/page/figure.js";
import { FootChoice } from "/page/foot_choice.js";
import { documentSlider } from "/page/slider.js";
import { shiftOf } from "/page/spacing.js";
import { SpacingEditor } from "/page/spacing_edit.js";
import { SpacingView } from "/page/spacing_view.js";
import { Switch } from "/page/switches.js";

export function mountFeet(element, store) {
  addStyle("panels.css");
  addStyle("gait.css");
  addStyle("feet.css");
  const symmetric = new Switch("Symmetric", "polypod.feet.symmetric", true, () => {}, {
    title: "The foot on the other side goes along, mirrored",
  });
  const editor = new SpacingEditor(store, symmetric);
  const view = new SpacingView(store, editor, (k) => foot.choose(k));
  const foot = new FootPlace(store, editor, (k) => view.mark(k));
  element.append(
    make("div", { class: "row" }, symmetric.element,
      makeButton("Reset this foot", () => foot.reset()), makeButton("Reset all", () => editor.resetAll())),
    view.element,
    makeLegend(),
    makeSection("One foot", foot.element),
    makeSection("All feet", makeWidth(store)),
  );
}

function makeLegend() {
  const item = (kind, words) => make("span", {}, make("span", { class: `legend-${kind}` }), words);
  return make("div", { class: "wheel-legend quiet", "aria-hidden": "true" },
    item("place", "preferred place: drag it"), make("span", {}, "+ rest"),
    item("sole", "foot now"), make("span", {}, "× target"), item("wish", "preferred in this stride"));
}

function makeWidth(store) {
  const width = documentSlider(store, {
    label: "Stance width", at: ["command", "stance_width"], range: () => store.creature.ranges.stance_width,
  });
  const refresh = () => { if (store.document && store.creature) width.refresh(); };
  store.on("creature", refresh);
  store.on("document", refresh);
  return width.element;
}

// The chosen foot's shift in numbers.
class FootPlace extends FootChoice {
  constructor(store, editor, mark) {
    super(store, mark);
    this.editor = editor;
    this.show(["Left of rest", "Ahead of rest"].map((label, axis) => new Figure({
      label, unit: "m", decimals: 4, standard: () => 0,
      read: () => shiftOf(store, this.foot)[axis],
      write: (value) => this.put(axis, value),
    })));
  }

  put(axis, value) {
    return this.editor.put(this.foot, shiftOf(this.store, this.foot).with(axis, value));
  }

  reset() {
    this.editor.put(this.foot, [0, 0]);
  }
}
