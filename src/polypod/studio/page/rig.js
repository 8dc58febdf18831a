// The Rig panel: bring a rig, see what was found in it, correct that, and let it walk.

import { addStyle, fillChoice, make, makeButton, makeChoice, makeSection, saveAs } from "/page/elements.js";
import { JointPicture } from "/page/joint_picture.js";
import { JointTree } from "/page/joint_tree.js";
import { LegEditor } from "/page/leg_editor.js";
import { RigDraft, forgetName, nameOfRig, rememberName, rigsRemembered } from "/page/rig_draft.js";
import { LimitPanel } from "/page/rig_limits.js";
import { RigSize } from "/page/rig_size.js";
import { RigUpload } from "/page/rig_upload.js";

const QUIET = "#a3b0bd";
const BONE = "#5b6774";
const SPINE = "#ffffff";
// What of a command has a default of each creature's own.
const OWN = ["speed", "step_height", "body_height", "period", "duty"];
const UNLIMITED = "Its joints turn as far as found again: it has other legs or another spine.";
const GIANT = 20; // m; nothing that walked was as tall
// What is found of most rigs that lie on their back or nose.
const ONE_LEGGED = " If it has more, add them under Legs. If it lies on its side in the pictures of"
  + " its joints, export it anew with y up (+Y Up in Blender's export).";

export function mountRig(element, store) {
  addStyle("panels.css");
  new RigPanel(element, store);
}

class RigPanel {
  constructor(element, store) {
    Object.assign(this, { element, store, draft: null, asking: 0 });
    const judge = () => this.judge();
    const joint = { pick: (node) => this.pick(node), point: (node) => this.point(node) };
    this.builtIn = makeChoice("Creature", (rig) => this.look(new RigDraft(rig)));
    this.upload = new RigUpload(store, (answer) => this.takeUpload(answer));
    this.verdict = make("p", { class: "verdict", role: "status" });
    this.shrink = makeButton("", () => this.size.takeUnit(this.unit), {
      class: "main", hidden: true,
    });
    this.guesses = make("ul", { class: "guesses" });
    this.walk = makeButton("Walk it", () => this.letWalk(), { class: "main" });
    this.save = makeButton("Save as creature file", () => this.saveCreature());
    this.tree = new JointTree(joint);
    this.picture = new JointPicture(joint);
    this.pointed = make("p", { class: "quiet pointed-name" });
    this.legs = new LegEditor(store, { changed: judge, picking: () => this.showPicking() });
    this.size = new RigSize(judge);
    this.limits = new LimitPanel(store, (node) => {
      this.tree.select(node);
      this.picture.select(node);
    });
    this.build();
    this.listen();
  }

  build() {
    this.element.append(
      make("div", { class: "row" }, this.builtIn, this.upload.element),
      make("p", { class: "quiet" }, "Or drop a GLB anywhere on the page."),
      this.verdict,
      make("div", { class: "row" }, this.shrink),
      make("div", { class: "row" }, this.walk, this.save),
      makeSection("Size and front", this.size.element),
      makeSection("Legs", this.legs.legs),
      this.legs.hint,
      makeSection("Joints", this.picture.element, this.pointed, this.tree.element),
      makeSection("Limits", this.limits.element),
      makeSection("Spine", this.legs.back),
      makeSection("What was guessed", this.guesses),
    );
  }

  listen() {
    // The creature that walks is looked at first when the panel is: judging a rig takes a moment.
    const shown = new IntersectionObserver((entries) => {
      const seen = entries.at(-1).isIntersecting;
      if (seen) this.follow();
      this.limits.tellScene(seen);
    });
    shown.observe(this.element);
    for (const kind of ["document", "creature", "welcome"]) {
      this.store.on(kind, () => { if (!this.element.hidden) this.follow(); });
    }
  }

  // Look at the creature of the document, when it is another than before; what is being corrected
  // here stays as long as the document's creature does.
  follow() {
    const { document: asked, welcome } = this.store;
    if (!asked || !welcome) return;
    const creature = JSON.stringify(asked.creature);
    if (creature !== this.followed) {
      this.followed = creature;
      if (!this.draft || !sameCreature(asked.creature, this.creatureOfDraft())) {
        const { rig, leg, spine, forward, height } = asked.creature;
        this.look(new RigDraft(rig, { leg, spine, forward, height }));
      }
    }
    this.show();
  }

  look(draft) {
    this.draft = draft;
    this.judge();
  }

  takeUpload(answer) {
    // The creature that walks is not what is looked at now, even if it has not been before.
    this.followed = JSON.stringify(this.store.document.creature);
    document.querySelector("#tab-rig").click();
    this.asking += 1; // what is still being judged is of another rig
    this.draft = new RigDraft(answer.rig);
    this.take(answer);
    this.store.tell("rig", answer.rig);
  }

  // Files in centimetres are common, and would be giants: offer to take them for what they are.
  offerUnit() {
    const tallest = this.draft.asked.height === null ? this.draft.fileHeight ?? 0 : 0;
    this.unit = tallest > GIANT * 100 ? 0.001 : 0.01;
    this.shrink.hidden = !(tallest > GIANT);
    this.walk.classList.toggle("main", this.shrink.hidden);
    const name = this.unit === 0.01 ? "centimetres" : "millimetres";
    this.shrink.textContent = `In ${name}? Make it ${tall(tallest * this.unit)} tall`;
  }

  // Ask the server what is to be thought of the rig as it is asked for now.
  async judge() {
    this.asking += 1;
    const asking = this.asking;
    this.show();
    this.verdict.textContent = "Looking at it…";
    this.verdict.className = "verdict";
    try {
      const answer = await this.store.fetch("/judge", {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify(this.draft.question()),
      });
      const found = await answer.json();
      // Only the answer to the last question counts.
      if (asking === this.asking) this.take(found);
    } catch (error) {
      if (asking !== this.asking) return;
      if (this.store.connected) forgetName(this.draft.rig); // one that the studio has no more
      this.fail(error.message);
    }
  }

  take(answer) {
    const others = answer.joints.length !== this.tree.rows?.length || answer.rig !== this.shownRig;
    rememberName(answer.rig, answer.name);
    this.draft.take(answer);
    if (others) this.tree.build(this.draft.joints);
    this.shownRig = answer.rig;
    this.show();
    if (!answer.walks) {
      this.fail(answer.why);
      return;
    }
    const legs = this.draft.legs.length;
    this.verdict.textContent = `It can walk: ${legs} leg${legs === 1 ? "" : "s"}, ${tall(answer.height)} tall.`
      + (legs === 1 ? ONE_LEGGED : "");
    this.verdict.className = "verdict good";
  }

  fail(why) {
    this.verdict.textContent = why;
    this.verdict.className = "verdict bad";
    this.show();
  }

  show() {
    const { draft, store } = this;
    if (!draft) return;
    const kinds = [...new Set([...store.welcome.rigs, ...rigsRemembered(), draft.rig])];
    fillChoice(this.builtIn, kinds.map((rig) => [rig, nameOfRig(rig)]), draft.rig);
    const walking = sameCreature(store.document.creature, this.creatureOfDraft());
    this.walk.disabled = !draft.walks || walking;
    this.walk.textContent = walking ? "It walks" : "Walk it";
    this.save.disabled = !walking;
    this.save.title = walking ? "" : "What walks can be saved: press Walk it first";
    const guesses = (draft.answer?.guesses ?? []).map((guess) => make("li", {}, guess));
    this.guesses.replaceChildren(...guesses.length ? guesses : [make("li", {}, "Nothing.")]);
    this.offerUnit();
    this.size.show(draft);
    this.legs.show(draft);
    this.mark();
    this.limits.show(walking);
  }

  // The document's creature as this draft would have it.
  creatureOfDraft() {
    const { creature } = this.store.document;
    const asked = this.draft.question();
    const same = creature.rig === asked.rig;
    // Other legs have other joints.
    const alike = same && ["leg", "spine"].every((key) => sameValue(creature[key], asked[key]));
    return {
      ...asked, body_height: same ? creature.body_height : null, limit: alike ? creature.limit ?? null : null,
    };
  }

  // Another joint is wanted: the picture of them comes into view.
  showPicking() {
    this.mark();
    if (this.legs.wanted) this.picture.element.scrollIntoView({ block: "nearest" });
  }

  // Colour joints and bones by what they are, in the picture and the tree.
  mark() {
    const { draft, legs } = this;
    if (!draft?.answer) return;
    const spine = new Set(draft.spine);
    const marks = new Map([...spine].map((node) => [node, { words: "spine", colour: SPINE }]));
    const bones = new Map();
    // The bone of a node leads to its parent, so that of the first joint is no part of a chain.
    for (const node of spine) if (spine.has(draft.byNode.get(node).parent)) bones.set(node, SPINE);
    draft.legs.forEach((leg, i) => {
      const colour = legs.colour(i);
      for (const node of draft.chain(leg).slice(0, -1)) bones.set(node, colour);
      marks.set(leg.hip, { words: "hip", colour });
      marks.set(leg.foot, { words: "foot", colour });
    });
    const dim = (node) => legs.refuses(node);
    if (legs.wanted?.hip !== undefined) marks.set(legs.wanted.hip, { words: "new hip", colour: SPINE });
    this.tree.mark(marks, dim);
    this.picture.draw(draft, {
      joint: (node) => {
        const mark = marks.get(node);
        return { colour: mark?.colour ?? bones.get(node) ?? QUIET, size: mark ? 3.5 : 2, dim: dim(node) };
      },
      bone: (node) => ({ colour: bones.get(node) ?? BONE, width: bones.has(node) ? 2.5 : 1.2 }),
    });
    this.element.classList.toggle("picking", Boolean(legs.wanted));
  }

  point(node) {
    this.picture.highlight(node);
    this.tree.highlight(node);
    this.pointed.textContent = node === null ? "" : this.draft.label(node);
  }

  pick(node) {
    this.point(node);
    if (this.legs.wanted) this.legs.take(node);
    else if (this.limits.chooseNode(node)) this.limits.element.scrollIntoView({ block: "nearest" });
  }

  // What was asked of another's feet, in another's size, means nothing to this one; where it walks,
  // and in what world, stays. All that is one step of undo.
  async letWalk() {
    const wanted = structuredClone(this.store.wanted);
    Object.assign(wanted, { creature: this.creatureOfDraft(), gait: null, spacing: [] });
    for (const key of OWN) wanted.command[key] = null;
    // The same rig in the crowd is what was corrected too.
    const { rig, leg, spine, forward, height } = wanted.creature;
    wanted.crowd = wanted.crowd.map((kind) => (
      kind.rig === rig ? { rig, leg, spine, forward, height, limit: wanted.creature.limit, count: kind.count } : kind
    ));
    const limited = this.store.document.creature;
    try {
      await this.store.send({ do: "open", document: wanted });
      if (limited.limit && limited.rig === this.draft.rig && !wanted.creature.limit) this.store.say(UNLIMITED);
    } catch (refusal) {
      this.store.say(refusal.message);
    }
    this.show();
  }

  async saveCreature() {
    try {
      const answer = await this.store.fetchSettled("/export/creature.toml");
      // A creature is called as its file is.
      saveAs(await answer.blob(), `${nameOfRig(this.draft.rig).replace(/\.\w+$/, "")}.toml`);
    } catch (error) {
      this.store.say(error.message);
    }
  }
}

function sameCreature(a, b) {
  return Object.keys(b).every((key) => sameValue(a[key], b[key]));
}

function sameValue(a, b) {
  return JSON.stringify(a ?? null) === JSON.stringify(b ?? null);
}

function tall(metres) {
  if (metres < 0.01) return `${(1000 * metres).toPrecision(3)} mm`;
  return metres < 1 ? `${(100 * metres).toPrecision(3)} cm` : `${metres.toPrecision(3)} m`;
}
