// The ground: flat, or made by a generator from a few numbers. It is made anew when asked to be,
// not while numbers are typed: large ground takes a moment.

import { fillChoice, make, makeButton, makeChoice, makeTick } from "/page/elements.js";
import { NumberBox } from "/page/number_box.js";

const FLAT = "flat";
const GIVEN = "given "; // before the name of a scene that was opened and brought ground of its own
// Keys that are no lengths in metres: their unit, what makes it shown, and its decimals.
const KEYS = {
  seed: { unit: "", factor: 1, decimals: 0 },
  count: { unit: "", factor: 1, decimals: 0 },
  share: { unit: "%", factor: 100, decimals: 0 },
  angle: { unit: "°", factor: 180 / Math.PI, decimals: 1 },
};
const LENGTH = { unit: "m", factor: 1, decimals: 3 };
const MOST_SEED = 1e6;

// A walk that begins anew would end the record.
const STAYS = "The record goes on where it walks now. What is not seen of this ground lies where walks begin: Restart goes there.";

export class TerrainPanel {
  constructor(store) {
    this.store = store;
    this.generator = FLAT; // what the boxes show, applied or not
    this.values = {};
    this.taken = null; // the document's terrain that they were taken from, or were sent as
    this.seen = null; // the document's terrain, as it was last
    this.choice = makeChoice("Ground", (name) => this.choose(name));
    this.keys = make("div", { class: "keys" });
    this.apply = makeButton("Make this ground", () => this.send(), { class: "main" });
    this.element = make(
      "div", {}, make("div", { class: "row" }, this.choice, this.apply), this.keys,
    );
    this.boxes = [];
    this.resets = new Map(); // of keys, the buttons that go back to their defaults
  }

  refresh() {
    const { generators } = this.store.welcome;
    const given = this.store.files.grounds;
    const names = [FLAT, ...Object.keys(generators)].map((name) => [name, name]);
    const scenes = given.map((name) => [GIVEN + name, `of ${name}`]);
    fillChoice(this.choice, [...names, ...scenes], this.generator);
    const terrain = JSON.stringify(this.store.document.terrain);
    // What was typed and not yet applied stays, until the ground itself is another than was sent.
    const another = terrain !== this.seen && terrain !== this.taken;
    this.seen = terrain;
    if (another) {
      this.taken = terrain;
      this.show(this.store.document.terrain);
    }
    this.mark();
  }

  show(terrain) {
    const { generator, given, ...values } = terrain ?? { generator: FLAT };
    const name = generator ?? GIVEN + given;
    this.choose(name, values);
    this.choice.value = name;
  }

  choose(generator, values = {}) {
    this.generator = generator;
    this.standard = this.store.welcome.generators[generator] ?? {};
    this.values = { ...this.standard, ...values };
    this.boxes = [];
    this.resets = new Map();
    this.keys.replaceChildren(...Object.keys(this.standard).map((key) => this.row(key)));
    this.mark();
  }

  row(key) {
    const words = key.replaceAll("_", " ");
    const row = make("div", { class: "key", role: "group", "aria-label": words });
    if (typeof this.standard[key] === "boolean") {
      const tick = makeTick(words, (on) => this.change(key, on));
      tick.box.checked = this.values[key];
      row.append(tick.element);
      return row;
    }
    const box = new NumberBox({
      label: words, ...(KEYS[key] ?? LENGTH),
      read: () => this.values[key],
      write: (value) => this.change(key, isWhole(key) ? Math.round(value) : value),
    });
    this.boxes.push(box);
    const standard = this.standard[key];
    const reset = makeButton("↺", () => { this.change(key, standard); box.refresh(); }, {
      class: "reset", title: `Default: ${box.spoken(standard)}`,
      "aria-label": `${words}: back to default, ${box.spoken(standard)}`,
    });
    this.resets.set(key, reset);
    row.append(make("span", {}, words), box.element, reset);
    if (key === "seed") {
      row.append(makeButton("Another", () => {
        this.change(key, Math.floor(Math.random() * MOST_SEED));
        box.refresh();
        this.send();
      }, { "aria-label": "Another seed, at once" }));
    }
    return row;
  }

  change(key, value) {
    this.values[key] = value;
    this.mark();
  }

  wanted() {
    if (this.generator === FLAT) return null;
    if (this.generator.startsWith(GIVEN)) return { given: this.generator.slice(GIVEN.length) };
    return { generator: this.generator, ...this.values };
  }

  // Grounds lie about the place where walks begin: of stairs, rocks or a slope nothing would be seen
  // from where the creature has got to meanwhile.
  async send() {
    const { store } = this;
    const before = store.document.terrain?.generator;
    this.taken = JSON.stringify(this.wanted());
    await store.edit(["terrain"], this.wanted());
    const now = store.document.terrain?.generator;
    if (!now || now === before) return; // flat ground is the same everywhere
    if (store.tape.recording) {
      store.say(STAYS);
      return;
    }
    await store.send({ do: "restart" }).catch((refusal) => store.say(refusal.message));
  }

  // The button says whether there is anything to make.
  mark() {
    const there = this.store.document.terrain;
    const full = there && { ...this.store.welcome.generators[there.generator], ...there };
    this.apply.disabled = same(full, this.wanted());
    for (const box of this.boxes) box.refresh();
    for (const [key, reset] of this.resets) reset.disabled = this.values[key] === this.standard[key];
  }
}

function isWhole(key) {
  return KEYS[key]?.decimals === 0 && KEYS[key].factor === 1;
}

function same(a, b) {
  const sorted = (object) => JSON.stringify(Object.entries(object ?? {}).sort());
  return sorted(a) === sorted(b);
}
