// One foot's wheel (P1 Figure 8, P2 Figures 4 and 9). Phase 0 is at the top, the needle turns
// clockwise. The filled disk is what the foot goes by now; the rim with its handles is what is
// asked for, and both are the same once a blend is over.

import { percent, rounded } from "/page/disks.js";
import { make, makeSvg } from "/page/elements.js";

const RADIUS = 44;
const RIM = 51;
export const HALF = 59; // of the drawing
const PARTS = { start: "swing start", finish: "swing finish", whole: "whole swing" };

function at(phase, radius) {
  const angle = 2 * Math.PI * phase;
  return `${(radius * Math.sin(angle)).toFixed(2)} ${(-radius * Math.cos(angle)).toFixed(2)}`;
}

function arc(start, extent, radius) {
  const large = extent > 0.5 ? 1 : 0;
  return `M${at(start, radius)}A${radius} ${radius} 0 ${large} 1 ${at(start + extent, radius)}`;
}

function sector(start, extent, radius) {
  return `${arc(start, extent, radius)}L0 0Z`;
}

export class Wheel {
  // `touch` is how far round a handle a finger still meets it, in the units of the drawing;
  // `short` the foot's name where there is little room.
  constructor(foot, index, touch, short) {
    this.foot = foot;
    this.index = index;
    this.touch = touch;
    this.swing = makeSvg("path", { class: "wheel-swing", fill: foot.colour });
    this.reception = makeSvg("path", { class: "wheel-reception" });
    this.propulsion = makeSvg("path", { class: "wheel-propulsion" });
    this.middle = makeSvg("line", { class: "wheel-middle", x1: 0, y1: 0 });
    // No part of the drawing: it turns in every picture, and what it turns over is not drawn again.
    this.needle = make("div", { class: "wheel-needle" });
    this.rim = makeSvg("path", { class: "wheel-rim", stroke: foot.colour });
    this.events = makeSvg("g");
    this.handles = {
      whole: this.makeWhole(),
      start: this.makeHandle("start"),
      finish: this.makeHandle("finish"),
    };
    this.picture = makeSvg("svg", { viewBox: `${-HALF} ${-HALF} ${2 * HALF} ${2 * HALF}`, role: "group", "aria-label": `${foot.name} wheel` },
      makeSvg("circle", { class: "wheel-back", r: RADIUS }),
      this.reception, this.propulsion, this.middle, this.swing, this.makeTicks(), this.rim, this.events,
      this.handles.whole, makeSvg("circle", { class: "wheel-hub", r: 3 }),
      this.handles.start, this.handles.finish);
    this.duty = make("span", { class: "quiet" });
    this.mark = make("span", { class: "wheel-mark" });
    const dot = make("span", { class: "foot-dot" });
    dot.style.background = foot.colour;
    const name = make("span", { class: "wheel-name", title: foot.name }, short);
    this.element = make("div", { class: "wheel" }, make("div", { class: "wheel-face" }, this.picture, this.needle), this.mark, make("div", { class: "wheel-words" }, dot, name, this.duty));
    this.element.style.setProperty("--foot", foot.colour);
    this.seen = {};
  }

  makeTicks() {
    const ticks = makeSvg("g", { class: "wheel-ticks" });
    for (let n = 0; n < 24; n++) {
      const inner = n % 6 === 0 ? RADIUS - 4 : RADIUS - 2;
      ticks.append(makeSvg("path", { d: `M${at(n / 24, inner)}L${at(n / 24, RADIUS)}` }));
    }
    return ticks;
  }

  makeGrip(part, ...shapes) {
    return makeSvg("g", {
      class: `wheel-grip wheel-grip-${part}`, tabindex: 0, role: "slider", "data-part": part,
      "aria-label": `${this.foot.name} ${PARTS[part]}`, "aria-valuemin": 0, "aria-valuemax": 100,
    }, ...shapes);
  }

  makeHandle(part) {
    // The finish is a square, so that the two are told apart without their place.
    const shape = part === "start"
      ? makeSvg("circle", { class: "wheel-knob", r: 5.5 })
      : makeSvg("rect", { class: "wheel-knob", x: -5, y: -5, width: 10, height: 10 });
    return this.makeGrip(part, makeSvg("circle", { class: "wheel-touch", r: this.touch }), shape);
  }

  makeWhole() {
    this.wholeShape = makeSvg("path", { class: "wheel-touch" });
    return this.makeGrip("whole", this.wholeShape);
  }

  // The disk in use.
  showDisk(start, extent) {
    if (!this.changed("disk", start, extent)) return;
    const stance = 1 - extent;
    const touchdown = start + extent;
    this.swing.setAttribute("d", sector(start, extent, RADIUS));
    this.reception.setAttribute("d", sector(touchdown, stance / 2, RADIUS));
    this.propulsion.setAttribute("d", sector(touchdown + stance / 2, stance / 2, RADIUS));
    const [x, y] = at(touchdown + stance / 2, RADIUS).split(" ");
    this.middle.setAttribute("x2", x);
    this.middle.setAttribute("y2", y);
    this.duty.textContent = percent(Math.round(100 * stance) / 100);
    this.duty.title = "duty: the share of the cycle for which it stands";
  }

  // The disk asked for, where the handles are.
  showAsked(start, extent) {
    if (!this.changed("asked", start, extent)) return;
    this.rim.setAttribute("d", arc(start, extent, RIM));
    this.wholeShape.setAttribute("d", sector(start, extent, RADIUS));
    const finish = rounded(start + extent);
    this.handles.start.setAttribute("transform", `translate(${at(start, RIM)})`);
    this.handles.finish.setAttribute("transform", `translate(${at(finish, RIM)})`);
    this.say("start", rounded(start), `lifts at ${percent(start)} of the cycle`);
    this.say("finish", finish, `lands at ${percent(finish)} of the cycle`);
    this.say("whole", rounded(start), `swings for ${percent(extent)} of the cycle, from ${percent(start)}`);
  }

  say(part, phase, words) {
    this.handles[part].setAttribute("aria-valuenow", String(Math.round(1000 * phase) / 10));
    this.handles[part].setAttribute("aria-valuetext", words);
  }

  changed(what, start, extent) {
    const seen = this.seen[what];
    if (seen && Math.abs(seen[0] - start) < 1e-4 && Math.abs(seen[1] - extent) < 1e-4) return false;
    this.seen[what] = [start, extent];
    return true;
  }

  showNeedle(phase) {
    this.needle.style.transform = `rotate(${(360 * phase).toFixed(1)}deg)`;
  }

  // Whether it is in the air, and whether it is the next to lift.
  showState(swings, next) {
    const state = swings ? "swings" : next ? "next" : "";
    if (this.state === state) return;
    this.state = state;
    this.element.classList.toggle("swings", swings);
    this.element.classList.toggle("next", state === "next");
    this.mark.textContent = state;
  }

  // While it is dragged: where other feet lift and land, to which it snaps.
  showEvents(events) {
    this.events.replaceChildren(...events.map(({ phase, colour }) => (
      makeSvg("path", { class: "wheel-event", stroke: colour, d: `M${at(phase, RIM + 3)}L${at(phase, RIM + 10)}` }))));
  }
}
