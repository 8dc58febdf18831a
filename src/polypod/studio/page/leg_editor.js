// Legs and spine of a rig: a list, corrected by clicking hips and feet in the tree or the picture.

import { make, makeButton } from "/page/elements.js";
import { foreToHind } from "/page/foot_order.js";

// Colours of legs beyond those of the creature that walks: each a good part of the circle on.
const GOLDEN = 137.508;

export class LegEditor {
  // `changed` is called when something else is asked of the rig, `picking` when another joint is
  // wanted or none any more.
  constructor(store, { changed, picking }) {
    Object.assign(this, { store, changed, picking });
    this.wanted = null; // {what: "hip" | "foot", leg, hip} or {what: "spine"}: what a click gives
    this.list = make("ul", { class: "list", "aria-label": "Legs" });
    this.spine = make("p", {});
    this.pickSpine = makeButton("Pick joints", () => this.want(this.wanted?.what === "spine" ? null : { what: "spine" }));
    this.hintWords = make("span", { role: "status" });
    this.hint = make(
      "div", { class: "hint", hidden: true },
      this.hintWords, makeButton("Stop", () => this.want(null), {
        "aria-label": "Stop picking", title: "Escape does the same",
      }),
    );
    this.legs = make(
      "div", {}, this.list,
      make(
        "div", { class: "row" },
        makeButton("Add a leg", () => this.want({ what: "hip", leg: this.draft.legs.length })),
        makeButton("As found", () => this.ask("leg", null), { "aria-label": "Legs as found in the file" }),
      ),
    );
    this.back = make(
      "div", {}, this.spine,
      make(
        "div", { class: "row" }, this.pickSpine,
        makeButton("None", () => this.ask("spine", []), { "aria-label": "No spine" }),
        makeButton("As found", () => this.ask("spine", null), { "aria-label": "Spine as found in the file" }),
      ),
    );
    window.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && this.wanted) this.want(null);
    });
  }

  // Show another rig, or the same one judged anew.
  show(draft) {
    if (draft !== this.draft) this.want(null, draft);
    this.draft = draft;
    const rows = foreToHind(draft.placedLegs()).map((i) => this.row(draft.legs[i], i));
    this.list.replaceChildren(...rows);
    const names = draft.spine.map((node) => draft.label(node));
    this.spine.textContent = names.length ? names.join(" → ") : "None: its trunk is one piece.";
  }

  row(leg, i) {
    const words = `${this.draft.label(leg.hip)} → ${this.draft.label(leg.foot)}`;
    const swatch = make("span", { class: "swatch" });
    swatch.style.background = this.colour(i);
    return make(
      "li", {}, swatch, make("span", { class: "grow", title: words }, words),
      makeButton("Change", () => this.want({ what: "hip", leg: i }), { "aria-label": `Change leg ${words}` }),
      makeButton("✕", () => this.ask("leg", this.plainLegs().toSpliced(i, 1)), { "aria-label": `Remove leg ${words}` }),
    );
  }

  // Each foot has one colour everywhere, so those of the creature that walks come first.
  colour(i) {
    return this.store.creature?.feet[i]?.colour ?? `hsl(${((i * GOLDEN) % 360).toFixed(0)} 65% 60%)`;
  }

  plainLegs() {
    return this.draft.legs.map(({ hip, foot }) => ({ hip, foot }));
  }

  ask(key, value) {
    this.draft.asked[key] = value;
    if (this.wanted?.what !== "spine") this.want(null);
    this.changed();
  }

  want(wanted, draft = this.draft) {
    this.wanted = wanted;
    this.hint.hidden = !wanted;
    this.hintWords.textContent = wanted ? hintFor(wanted, draft) : "";
    this.pickSpine.setAttribute("aria-pressed", String(wanted?.what === "spine"));
    this.picking();
  }

  // Whether a joint would be refused if it were clicked now.
  refuses(node) {
    return this.wanted?.what === "foot" && !this.draft.isBelow(node, this.wanted.hip);
  }

  // A joint was clicked.
  take(node) {
    const wanted = this.wanted;
    if (!wanted) return;
    if (wanted.what === "hip") {
      this.want({ what: "foot", leg: wanted.leg, hip: node });
    } else if (wanted.what === "foot") {
      this.takeFoot(node);
    } else {
      const spine = this.draft.spine;
      const next = spine.includes(node) ? spine.filter((other) => other !== node) : [...spine, node];
      this.ask("spine", this.draft.backToHead(next));
    }
  }

  takeFoot(node) {
    const { leg, hip } = this.wanted;
    if (this.refuses(node)) {
      this.store.say(`${this.draft.label(node)} is not below ${this.draft.label(hip)}; a foot hangs on its hip.`);
      return;
    }
    const legs = this.plainLegs();
    legs[leg] = { hip, foot: node };
    this.ask("leg", legs);
  }
}

function hintFor({ what, hip }, draft) {
  if (what === "hip") return "Click the hip: the first joint that the leg itself turns.";
  if (what === "foot") return `Now the foot, somewhere below ${draft.label(hip)}: where it meets the ground.`;
  return "Click joints of the trunk to put them in or take them out, then Stop.";
}
