// What can be drawn over the scene, each with a switch that is remembered.

import { BodyOverlays } from "/page/overlays_body.js";
import { PlanOverlays } from "/page/overlays_plan.js";

const KEPT = "polypod.overlays";

// `server`: it comes as named arrays, for which the page must ask. `legend`: colours and words.
export const OVERLAYS = {
  route: { title: "Way to go", server: false, legend: [["#6cb4ee", "path and goal"]] },
  targets: { title: "Foot targets", server: false, legend: [["#e6ebf0", "ring: target, diamond: preferred place"]] },
  paths: { title: "Foot paths, 2D and 3D", server: true, legend: [["#e6ebf0", "thin: in the plan, strong: in space"]] },
  candidates: { title: "Candidate footprints", server: true, legend: [["#2ecc5a", "best"], ["#2a54e0", "worst"], ["#e6ebf0", "ring: of which foot"]] },
  cells: {
    title: "Map cells", server: true,
    legend: [
      ["#f2a0c0", "ground"], ["#f2d94e", "corner"], ["#54c464", "edge"], ["#4f7ce8", "inside"],
      ["#dc4a3c", "grown by the foot"], ["#202020", "forbidden"],
    ],
  },
  trajectory: { title: "Body trajectory", server: false, legend: [["#ffb454", "the last 5 s"]] },
  hull: { title: "Support hull", server: true, legend: [["#7ccf8a", "over what the feet stand on"]] },
  spine: { title: "Pelvis nodes and spine", server: false, legend: [["#2f6fe4", "nodes"], ["#111111", "spine"]] },
  limits: { title: "Joint limits", server: false, legend: [["#ffd166", "how far each joint turns"]] },
  bones: { title: "Bones", server: false, legend: [["#e6ebf0", "joints and bones"]] },
};

const AT_FIRST = ["route", "targets", "paths"];

export class Overlays {
  constructor(scene, store, creatures) {
    this.store = store;
    this.shown = new Set(remembered());
    this.plan = new PlanOverlays(scene, store);
    this.body = new BodyOverlays(scene, store, creatures);
    this.listeners = new Set();
    store.on("arrays", (message) => {
      if (this.shown.has(message.name)) this.plan.take(message);
    });
    // The link says itself what this tab wants to see once it is there.
    store.on("link", (there) => { if (there) store.link.overlays = this.asked(); });
    store.on("frame", (frame) => this.body.take(frame));
    // What was drawn of another creature is gone.
    store.on("creature", () => { this.plan.clear(); this.body.forget(); });
  }

  asked() {
    return [...this.shown].filter((name) => OVERLAYS[name].server);
  }

  has(name) {
    return this.shown.has(name);
  }

  onChange(listener) {
    this.listeners.add(listener);
  }

  set(name, on) {
    if (on) this.shown.add(name);
    else this.shown.delete(name);
    localStorage.setItem(KEPT, JSON.stringify([...this.shown]));
    if (!on) this.plan.clear(name);
    if (OVERLAYS[name].server && this.store.connected) {
      this.store.link.see(this.asked()).catch((refusal) => this.store.say(refusal.message));
    }
    for (const listener of this.listeners) listener(name, on);
  }

  // Draw what moves with the creatures; `playback` says which two frames are shown.
  update(playback) {
    this.body.update(playback, this.shown);
  }
}

function remembered() {
  try {
    const kept = JSON.parse(localStorage.getItem(KEPT) ?? "null");
    if (Array.isArray(kept)) return kept.filter((name) => name in OVERLAYS);
  } catch { /* what another version kept: begin anew */ }
  return AT_FIRST;
}
