// The footfall diagram as animators know it: a row a foot, a bar where it stands, time scrolls.
// Left of the line is what was, right of it what the gait asked for says will be.

import { cut, fit, palette, redraw } from "/page/canvas.js";
import { disksOf, needleNow, wrap } from "/page/disks.js";
import { make } from "/page/elements.js";
import { shortNames } from "/page/foot_names.js";
import { foreToHind } from "/page/foot_order.js";
import { shown } from "/page/switches.js";

const NAMES = 84; // px, for the feet's names
const AXIS = 16; // px, for the time below
const PAST_CYCLES = 2; // to the left of the line
const PAST_SHARE = 0.6; // of the width
const FRAMES_A_SECOND = 15;
// Seconds shown to the left where the creature stands, and at most.
const RESTING_SECONDS = 2;
const LONGEST_SECONDS = 8;

export class Footfalls {
  constructor(store, history) {
    this.store = store;
    this.history = history;
    this.canvas = make("canvas", { class: "footfalls", role: "img", "aria-label": "Footfalls: what was, and what the gait asks for" });
    this.element = this.canvas;
    const again = redraw(FRAMES_A_SECOND, () => this.draw());
    for (const kind of ["frame", "document", "creature"]) store.on(kind, again);
    store.on("creature", () => this.size());
    this.size();
  }

  size() {
    const count = this.store.creature?.feet.length ?? 4;
    this.names = shortNames(this.store.creature?.feet ?? []);
    this.row = count > 16 ? 7 : count > 8 ? 11 : 15;
    this.canvas.style.height = `${count * this.row + AXIS + 4}px`;
  }

  draw() {
    const feet = this.store.creature?.feet;
    const frame = this.store.frame;
    if (!feet || !frame || frame.focus.feet.length !== feet.length || !shown(this.canvas)) return;
    const { context, width, height } = fit(this.canvas);
    const { cycleRate } = frame.focus;
    const past = cycleRate > 0 ? Math.min(PAST_CYCLES / cycleRate, LONGEST_SECONDS) : RESTING_SECONDS;
    const line = NAMES + PAST_SHARE * (width - NAMES);
    const scale = { line, perSecond: (line - NAMES) / past, width, height };
    this.order = foreToHind(feet);
    this.drawAxis(context, scale, past);
    this.drawNames(context, feet);
    this.drawPast(context, scale, feet, frame, past);
    this.drawFuture(context, scale, feet, cycleRate);
    context.fillStyle = palette().text;
    context.fillRect(Math.round(line) - 0.5, 0, 1.5, height - AXIS);
  }

  drawAxis(context, { line, perSecond, width, height }, past) {
    const { quiet, line: grey, font } = palette();
    context.font = font;
    context.textAlign = "center";
    const step = [0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5].find((s) => s * perSecond > 42) ?? 5;
    for (let n = -Math.floor(past / step); line + n * step * perSecond < width; n++) {
      const x = Math.round(line + n * step * perSecond) + 0.5;
      context.fillStyle = grey;
      context.fillRect(x, 0, 0.5, height - AXIS);
      const words = n === 0 ? "now" : `${n > 0 ? "+" : "−"}${Number(Math.abs(n * step).toFixed(2))} s`;
      context.fillStyle = quiet;
      if (x < width - 14) context.fillText(words, x, height - 4);
    }
  }

  drawNames(context, feet) {
    context.textAlign = "left";
    if (this.row < 10) return;
    context.font = palette().font;
    this.order.forEach((k, row) => {
      context.fillStyle = feet[k].colour;
      context.fillRect(0, row * this.row + 3, 4, this.row - 6);
      context.fillStyle = palette().text;
      context.fillText(cut(context, this.names[k], NAMES - 12), 8, (row + 0.5) * this.row + 4);
    });
  }

  bar(context, row, from, to, colour, strong) {
    if (to - from < 0.3) return;
    context.globalAlpha = strong ? 1 : 0.42;
    context.fillStyle = colour;
    const gap = this.row < 10 ? 1 : 3;
    context.fillRect(from, row * this.row + gap, to - from, this.row - 2 * gap);
    context.globalAlpha = 1;
  }

  drawPast(context, { line, perSecond }, feet, frame, past) {
    const samples = this.history.before(frame, past).filter(({ stance }) => stance.length === feet.length);
    if (samples.length < 2) return;
    const now = samples.at(-1).time;
    const place = (time) => Math.max(line + (time - now) * perSecond, NAMES);
    this.order.forEach((k, row) => {
      for (const [from, to] of stances(samples, k)) {
        this.bar(context, row, place(from), place(to), feet[k].colour, true);
      }
    });
  }

  drawFuture(context, { line, perSecond, width }, feet, cycleRate) {
    const disks = disksOf(this.store);
    if (!disks || disks.start.length !== feet.length || !(cycleRate > 0)) return;
    const needle = needleNow(this.store);
    const perCycle = perSecond / cycleRate;
    this.order.forEach((k, row) => {
      // Stances, from the one that may have begun before now.
      const touchdown = wrap(disks.start[k] + disks.extent[k] - needle) - 1;
      for (let from = touchdown; line + from * perCycle < width; from += 1) {
        const left = Math.max(line + from * perCycle, line);
        const right = Math.min(line + (from + 1 - disks.extent[k]) * perCycle, width);
        this.bar(context, row, left, right, feet[k].colour, false);
      }
    });
  }
}

// When a foot stood: [[from, to]], s. Each sample holds until the next one.
export function stances(samples, k) {
  const found = [];
  samples.forEach(({ time, stance }, i) => {
    if (!stance[k]) return;
    const until = samples[i + 1]?.time ?? time;
    const last = found.at(-1);
    if (last && last[1] === time) last[1] = until;
    else found.push([time, until]);
  });
  return found;
}
