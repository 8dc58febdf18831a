// Obstacles: a list to choose from, new ones where the view's middle is, and the numbers of the one
// that is chosen, here or in the scene.

import { make, makeButton } from "/page/elements.js";
import { ObstacleForm } from "/page/obstacle_form.js";

// Extents of new ones in leg lengths: a crate to step on.
const NEW = {
  box: [0.9, 0.25, 0.9],
  cylinder: [0.8, 0.25, 0.8],
  sphere: [0.5, 0.5, 0.5],
};
// A sphere is sunk so deep, a share of its height: rocks do not stand on a point.
const SUNK = { sphere: 0.4 };

export class ObstaclePanel {
  constructor(store, scene) {
    this.store = store;
    this.scene = scene;
    this.chosen = -1;
    const adders = Object.keys(NEW).map((shape) =>
      makeButton(`+ ${shape}`, () => this.add(shape), { "aria-label": `Add a ${shape}` }));
    this.clear = makeButton("Delete all", () => this.store.edit(["obstacle"], []));
    this.list = make("ul", { class: "list", "aria-label": "Obstacles" });
    this.list.addEventListener("keydown", (event) => {
      if (event.key === "Delete" && this.chosen >= 0) this.remove(this.chosen);
    });
    this.form = new ObstacleForm(store, () => this.chosen);
    this.element = make(
      "div", {}, make("div", { class: "row" }, ...adders, this.clear), this.list, this.form.element,
    );
    scene.onSelect((index) => { this.chosen = index ?? -1; this.refresh(); });
  }

  choose(index) {
    this.chosen = index;
    this.scene.select(index < 0 ? null : index);
    this.refresh();
  }

  async add(shape) {
    const leg = this.store.creature.leg_length;
    const size = NEW[shape].map((share) => rounded(share * leg, leg));
    await this.put({ shape, size, yaw: 0 }, null, shape);
  }

  // Have an obstacle stand at `place` [x, z], or ahead of the creature, under a name that is free.
  async put(obstacle, place, name) {
    const leg = this.store.creature.leg_length;
    const around = Math.hypot(obstacle.size[0], obstacle.size[2]) / 2;
    const [x, z] = (place ?? this.scene.placeAhead(around)).map((value) => rounded(value, leg));
    const up = this.scene.heightAt(x, z) + obstacle.size[1] * (0.5 - (SUNK[obstacle.shape] ?? 0));
    const position = [x, up, z];
    const number = this.store.wanted.obstacle.length;
    await this.store.edit(["obstacle", number], { name: this.freeName(name), ...obstacle, position });
    if (this.store.document.obstacle.length <= number) return;
    this.choose(number);
    this.scene.reveal(position);
  }

  freeName(shape) {
    const taken = new Set(this.store.wanted.obstacle.map((obstacle) => obstacle.name));
    let number = 1;
    while (taken.has(`${shape}-${number}`)) number += 1;
    return `${shape}-${number}`;
  }

  // A copy beside it, as far off as it is wide.
  async copy(index) {
    const made = structuredClone(this.store.wanted.obstacle[index]);
    const number = this.store.wanted.obstacle.length;
    made.position[0] += 1.2 * (made.size?.[0] ?? this.store.creature.leg_length);
    made.name = this.freeName(made.shape);
    await this.store.edit(["obstacle", number], made);
    if (this.store.document.obstacle.length > number) this.choose(number);
  }

  async remove(index) {
    const there = this.store.wanted.obstacle.length;
    await this.store.edit(["obstacle", index], null);
    if (this.store.document.obstacle.length < there) this.choose(-1);
  }

  refresh() {
    const obstacles = this.store.wanted.obstacle;
    if (this.chosen >= obstacles.length) this.chosen = -1;
    this.clear.disabled = obstacles.length === 0;
    this.fill(obstacles);
    this.form.refresh();
  }

  // The list is made anew only where it says something else, so that the focus stays.
  fill(obstacles) {
    const rows = obstacles.map((obstacle) => described(obstacle));
    const wanted = JSON.stringify(rows);
    if (wanted !== this.filled) {
      this.filled = wanted;
      this.list.replaceChildren(...rows.map((words, i) => this.row(words, i)));
    }
    [...this.list.children].forEach((row, i) => {
      row.firstChild.setAttribute("aria-pressed", String(i === this.chosen));
    });
  }

  row(words, i) {
    return make(
      "li", {},
      makeButton(words, () => this.choose(i === this.chosen ? -1 : i), { class: "grow" }),
      makeButton("Copy", () => this.copy(i), { "aria-label": `Copy ${words}` }),
      makeButton("✕", () => this.remove(i), { "aria-label": `Delete ${words}` }),
    );
  }
}

function described(obstacle) {
  const name = obstacle.name || obstacle.shape;
  const moving = obstacle.velocity || obstacle.path || obstacle.turn_rate;
  return [name, obstacle.forbidden && "forbidden", moving && "moving"].filter(Boolean).join(", ");
}

// A number of two digits of the creature's size, so that boxes show what is meant.
function rounded(value, size) {
  const step = 10 ** Math.floor(Math.log10(size) - 1);
  return Number((Math.round(value / step) * step).toPrecision(6));
}
