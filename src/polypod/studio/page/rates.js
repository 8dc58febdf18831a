// How fast things go: simulated, received, drawn; and whether this tab drives and is connected.

import { make, makeButton } from "/page/elements.js";

const EVERY = 1000; // ms
const MEANING = "Share of real time that the simulation keeps; frames received and drawn a second";

export class Rates {
  constructor(store, scene) {
    this.store = store;
    this.scene = scene;
    this.words = make("span", { class: "numbers", title: MEANING });
    this.state = make("span", { class: "state", role: "status" });
    this.drive = makeButton("Drive from here", () => this.take(), {
      title: "Another tab drives; take over to change things", class: "drive",
    });
    this.element = make("div", { class: "group rates", role: "group", "aria-label": "Rates" }, this.words, this.state, this.drive);
    this.before = { at: performance.now(), frames: 0, received: 0, drawn: 0 };
    for (const kind of ["welcome", "role", "link"]) store.on(kind, () => this.refresh());
    setInterval(() => this.measure(), EVERY);
    this.refresh();
  }

  take() {
    this.store.send({ do: "drive" }).catch((refusal) => this.store.say(refusal.message));
  }

  measure() {
    const { store, scene, before } = this;
    const now = performance.now();
    const seconds = (now - before.at) / 1000;
    const frames = store.link?.frames ?? 0, received = store.link?.received ?? 0;
    const rate = (count, was) => Math.max(count - was, 0) / seconds;
    // For whoever measures, and for the words here.
    store.rates = {
      received: rate(frames, before.frames), drawn: rate(scene.drawn, before.drawn),
      bytes: rate(received, before.received),
    };
    Object.assign(before, { at: now, frames, received, drawn: scene.drawn });
    const { received: come, drawn, bytes } = store.rates;
    this.words.textContent = `${Math.round(100 * store.clock.behind)} % of real time · `
      + `${come.toFixed(0)} received · ${drawn.toFixed(0)} drawn`;
    this.words.title = `${MEANING} (${size(bytes)} a second now)`;
  }

  refresh() {
    const { connected, drives } = this.store;
    this.state.textContent = connected ? (drives ? "" : "· watching") : "no connection";
    this.state.classList.toggle("lost", !connected);
    this.drive.hidden = !connected || drives;
  }
}

function size(bytes) {
  return bytes < 1e6 ? `${(bytes / 1e3).toFixed(0)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}
