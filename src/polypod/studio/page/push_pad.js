// Pushes at the press of a button: from which side, how hard, and where on the body.

import { make, makeButton } from "/page/elements.js";
import { Slider } from "/page/slider.js";

const GRAVITY = 9.81; // m/s2
const HARDEST = 1.5; // of sqrt(g x hip height): what is harder is cut to it
const USUAL = 0.4; // of that
// Where a push throws the body, rad from its heading.
const WAYS = [["Left", Math.PI / 2], ["Ahead", 0], ["Back", Math.PI], ["Right", -Math.PI / 2]];

export class PushPad {
  constructor(store) {
    this.store = store;
    this.strength = null; // m/s; null: what is usual for its size
    this.place = 0; // m ahead of the body's centre
    this.strengthSlider = new Slider({
      label: "Strength",
      range: () => this.strengths(),
      read: () => this.strength,
      write: (value) => { this.strength = value; this.refresh(); },
    });
    this.placeSlider = new Slider({
      label: "Where",
      range: () => this.places(),
      read: () => this.place,
      write: (value) => { this.place = value; this.refresh(); },
    });
    const buttons = WAYS.map(([name, angle]) =>
      makeButton(name, () => this.push(angle), { "aria-label": `Push it ${name.toLowerCase()}` }));
    this.element = make(
      "div", {}, make("div", { class: "row", role: "group", "aria-label": "Push" }, ...buttons),
      this.strengthSlider.element, this.placeSlider.element,
      make("p", { class: "quiet" }, "Or drag on its body in the scene."),
    );
  }

  strengths() {
    const most = HARDEST * Math.sqrt(GRAVITY * this.store.creature.hip_height);
    return { least: 0, most, default: USUAL * most, unit: "m/s", step: most / 100 };
  }

  // From the trunk's back to its front; ahead of the centre is positive.
  places() {
    const half = this.store.creature.body.half_size[2];
    return { least: -half, most: half, default: 0, unit: "m", step: half / 50 };
  }

  push(angle) {
    const strength = this.strength ?? this.strengths().default;
    const focus = this.store.frame?.focus;
    const heading = (focus?.heading ?? 0) + angle;
    const velocity = [strength * Math.sin(heading), 0, strength * Math.cos(heading)];
    this.store
      .send({ do: "push", creature: focus?.creature ?? 0, velocity, at: this.place })
      .catch((refusal) => this.store.say(refusal.message));
  }

  // Another creature has other strengths and places.
  forget() {
    this.strength = null;
    this.place = 0;
    this.refresh();
  }

  refresh() {
    if (!this.store.creature) return;
    this.strengthSlider.refresh();
    this.placeSlider.refresh();
  }
}
