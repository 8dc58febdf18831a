// The creature from above, its front up: body, bones and feet as they are, and the places that feet
// prefer, to be dragged.

import { redraw } from "/page/canvas.js";
import { make, makeSvg } from "/page/elements.js";
import { jointPlace, placeOf, restOf, shiftOf, viewFrom } from "/page/spacing.js";
import { shown } from "/page/switches.js";

const WIDTH = 348;
const HEIGHT = 360;
const ROOM = 0.45; // leg lengths round the outermost rest place
const FRAMES_A_SECOND = 60;
const FINGER = 14; // px round a handle's middle

export class SpacingView {
  constructor(store, editor, chosen) {
    this.store = store;
    this.editor = editor;
    this.chosen = chosen; // called with the foot that is touched
    this.picture = makeSvg("svg", { viewBox: `${-WIDTH / 2} ${-HEIGHT / 2} ${WIDTH} ${HEIGHT}`, class: "spacing", role: "group", "aria-label": "Feet from above, front up" });
    this.element = make("div", {}, this.picture);
    this.feet = [];
    store.on("creature", () => this.build());
    store.on("document", () => this.showPlaces());
    store.on("frame", redraw(FRAMES_A_SECOND, () => this.showFrame()));
    this.build();
  }

  build() {
    const { creature } = this.store;
    const made = creature && JSON.stringify([creature.feet, creature.body]);
    if (!creature || made === this.made) return;
    this.made = made;
    this.fitScale(creature);
    this.bones = makeSvg("path", { class: "spacing-bones" });
    this.spine = makeSvg("path", { class: "spacing-spine" });
    this.hull = makeSvg("polygon", { class: "spacing-hull" });
    this.feet = creature.feet.map((foot, k) => this.makeFoot(foot, k));
    this.picture.replaceChildren(
      this.makeGrid(), this.makeBody(creature.body), this.hull, this.bones, this.spine,
      ...this.feet.map(({ rest }) => rest), ...this.feet.map(({ live }) => live),
      ...this.feet.map(({ handle }) => handle), ...this.makeWords());
    this.showPlaces();
    this.showFrame();
  }

  // One scale that holds as long as the creature does: nothing jumps while a foot is dragged.
  fitScale({ feet, leg_length: leg, body }) {
    const reach = (axis) => Math.max(...feet.map(({ rest }) => Math.abs(rest[axis]))) + ROOM * leg;
    const long = body.half_size[2] + Math.abs(body.centre[2]);
    this.scale = Math.min(WIDTH / 2 / reach(0), HEIGHT / 2 / Math.max(reach(1), long));
  }

  // [x, y] on the picture of [left, forward] m.
  at([left, forward]) {
    return [-left * this.scale, -forward * this.scale];
  }

  move(shape, place) {
    const [x, y] = this.at(place);
    shape.setAttribute("transform", `translate(${x.toFixed(1)} ${y.toFixed(1)})`);
  }

  makeGrid() {
    const grid = makeSvg("g", { class: "spacing-grid" });
    const step = this.gridMetres() * this.scale;
    for (let x = -Math.floor(WIDTH / 2 / step); x * step < WIDTH / 2; x++) {
      grid.append(makeSvg("path", { d: `M${x * step} ${-HEIGHT / 2}V${HEIGHT / 2}` }));
    }
    for (let y = -Math.floor(HEIGHT / 2 / step); y * step < HEIGHT / 2; y++) {
      grid.append(makeSvg("path", { d: `M${-WIDTH / 2} ${y * step}H${WIDTH / 2}` }));
    }
    return grid;
  }

  // Between two lines: a round distance, some of them to a leg.
  gridMetres() {
    return 10 ** Math.round(Math.log10(this.store.creature.leg_length / 3));
  }

  makeBody({ half_size: half, centre }) {
    const [x, y] = this.at([centre[0], centre[2]]);
    const [width, height] = [half[0] * this.scale, half[2] * this.scale];
    const nose = `M${x - width * 0.5} ${y - height}L${x} ${y - height - Math.min(width, 14)}L${x + width * 0.5} ${y - height}Z`;
    return makeSvg("g", { class: "spacing-body" },
      makeSvg("rect", { x: x - width, y: y - height, width: 2 * width, height: 2 * height, rx: Math.min(width, height) * 0.4 }),
      makeSvg("path", { d: nose }));
  }

  makeWords() {
    const words = (x, y, text) => makeSvg("text", { class: "spacing-words", x, y }, text);
    return [words(0, -HEIGHT / 2 + 13, "front"), words(-WIDTH / 2 + 16, 0, "left"), words(WIDTH / 2 - 18, 0, "right"),
      words(0, HEIGHT / 2 - 6, `a square is ${Number(this.gridMetres().toPrecision(1))} m`)];
  }

  makeFoot(foot, k) {
    const rest = makeSvg("path", { class: "spacing-rest", d: "M-5 0H5M0 -5V5" });
    const tie = makeSvg("line", { class: "spacing-tie", stroke: foot.colour });
    const preferred = makeSvg("circle", { class: "spacing-preferred", r: 5, stroke: foot.colour });
    const target = makeSvg("path", { class: "spacing-target", d: "M-4 -4L4 4M-4 4L4 -4", stroke: foot.colour });
    const sole = makeSvg("circle", { class: "spacing-sole", r: 4, fill: foot.colour });
    const handle = makeSvg("g", {
      class: "spacing-foot", tabindex: 0, role: "button", "aria-roledescription": "movable place",
      "data-foot": k,
    },
    makeSvg("circle", { class: "spacing-touch", r: FINGER }),
    makeSvg("circle", { class: "spacing-knob", r: 8.5, stroke: foot.colour, fill: foot.colour }));
    this.editor.bindKeys(handle, k);
    this.editor.bindPointer(handle, k, (event) => this.pointerPlace(event));
    handle.addEventListener("focus", () => this.chosen(k));
    return { foot, rest, tie, preferred, target, sole, handle, live: makeSvg("g", {}, tie, preferred, target, sole) };
  }

  pointerPlace(event) {
    const box = this.picture.getBoundingClientRect();
    const zoom = Math.min(box.width / WIDTH, box.height / HEIGHT);
    const x = (event.clientX - box.left - box.width / 2) / zoom;
    const y = (event.clientY - box.top - box.height / 2) / zoom;
    return [-x / this.scale, -y / this.scale];
  }

  mark(k) {
    this.feet.forEach(({ handle }, foot) => handle.classList.toggle("chosen", foot === k));
  }

  // The places asked for.
  showPlaces() {
    this.feet.forEach(({ foot, rest, handle }, k) => {
      this.move(rest, restOf(this.store, k));
      this.move(handle, placeOf(this.store, k));
      const [left, forward] = shiftOf(this.store, k);
      const aside = `${Math.abs(left).toFixed(3)} m ${left < 0 ? "right" : "left"}`;
      const ahead = `${Math.abs(forward).toFixed(3)} m ${forward < 0 ? "back" : "forward"}`;
      handle.setAttribute("aria-label", `${foot.name} place: ${aside} and ${ahead} of rest; arrow keys move it, Delete resets it`);
    });
  }

  // Where feet are, go to, and would like to land.
  showFrame() {
    const { frame, creature } = this.store;
    if (!frame || frame.focus.feet.length !== this.feet.length || !shown(this.picture)) return;
    const view = viewFrom(frame);
    const standing = [];
    frame.focus.feet.forEach(({ sole, target, preferred, stance }, k) => {
      const foot = this.feet[k];
      const place = view(sole[0], sole[2]);
      this.move(foot.sole, place);
      this.move(foot.target, view(target[0], target[2]));
      this.move(foot.preferred, view(preferred[0], preferred[2]));
      this.tie(foot.tie, place, placeOf(this.store, k));
      foot.live.classList.toggle("swings", !stance);
      if (stance) standing.push(this.at(place));
    });
    this.hull.setAttribute("points", outline(standing).map((point) => point.map((n) => n.toFixed(1)).join(",")).join(" "));
    this.showBones(frame, creature, view);
  }

  tie(line, from, to) {
    const [x1, y1] = this.at(from);
    const [x2, y2] = this.at(to);
    for (const [name, value] of Object.entries({ x1, y1, x2, y2 })) line.setAttribute(name, value.toFixed(1));
  }

  showBones(frame, { bones, rest, spine }, view) {
    const place = (j) => {
      const [x, z] = jointPlace(frame, rest[j], j);
      return this.at(view(x, z)).map((n) => n.toFixed(1)).join(" ");
    };
    this.bones.setAttribute("d", bones.map(([i, j]) => `M${place(i)}L${place(j)}`).join(""));
    this.spine.setAttribute("d", spine.length > 1 ? `M${spine.map(place).join("L")}` : "");
  }
}

// The convex outline of points, for what the feet hold up.
function outline(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (ordered) => {
    const hull = [];
    for (const point of ordered) {
      while (hull.length > 1 && turn(hull.at(-2), hull.at(-1), point) <= 0) hull.pop();
      hull.push(point);
    }
    return hull.slice(0, -1);
  };
  return sorted.length < 3 ? sorted : [...half(sorted), ...half(sorted.reverse())];
}

function turn(a, b, c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}
