// The path that the creature walks: its points as numbers, or drawn in the scene.

import { make, makeButton } from "/page/elements.js";
import { Gesture } from "/page/gesture.js";
import { NumberBox } from "/page/number_box.js";

const SHOWN = 60; // points; a drawn path may have more, and nobody types those

export class WayPanel {
  constructor(store, scene) {
    Object.assign(this, { store, scene });
    this.gesture = new Gesture(store);
    this.draw = makeButton("Draw in the scene", () => this.setDrawing(scene.mode !== "path"));
    this.clear = makeButton("Clear", () => store.edit(["path"], []));
    this.words = make("p", { class: "quiet" });
    this.list = make("ol", { class: "list", "aria-label": "Points of the path" });
    this.element = make(
      "div", {},
      make(
        "div", { class: "row" }, this.draw,
        makeButton("Add a point", () => this.add()), this.clear,
      ),
      this.words, this.list,
    );
    this.boxes = [];
    scene.onMode(() => this.showMode());
    this.showMode();
  }

  setDrawing(on) {
    this.scene.mode = on ? "path" : "walk";
  }

  showMode() {
    this.draw.setAttribute("aria-pressed", String(this.scene.mode === "path"));
  }

  add() {
    const point = this.scene.placeAhead().map((number) => Number(number.toFixed(3)));
    this.change([...this.store.wanted.path, point]);
  }

  change(path) {
    this.gesture.begin();
    this.gesture.edit(["path"], path);
  }

  refresh() {
    const path = this.store.wanted.path;
    this.clear.disabled = path.length === 0;
    const more = path.length > SHOWN ? ` The first ${SHOWN} are listed.` : "";
    this.words.textContent = path.length
      ? `${path.length} point${path.length > 1 ? "s" : ""}, in metres.${more}`
      : "None: it walks in its heading. Click on the ground, or draw.";
    const shown = Math.min(path.length, SHOWN);
    if (this.list.children.length !== shown) this.build(shown);
    for (const box of this.boxes) box.refresh();
  }

  build(count) {
    this.boxes = [];
    this.list.replaceChildren(...Array.from({ length: count }, (_, i) => this.row(i)));
  }

  row(i) {
    const boxes = ["x", "z"].map((axis, a) => new NumberBox({
      label: `Point ${i + 1} ${axis}`, unit: "m", tag: axis, decimals: 2,
      read: () => this.store.wanted.path[i]?.[a] ?? null,
      write: (value) => {
        const path = this.store.wanted.path;
        this.change(path.with(i, path[i].with(a, value)));
      },
    }));
    this.boxes.push(...boxes);
    return make(
      "li", {}, make("span", { class: "form-label" }, `${i + 1}`),
      ...boxes.map((box) => box.element),
      makeButton("✕", () => this.change(this.store.wanted.path.toSpliced(i, 1)), {
        "aria-label": `Delete point ${i + 1}`,
      }),
    );
  }
}
