// The numbers of one obstacle: name, place, size, turn, whether feet may step on it, how it moves.

import { THREE } from "three";
import { fillChoice, make, makeButton, makeChoice, makeTick } from "/page/elements.js";
import { Gesture } from "/page/gesture.js";
import { NumberBox } from "/page/number_box.js";
import { extentOf, resized, withSide } from "/page/obstacle_size.js";
import { obstacleStart } from "/page/obstacles.js";

const AXES = ["x", "y", "z"];
const METRES = { unit: "m", decimals: 3 };
const METRES_A_SECOND = { unit: "m/s", decimals: 2 };
const DEGREES = { unit: "°", factor: 180 / Math.PI, decimals: 1 };
const DEGREES_A_SECOND = { unit: "°/s", factor: 180 / Math.PI, decimals: 1 };
const MOTIONS = [["still", "stands still"], ["velocity", "goes straight on"], ["path", "goes along a path"]];

export class ObstacleForm {
  // `chosen` gives the obstacle's number, or -1.
  constructor(store, chosen) {
    Object.assign(this, { store, chosen });
    this.gesture = new Gesture(store);
    this.element = make("div", { class: "form", role: "group", "aria-label": "Obstacle" });
    this.boxes = [];
  }

  get obstacle() {
    return this.store.wanted.obstacle[this.chosen()];
  }

  // Change keys of it; null takes a key away.
  change(keys) {
    const next = { ...structuredClone(this.obstacle), ...keys };
    for (const [key, value] of Object.entries(next)) if (value === null) delete next[key];
    this.gesture.begin();
    this.gesture.edit(["obstacle", this.chosen()], next);
  }

  refresh() {
    const obstacle = this.obstacle;
    this.element.hidden = !obstacle;
    if (!obstacle) return;
    // Built anew where it has other rows, and else filled, so that the focus stays.
    const rows = [this.chosen(), obstacle.shape, motionOf(obstacle), obstacle.path?.length, obstacle.file];
    if (JSON.stringify(rows) !== this.rows) {
      this.rows = JSON.stringify(rows);
      this.build(obstacle);
    }
    for (const box of this.boxes) box.refresh();
    if (document.activeElement !== this.name) this.name.value = obstacle.name ?? "";
    this.forbidden.box.checked = obstacle.forbidden ?? false;
    fillChoice(this.motion, MOTIONS, motionOf(obstacle));
  }

  build(obstacle) {
    this.boxes = [];
    this.file = make("span", { class: "grow" }, this.store.files?.meshes[obstacle.file] ?? "");
    this.name = make("input", { type: "text", maxlength: 60, "aria-label": "Name" });
    this.name.addEventListener("change", () => this.change({ name: this.name.value.trim() || null }));
    this.forbidden = makeTick("forbidden to feet", (on) => this.change({ forbidden: on || null }));
    this.motion = makeChoice("How it moves", (kind) => this.setMotion(kind));
    const turned = this.number("Turn", { ...DEGREES, words: "free" }, (o) => (o.rotation ? null : o.yaw ?? 0), (yaw) => {
      if (yaw !== null) this.change({ yaw, rotation: null });
    });
    this.element.replaceChildren(
      row("Name", this.name),
      row("Place, m", ...this.three("Place", "position", METRES)),
      row("Size, m", ...AXES.map((axis, i) => this.side(axis, i))),
      ...obstacle.file ? [row("File", this.file)] : [],
      row("Turn", turned, this.forbidden.element),
      row("Motion", this.motion),
      ...this.motionRows(obstacle),
    );
  }

  number(label, unit, read, write) {
    const box = new NumberBox({ label, ...unit, read: () => read(this.obstacle ?? {}), write });
    this.boxes.push(box);
    return box.element;
  }

  // A box for one side of it; it grows about its middle, but upward from what it stands on.
  side(axis, i) {
    const read = (o) => (o.shape ? extentOf(o).size[i] : null);
    return this.number(`Size ${axis}`, { ...METRES, tag: axis }, read, (value) => {
      if (!(value > 0)) {
        this.store.say("A size is above 0 m.");
        this.refresh();
        return;
      }
      const { obstacle } = this;
      const was = extentOf(obstacle).size;
      const size = withSide(obstacle, was, i, value);
      const { quaternion, rotation } = obstacleStart(obstacle);
      const turn = new THREE.Quaternion(...(rotation ?? quaternion));
      const shift = [0, 0.5 * (size[1] - was[1]), 0];
      this.change(resized(obstacle, size, shift, (vector) => (
        new THREE.Vector3(...vector).applyQuaternion(turn).toArray()
      )));
    });
  }

  // Boxes for x, y and z of a key.
  three(label, key, unit) {
    return AXES.map((axis, i) =>
      this.number(`${label} ${axis}`, { ...unit, tag: axis }, (o) => o[key]?.[i], (value) =>
        this.change({ [key]: this.obstacle[key].with(i, value) })));
  }

  motionRows(obstacle) {
    const turning = row("Turning", this.number(
      "Turning", DEGREES_A_SECOND, (o) => o.turn_rate ?? 0,
      (rate) => this.change({ turn_rate: rate || null }),
    ));
    if (obstacle.velocity) {
      return [row("Speed, m/s", ...this.three("Velocity", "velocity", METRES_A_SECOND)), turning];
    }
    if (!obstacle.path) return [turning];
    const speed = this.number("Speed", METRES_A_SECOND, (o) => o.speed ?? 0, (value) => this.change({ speed: value }));
    return [
      row("Speed", speed),
      ...obstacle.path.map((_, i) => this.pathRow(i)),
      row("", makeButton("Add a place", () => {
        const path = this.obstacle.path;
        this.change({ path: [...path, path.at(-1).with(0, path.at(-1)[0] + this.reach())] });
      })),
      turning,
    ];
  }

  pathRow(i) {
    const boxes = AXES.map((axis, a) =>
      this.number(`Place ${i + 1} ${axis}`, { ...METRES, tag: axis }, (o) => o.path?.[i]?.[a], (value) => {
        const path = this.obstacle.path;
        this.change({ path: path.with(i, path[i].with(a, value)) });
      }));
    const remove = makeButton("✕", () => {
      const path = this.obstacle.path.toSpliced(i, 1);
      if (path.length) this.change({ path });
      else this.setMotion("still");
    }, { "aria-label": `Delete place ${i + 1}` });
    return row(`To ${i + 1}, m`, ...boxes, remove);
  }

  // A way worth watching for a creature of this size, m.
  reach() {
    return 2 * this.store.creature.leg_length;
  }

  setMotion(kind) {
    const speed = Number((this.store.creature.ranges.speed.default / 2).toPrecision(2));
    const [x, y, z] = this.obstacle.position;
    const still = { velocity: null, path: null, speed: null };
    if (kind === "velocity") this.change({ ...still, velocity: [0, 0, -speed] });
    else if (kind === "path") this.change({ ...still, path: [[x + this.reach(), y, z]], speed });
    else this.change({ ...still, turn_rate: null });
  }
}

function motionOf(obstacle) {
  if (obstacle.path) return "path";
  return obstacle.velocity ? "velocity" : "still";
}

function row(words, ...children) {
  return make("div", { class: "row form-row" }, make("span", { class: "form-label" }, words), ...children);
}
