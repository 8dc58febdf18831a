// How far each joint of the creature that walks turns: chosen from the list, the tree or the picture,
// dragged or typed, mirrored, while it walks.

import { addStyle, fillChoice, make, makeButton, makeChoice } from "/page/elements.js";
import { Figure } from "/page/figure.js";
import { anglesOf } from "/page/joint_angles.js";
import { LimitDial } from "/page/limit_dial.js";
import { LimitEditor } from "/page/limit_edit.js";
import { shown, Switch, whenShown } from "/page/switches.js";

const LIVE = 80; // ms between two looks at how a joint is turned
const SPINE = "#d5dde5";
const DEGREES = { unit: "°", factor: 180 / Math.PI, decimals: 1 };
const UNKNOWN = "They are known of what walks; press Walk it first.";
const HINT = "Drag an end of the arc; it snaps, but not with Alt. Delete goes back to the default, the thin line.";

export class LimitPanel {
  // `chosen` hears the node of the joint that is chosen, or null.
  constructor(store, chosen) {
    addStyle("limits.css");
    Object.assign(this, { store, chosen, name: null, dials: [], figures: [] });
    this.mirror = new Switch("Mirror", "polypod.limits.mirror", true, () => this.mark(), {
      "aria-label": "Mirror limits left and right", title: "The same joint of the leg on the other side goes along",
    });
    this.editor = new LimitEditor(store, this.mirror);
    this.choice = makeChoice("Joint", (name) => this.choose(name));
    this.all = makeButton("Reset all", () => this.editor.reset(), { "aria-label": "All limits as found", title: "All joints as found in the rig's own file" });
    this.words = make("p", { class: "quiet", role: "status" });
    this.body = make("div", { class: "limit-dials" });
    this.numbers = make("div", { class: "figures" });
    this.element = make(
      "div", { class: "joint-limits" },
      make("div", { class: "row" }, this.choice, this.mirror.element, this.all),
      this.words, this.body, this.numbers, make("p", { class: "quiet" }, HINT),
    );
    for (const kind of ["limits", "document"]) store.on(kind, () => this.refresh());
    store.on("frame", (frame) => this.follow(frame));
    whenShown(() => { if (store.frame) this.follow(store.frame); });
  }

  // Show the creature that walks, if it is the one that is looked at.
  show(walking) {
    this.walking = walking && Boolean(this.store.creature);
    const joints = this.joints();
    for (const part of [this.choice, this.mirror.element]) part.disabled = !joints.length;
    if (!joints.some(({ name }) => name === this.name)) this.name = joints[0]?.name ?? null;
    fillChoice(this.choice, joints.map(({ name, kind }) => [name, `${name}, ${kind}`]), this.name ?? "");
    this.build();
  }

  joints() {
    return this.walking ? this.store.creature.limits : [];
  }

  get joint() {
    return this.joints().find(({ name }) => name === this.name) ?? null;
  }

  // Choose the joint of a node; false where it is none that turns.
  chooseNode(node) {
    const joint = this.joints().find((one) => one.node === node);
    if (joint) this.choose(joint.name);
    else if (this.walking) this.words.textContent = "That joint turns with another: it is of no leg, spine or tail.";
    return Boolean(joint);
  }

  choose(name) {
    this.name = name;
    this.build();
  }

  // Make the dials and boxes of the chosen joint, unless they are there.
  build() {
    const { joint } = this;
    this.choice.value = joint?.name ?? "";
    const built = joint && `${joint.node} ${joint.kind} ${joint.leg} ${this.store.creature.name}`;
    if (built !== this.built) {
      this.built = built;
      this.dials = joint ? joint.turns.map((turn) => this.makeDial(joint, turn)) : [];
      this.figures = joint ? joint.turns.flatMap((turn) => this.makeFigures(turn)) : [];
      this.body.replaceChildren(...this.dials.map(({ element }) => element));
      this.numbers.replaceChildren(...this.figures.map(({ element }) => element));
      this.body.classList.toggle("single", this.dials.length === 1);
    }
    this.refresh();
    this.mark();
  }

  makeDial(joint, turn) {
    const colour = this.store.creature.feet[joint.leg]?.colour ?? SPINE;
    return new LimitDial(this.editor, joint, turn, turn.key, colour);
  }

  makeFigures({ key }) {
    const turn = () => this.turn(key);
    const put = (range) => this.editor.put(this.joint, key, range);
    const figure = (label, end, write) => new Figure({
      ...DEGREES, label, write, standard: () => turn()?.default[end] ?? null,
      read: () => (turn() ? [turn().least, turn().most][end] : null),
    });
    if (key !== "bend") {
      return [figure(`${capital(key)} either way`, 1, (angle) => put([-angle, angle]))];
    }
    return [
      figure("Bends from", 0, (angle) => put([angle, turn().most])),
      figure("Bends to", 1, (angle) => put([turn().least, angle])),
    ];
  }

  turn(key) {
    return this.joint?.turns.find((one) => one.key === key);
  }

  // What the server said last.
  refresh() {
    const { joint } = this;
    this.dials.forEach((dial) => {
      const turn = this.turn(dial.turn.key);
      if (!turn) return;
      dial.joint = joint;
      dial.show(turn);
    });
    for (const figure of this.figures) figure.refresh();
    this.all.disabled = !joint || this.store.document?.creature.limit == null;
  }

  // Say which joints are being limited, here, in the tree and in the scene.
  mark() {
    const { joint } = this;
    const together = joint ? this.editor.together(joint) : [];
    const partner = together[1];
    if (!joint) this.words.textContent = UNKNOWN;
    else this.words.textContent = partner ? `${partner.name} goes along, mirrored.` : KINDS[joint.kind];
    this.chosen(joint ? joint.node : null);
    this.tellScene();
  }

  // The scene shows how far the joints turn while anybody sees this panel.
  tellScene(seen = this.seen) {
    this.seen = seen;
    const rows = this.joint && seen ? this.editor.together(this.joint).map(({ joint }) => joint) : [];
    this.store.tell("joint", rows);
  }

  follow(frame) {
    const now = performance.now();
    if (now - (this.last ?? 0) < LIVE || !this.joint || !shown(this.element)) return;
    this.last = now;
    const angles = anglesOf(frame, this.joint);
    this.dials.forEach((dial, i) => dial.showNow(angles ? angles[i] : null));
  }
}

const KINDS = {
  hip: "The first joint of its leg, about how it stands.",
  hinge: "A joint of a leg, about its bend at rest.",
  spine: "A joint of the spine, against the one behind it.",
  tail: "A joint of the tail, against the one nearer the trunk.",
};

function capital(word) {
  return word[0].toUpperCase() + word.slice(1);
}
