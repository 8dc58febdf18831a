// How far a joint turns in one way: an arc with a handle at either end, and a needle that shows how
// it is turned now. The rest is at the top, and more is clockwise.

import { make, makeSvg } from "/page/elements.js";
import { movedEnd } from "/page/limit_edit.js";
import { onDrag } from "/page/moves.js";

const RADIUS = 40;
const RIM = 47;
const HALF = 60; // of the drawing
const DEGREE = Math.PI / 180;
// Small ranges are drawn larger: so many times, as long as the default one takes no more than this.
const ZOOMS = [8, 4, 2, 1];
const WIDEST = 65 * DEGREE;
const FARTHEST = 175 * DEGREE; // on the dial; what lies beyond is in the boxes alone
const STEPS = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };
const ENDS = ["least", "most"];

function at(angle, radius) {
  return `${(radius * Math.sin(angle)).toFixed(2)} ${(-radius * Math.cos(angle)).toFixed(2)}`;
}

function arc(least, most, radius) {
  // A whole turn has no two ends between which an arc could be drawn.
  const span = Math.min(most - least, 2 * Math.PI - 1e-3);
  const large = span > Math.PI ? 1 : 0;
  return `M${at(least, radius)}A${radius} ${radius} 0 ${large} 1 ${at(least + span, radius)}`;
}

export class LimitDial {
  // `joint` and `turn` as the creature has them; `words` say which way it turns.
  constructor(editor, joint, turn, words, colour) {
    Object.assign(this, { editor, joint, turn, words });
    this.asked = null; // the range that is being dragged to
    const size = Math.max(Math.abs(turn.default[0]), Math.abs(turn.default[1]));
    this.zoom = ZOOMS.find((zoom) => zoom * size <= WIDEST) ?? 1;
    this.snap = (this.zoom > 1 ? 0.5 : 1) * DEGREE;
    this.sector = makeSvg("path", { class: "limit-sector", fill: colour });
    this.usual = makeSvg("path", { class: "limit-usual" });
    this.needle = makeSvg("path", { class: "limit-needle", d: `M0 0L0 -${RADIUS + 3}`, visibility: "hidden" });
    this.handles = { least: this.makeHandle("least"), most: this.makeHandle("most") };
    const picture = makeSvg(
      "svg", { viewBox: `${-HALF} ${-HALF} ${2 * HALF} ${2 * HALF}`, role: "group", "aria-label": `${joint.name} ${words}` },
      makeSvg("circle", { class: "limit-back", r: RADIUS }), this.sector, makeTicks(), this.usual,
      this.needle, makeSvg("circle", { class: "limit-hub", r: 2.5 }), this.handles.least, this.handles.most,
    );
    this.picture = picture;
    this.now = make("span", { class: "limit-now" });
    this.element = make("div", { class: "limit-dial" }, picture, make("div", { class: "quiet" }, this.zoom > 1 ? `${words}, drawn ×${this.zoom}` : words), this.now);
    for (const end of ENDS) this.bind(end);
    this.show(turn);
  }

  makeHandle(end) {
    // The least is a square, so that the two are told apart without their place.
    const shape = end === "most"
      ? makeSvg("circle", { class: "limit-knob", r: 5.5 })
      : makeSvg("rect", { class: "limit-knob", x: -5, y: -5, width: 10, height: 10 });
    return makeSvg("g", {
      class: "limit-grip", tabindex: 0, role: "slider", "aria-label": `${this.joint.name} ${this.words} ${end}`,
      "aria-valuemin": -180, "aria-valuemax": 180,
    }, makeSvg("circle", { class: "limit-touch", r: 13 }), shape);
  }

  // Where an angle is on the dial, from the top on.
  drawn(angle) {
    if (this.zoom === 1) return angle;
    return Math.min(Math.max(angle * this.zoom, -FARTHEST), FARTHEST);
  }

  // Show what holds; while it is dragged the handles stay with the pointer.
  show(turn) {
    this.turn = turn;
    const [least, most] = this.asked ?? [turn.least, turn.most];
    this.sector.setAttribute("d", `${arc(this.drawn(turn.least), this.drawn(turn.most), RADIUS)}L0 0Z`);
    this.usual.setAttribute("d", arc(...turn.default.map((angle) => this.drawn(angle)), RADIUS + 2));
    for (const [end, angle] of [["least", least], ["most", most]]) {
      const handle = this.handles[end];
      handle.setAttribute("transform", `translate(${at(this.drawn(angle), RIM)})`);
      handle.setAttribute("aria-valuenow", (angle / DEGREE).toFixed(1));
      handle.setAttribute("aria-valuetext", `${(angle / DEGREE).toFixed(1)} degrees`);
    }
  }

  // Show how it is turned now, rad; null where that is not known.
  showNow(angle) {
    this.needle.setAttribute("visibility", angle === null ? "hidden" : "visible");
    if (angle === null) return;
    this.needle.setAttribute("transform", `rotate(${(this.drawn(angle) / DEGREE).toFixed(1)})`);
    this.now.textContent = `now ${Math.round(angle / DEGREE)}°`.replace("-", "−");
  }

  bind(end) {
    const handle = this.handles[end];
    onDrag(handle, {
      take: (event) => {
        this.editor.begin();
        return { last: this.angleAt(event), angle: this.turn[end] };
      },
      follow: (event, drag) => {
        // Turns add up, so that a hand that goes round past the foot of the dial goes on.
        const angle = this.angleAt(event);
        const step = angle - drag.last;
        drag.angle += (step - 2 * Math.PI * Math.round(step / (2 * Math.PI))) / this.zoom;
        drag.last = angle;
        this.move(end, drag.angle, event.altKey);
      },
      release: () => {
        this.asked = null;
        this.show(this.turn);
      },
    });
    handle.addEventListener("keydown", (event) => this.key(event, end));
    handle.addEventListener("dblclick", () => this.reset());
  }

  move(end, angle, free) {
    const snapped = free ? angle : Math.round(angle / this.snap) * this.snap;
    this.asked = movedEnd(this.joint, this.turn, end, snapped);
    this.editor.limit(this.joint, this.turn.key, this.asked);
    this.show(this.turn);
  }

  key(event, end) {
    const step = STEPS[event.key];
    if (event.ctrlKey || event.metaKey || (!step && event.key !== "Delete")) return;
    event.preventDefault();
    event.stopPropagation();
    if (!step) {
      this.reset();
      return;
    }
    const steps = Math.round(this.latest(end) / this.snap) + step * (event.shiftKey ? 5 : 1);
    this.stroked = movedEnd(this.joint, this.turn, end, steps * this.snap);
    this.editor.stroke(this.joint, this.turn.key, end, this.stroked);
  }

  // What was asked for last by keys, though the server may not have answered, else what holds.
  latest(end) {
    const waits = this.editor.gesture.busy && this.stroked;
    return waits ? this.stroked[end === "least" ? 0 : 1] : this.turn[end];
  }

  reset() {
    this.editor.put(this.joint, this.turn.key, this.turn.default);
  }

  // The pointer's angle about the dial's middle.
  angleAt(event) {
    const box = this.picture.getBoundingClientRect();
    const x = event.clientX - box.left - box.width / 2;
    const y = event.clientY - box.top - box.height / 2;
    return Math.atan2(x, -y);
  }
}

function makeTicks() {
  const ticks = makeSvg("g", { class: "limit-ticks" });
  for (let n = 0; n < 12; n++) {
    const angle = 30 * n * DEGREE;
    ticks.append(makeSvg("path", { d: `M${at(angle, n % 3 ? RADIUS - 3 : RADIUS - 6)}L${at(angle, RADIUS)}` }));
  }
  return ticks;
}
