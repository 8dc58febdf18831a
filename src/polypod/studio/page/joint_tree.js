// The joints of a rig as a tree, each with what it is: hip, foot, spine. Arrow keys move along it,
// Enter picks.

import { make } from "/page/elements.js";

export class JointTree {
  // `pick` hears the node that was chosen, `point` the one that is pointed at or null.
  constructor({ pick, point }) {
    Object.assign(this, { pick, point });
    this.element = make("ul", { role: "tree", class: "tree", "aria-label": "Joints" });
    this.items = new Map();
    this.element.addEventListener("keydown", (event) => this.key(event));
    this.element.addEventListener("focusin", (event) => this.pointAt(event.target));
    this.element.addEventListener("pointerover", (event) => this.pointAt(event.target.closest("li")));
    this.element.addEventListener("pointerleave", () => this.point(null));
    this.element.addEventListener("click", (event) => {
      const item = event.target.closest("li");
      if (item) this.choose(item);
    });
  }

  pointAt(item) {
    if (item?.dataset.node) this.point(Number(item.dataset.node));
  }

  // Build it for other joints.
  build(joints) {
    this.children = new Map();
    for (const joint of joints) {
      if (!this.children.has(joint.parent)) this.children.set(joint.parent, []);
      this.children.get(joint.parent).push(joint);
    }
    this.items = new Map();
    const known = new Set(joints.map(({ node }) => node));
    const rows = [];
    const add = (joint, level, parent) => {
      const item = make(
        "li",
        {
          role: "treeitem", tabindex: rows.length ? -1 : 0, "aria-level": level,
          "data-node": joint.node, title: joint.name,
        },
        make("span", { class: "joint-name" }, joint.name || `#${joint.node}`),
        make("span", { class: "badge" }),
      );
      item.style.paddingLeft = `${6 + 9 * Math.min(level - 1, 16)}px`;
      rows.push(item);
      this.items.set(joint.node, { item, parent });
      for (const child of this.children.get(joint.node) ?? []) add(child, level + 1, joint.node);
    };
    for (const joint of joints) if (!known.has(joint.parent)) add(joint, 1, null);
    this.rows = rows;
    this.element.replaceChildren(...rows);
  }

  // Say what joints are: `marks` is a Map of node to {words, colour}, `dim` tells whether one
  // cannot be picked now.
  mark(marks, dim) {
    for (const [node, { item }] of this.items) {
      const mark = marks.get(node);
      const badge = item.lastChild;
      badge.textContent = mark?.words ?? "";
      // As a dot: feet's colours are too dark to read words in.
      badge.style.setProperty("--mark", mark?.colour ?? "transparent");
      item.setAttribute("aria-disabled", String(dim(node)));
    }
  }

  // Show which joint is chosen, null: none is.
  select(node) {
    for (const [other, { item }] of this.items) item.setAttribute("aria-selected", String(other === node));
  }

  // Show the joint that is pointed at elsewhere.
  highlight(node) {
    for (const [other, { item }] of this.items) item.classList.toggle("pointed", other === node);
  }

  key(event) {
    const at = this.rows.indexOf(event.target);
    if (at < 0 || event.ctrlKey || event.metaKey || event.altKey) return;
    const node = Number(event.target.dataset.node);
    const parent = this.items.get(node).parent;
    const child = this.children.get(node)?.[0];
    const moves = {
      ArrowDown: this.rows[at + 1],
      ArrowUp: this.rows[at - 1],
      ArrowLeft: parent === null ? undefined : this.items.get(parent).item,
      ArrowRight: child && this.items.get(child.node).item,
      Home: this.rows[0],
      End: this.rows.at(-1),
    };
    if (event.key in moves) this.focus(moves[event.key]);
    else if (event.key === "Enter" || event.key === " ") this.choose(event.target);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  focus(item) {
    if (!item) return;
    for (const row of this.rows) row.tabIndex = row === item ? 0 : -1;
    item.focus();
  }

  choose(item) {
    this.focus(item);
    this.pick(Number(item.dataset.node));
  }
}
