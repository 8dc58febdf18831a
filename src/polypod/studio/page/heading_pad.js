// A round pad for the direction in which to walk, the world from above: +z is up, +x to the left.
// The broad arrow is what is asked for, the thin one where the creature faces now.

import { make, makeSvg } from "/page/elements.js";
import { Gesture } from "/page/gesture.js";
import { onDrag } from "/page/moves.js";
import { NumberBox } from "/page/number_box.js";
import { headFor, headingOf, spokenDirection, turnBy } from "/page/steer.js";

const SIZE = 148;
const MIDDLE = SIZE / 2;
const RADIUS = MIDDLE - 25;
const DEGREE = Math.PI / 180;
const FINE = 5 * DEGREE;
const COARSE = 15 * DEGREE;

function on(radius, heading) {
  return [MIDDLE - radius * Math.sin(heading), MIDDLE - radius * Math.cos(heading)];
}

export class HeadingPad {
  constructor(store) {
    this.store = store;
    this.gesture = new Gesture(store);
    this.build();
    this.listen();
  }

  build() {
    this.face = makeSvg("line", { class: "pad-face" });
    this.asked = makeSvg("path", { class: "pad-asked" });
    this.knob = makeSvg("circle", { class: "pad-knob", r: 7 });
    this.pad = makeSvg(
      "svg",
      {
        class: "pad", viewBox: `0 0 ${SIZE} ${SIZE}`, width: SIZE, height: SIZE, tabindex: 0,
        role: "slider", "aria-label": "Heading", "aria-valuemin": -180, "aria-valuemax": 180,
      },
      makeSvg("circle", { class: "pad-ground", cx: MIDDLE, cy: MIDDLE, r: RADIUS }),
      ...ticks(), this.face, this.asked, this.knob, word("+z", 0), word("+x", Math.PI / 2),
    );
    this.box = new NumberBox({
      label: "Heading", unit: "°", factor: 1 / DEGREE, decimals: 0, step: 5,
      read: () => headingOf(this.store),
      write: (heading) => { this.gesture.begin(); headFor(this.store, this.gesture, heading); },
    });
    this.note = make("p", { class: "quiet" });
    this.element = make(
      "div", { class: "heading", role: "group", "aria-label": "Direction" },
      this.pad,
      make("div", { class: "beside" }, make("span", {}, "Heading"), this.box.element, this.note),
    );
  }

  listen() {
    const pad = this.pad;
    const head = (event) => {
      const box = pad.getBoundingClientRect();
      const left = box.left + box.width / 2 - event.clientX;
      const ahead = box.top + box.height / 2 - event.clientY;
      if (Math.hypot(left, ahead) > 3) headFor(this.store, this.gesture, Math.atan2(left, ahead));
    };
    const take = (event) => {
      this.gesture.begin();
      head(event);
      return true;
    };
    onDrag(pad, { take, follow: head });
    pad.addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = event.shiftKey ? COARSE : FINE;
    const turn = { ArrowLeft: step, ArrowUp: step, ArrowRight: -step, ArrowDown: -step }[event.key];
    if (turn !== undefined) turnBy(this.store, this.gesture, turn);
    else if (event.key === "Home") headFor(this.store, this.gesture, 0);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  refresh() {
    if (!this.store.document) return;
    const heading = headingOf(this.store);
    const [x, y] = on(RADIUS, heading);
    this.asked.setAttribute("d", arrow(heading));
    this.knob.setAttribute("cx", x);
    this.knob.setAttribute("cy", y);
    this.pad.setAttribute("aria-valuenow", Math.round(heading / DEGREE));
    this.pad.setAttribute("aria-valuetext", spokenDirection(heading));
    this.note.textContent = this.store.wanted.path.length
      ? "It follows its path. Turn it, and it leaves the path."
      : "Drag the pad, or use the arrow keys.";
    this.box.refresh();
  }

  // Where the creature faces in the frame that is shown.
  follow(frame) {
    const [x, y] = on(RADIUS - 6, frame.focus.heading);
    for (const [name, value] of [["x1", MIDDLE], ["y1", MIDDLE], ["x2", x], ["y2", y]]) {
      this.face.setAttribute(name, value.toFixed(1));
    }
    if (this.store.wanted?.path.length) this.refresh();
  }
}

function ticks() {
  return Array.from({ length: 12 }, (_, i) => {
    const [x1, y1] = on(RADIUS, (i * Math.PI) / 6);
    const [x2, y2] = on(RADIUS - (i % 3 ? 4 : 8), (i * Math.PI) / 6);
    return makeSvg("line", { class: "pad-tick", x1, y1, x2, y2 });
  });
}

function word(text, heading) {
  const [x, y] = on(RADIUS + 16, heading);
  return makeSvg("text", { class: "pad-word", x, y: y + 4, "text-anchor": "middle" }, text);
}

function arrow(heading) {
  const tip = on(RADIUS - 8, heading);
  const left = on(9, heading + 2.4);
  const right = on(9, heading - 2.4);
  return `M${tip} L${left} L${[MIDDLE, MIDDLE]} L${right} Z`;
}
