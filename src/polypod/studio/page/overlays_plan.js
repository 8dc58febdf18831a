// What the foot planner sees and chose, as the server sends it.

import { Lines } from "/page/lines.js";
import { DISC, Marks, RING, SQUARE } from "/page/marks.js";

const LIFT = 0.004; // leg lengths: over the ground on which it lies
const OUTLINE = 1.6; // of a candidate, for its size
const BEST = [0.18, 0.8, 0.35];
const WORST = [0.16, 0.33, 0.88];

export class PlanOverlays {
  constructor(scene, store) {
    this.store = store;
    this.cells = new Marks(scene, { order: 2 });
    this.candidates = new Marks(scene, { order: 4, leastPixels: 4 });
    this.flat = new Lines(scene, { width: 1.5, order: 6 });
    this.space = new Lines(scene, { width: 3.5, order: 7 });
    this.hull = new Lines(scene, { width: 2.5, order: 6 });
    this.drawn = {
      cells: [this.cells], candidates: [this.candidates], paths: [this.flat, this.space],
      hull: [this.hull],
    };
  }

  // Without a name: all.
  clear(name) {
    for (const key of name ? [name] : Object.keys(this.drawn)) {
      for (const part of this.drawn[key] ?? []) part.clear().commit();
    }
  }

  take({ name, arrays }) {
    // The plan is of the walk that goes on, and the tape is another place and time.
    if (this.store.tape.scrub !== null) return this.clear(name);
    switch (name) {
      case "cells": return this.takeCells(arrays);
      case "candidates": return this.takeCandidates(arrays);
      case "paths": return this.takePaths(arrays);
      case "hull": return this.takeHull(arrays);
      default: return undefined;
    }
  }

  get leg() {
    return this.store.creature?.leg_length ?? 1;
  }

  footColour(k) {
    return this.store.creature?.feet[k]?.colour ?? "#e6ebf0";
  }

  takeCells({ place, size, colour }) {
    const marks = this.cells.clear();
    const lift = LIFT * this.leg;
    for (let i = 0; i < place.shape[0]; i++) {
      marks.add(
        place.data[3 * i], place.data[3 * i + 1] + lift, place.data[3 * i + 2],
        0.86 * size.data[2 * i], 0.86 * size.data[2 * i + 1],
        colour.data[4 * i] / 255, colour.data[4 * i + 1] / 255, colour.data[4 * i + 2] / 255,
        colour.data[4 * i + 3] / 255, SQUARE,
      );
    }
    marks.commit();
  }

  // A disc by its score in a ring of its foot's colour.
  takeCandidates({ place, score, foot }) {
    const marks = this.candidates.clear();
    const lift = 2 * LIFT * this.leg;
    const size = 0.04 * this.leg;
    for (let i = 0; i < place.shape[0]; i++) {
      const [x, y, z] = place.data.subarray(3 * i, 3 * i + 3);
      marks.addHex(x, y + lift, z, OUTLINE * size, this.footColour(foot.data[i]), 1, RING);
    }
    for (let i = 0; i < place.shape[0]; i++) {
      const good = Math.min(Math.max(score.data[i], 0), 1);
      const tint = (c) => WORST[c] + (BEST[c] - WORST[c]) * good;
      marks.add(
        place.data[3 * i], place.data[3 * i + 1] + lift, place.data[3 * i + 2], size, size,
        tint(0), tint(1), tint(2), 0.95, DISC,
      );
    }
    marks.commit();
  }

  takePaths({ place, start, foot, plan }) {
    this.flat.clear();
    this.space.clear();
    for (let p = 0; p + 1 < start.data.length; p++) {
      const lines = plan.data[p] ? this.flat : this.space;
      lines.colour(this.footColour(foot.data[p]), plan.data[p] ? 0.75 : 1);
      lines.through(place.data, start.data[p], start.data[p + 1]);
    }
    this.flat.commit();
    this.space.commit();
  }

  // A line for each slice under the body.
  takeHull({ place, start }) {
    this.hull.clear().colour("#7ccf8a");
    for (let i = 0; i + 1 < start.data.length; i++) {
      this.hull.through(place.data, start.data[i], start.data[i + 1]);
    }
    this.hull.commit();
  }
}
