// A rig's joints from above and from its left side. The nearest joint to the pointer is meant, so
// that small ones can be hit; the tree does the same for the keyboard.

import { make, makeSvg } from "/page/elements.js";
import { axes } from "/page/rig_draft.js";

const WIDTH = 168;
const HEIGHT = 190;
const MARGIN = 14;
const NEAR = 24; // px: farther from all joints nothing is meant

export class JointPicture {
  constructor({ pick, point }) {
    this.views = [
      // Ahead is up from above, and to the left from its left side, as such pictures usually are.
      new View("From above", ({ ahead, left }) => (p) => [-left(p), -ahead(p)], pick, point),
      new View("From its left", ({ ahead, up }) => (p) => [-ahead(p), -up(p)], pick, point),
    ];
    this.element = make("div", { class: "pictures" }, ...this.views.map(({ figure }) => figure));
  }

  // `style.joint` gives for a node {colour, size, dim}, `style.bone` for the bone to its parent
  // {colour, width}.
  draw(draft, style) {
    for (const view of this.views) view.draw(draft, style);
  }

  highlight(node) {
    for (const view of this.views) view.encircle(view.ring, node);
  }

  // Show which joint is chosen, null: none is.
  select(node) {
    for (const view of this.views) view.select(node);
  }
}

class View {
  constructor(title, projection, pick, point) {
    Object.assign(this, { projection, pick, point });
    this.places = new Map();
    this.ring = makeSvg("circle", { class: "joint-ring", r: 7, visibility: "hidden" });
    this.chosen = makeSvg("circle", { class: "joint-chosen", r: 5.5, visibility: "hidden" });
    this.bones = makeSvg("g", {});
    this.svg = makeSvg(
      "svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "joints", role: "img", "aria-label": `Joints ${title.toLowerCase()}` },
      this.bones, this.chosen, this.ring,
    );
    this.figure = make("figure", {}, this.svg, make("figcaption", { class: "quiet" }, title));
    this.svg.addEventListener("pointermove", (event) => this.point(this.nearest(event)));
    this.svg.addEventListener("pointerleave", () => this.point(null));
    this.svg.addEventListener("click", (event) => {
      const node = this.nearest(event);
      if (node !== null) this.pick(node);
    });
  }

  draw(draft, style) {
    this.lay(draft);
    const lines = [];
    const dots = [];
    for (const { node, parent } of draft.joints) {
      const [x, y] = this.places.get(node);
      const { colour, size, dim } = style.joint(node);
      const opacity = dim ? 0.25 : 1;
      if (this.places.has(parent)) {
        const [x2, y2] = this.places.get(parent);
        const bone = style.bone(node);
        lines.push(makeSvg("line", { x1: x, y1: y, x2, y2, stroke: bone.colour, "stroke-width": bone.width, opacity }));
      }
      dots.push(makeSvg("circle", { cx: x, cy: y, r: size, fill: colour, opacity }));
    }
    this.bones.replaceChildren(...lines, ...dots);
    this.select(this.selected);
  }

  // Where joints are in the picture: the whole rig fits, to one scale both ways.
  lay(draft) {
    const project = this.projection(axes(draft.forward));
    const flat = draft.joints.map(({ place }) => project(place));
    const [xs, ys] = [0, 1].map((axis) => flat.map((point) => point[axis]));
    const [left, right, top, bottom] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const scale = Math.min(
      (WIDTH - 2 * MARGIN) / Math.max(right - left, 1e-9),
      (HEIGHT - 2 * MARGIN) / Math.max(bottom - top, 1e-9),
    );
    const shown = (point) => [
      WIDTH / 2 + scale * (point[0] - (left + right) / 2),
      HEIGHT / 2 + scale * (point[1] - (top + bottom) / 2),
    ];
    this.places = new Map(draft.joints.map(({ node }, i) => [node, shown(flat[i])]));
  }

  nearest(event) {
    const box = this.svg.getBoundingClientRect();
    const x = ((event.clientX - box.left) * WIDTH) / box.width;
    const y = ((event.clientY - box.top) * HEIGHT) / box.height;
    let [best, distance] = [null, NEAR];
    for (const [node, [ox, oy]] of this.places) {
      const off = Math.hypot(x - ox, y - oy);
      if (off < distance) [best, distance] = [node, off];
    }
    return best;
  }

  select(node) {
    this.selected = node;
    this.encircle(this.chosen, node);
  }

  encircle(ring, node) {
    const place = this.places.get(node);
    ring.setAttribute("visibility", place ? "visible" : "hidden");
    if (!place) return;
    ring.setAttribute("cx", place[0]);
    ring.setAttribute("cy", place[1]);
  }
}
