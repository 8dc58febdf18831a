// The strip: footfalls and plots through time. Live it shows the last seconds; what was recorded is
// a scrubber.

import { fit, redraw } from "/page/canvas.js";
import { addStyle, make, makeButton } from "/page/elements.js";
import { historyOf } from "/page/history.js";
import { LANES } from "/page/lanes.js";
import { drawPlots, GUTTER } from "/page/plots.js";
import { Scrubber } from "/page/scrubber.js";
import { shown, Switch } from "/page/switches.js";

const SECONDS = 4; // shown live
const FRAMES_A_SECOND = 15;
const LONGEST_GAP = 0.3; // s between two samples that a line joins
const AT_FIRST = ["footfalls", "height", "particles"];

export function mountStrip(element, store) {
  addStyle("strip.css");
  const strip = new Strip(store);
  element.append(strip.element);
}

class Strip {
  constructor(store) {
    this.store = store;
    this.history = historyOf(store);
    this.scrubber = new Scrubber(store);
    this.again = redraw(FRAMES_A_SECOND, () => this.draw());
    this.switches = LANES.map((lane) => new Switch(
      lane.title, `polypod.strip.${lane.key}`, AT_FIRST.includes(lane.key), () => this.change(), { title: lane.about }));
    this.liveButton = makeButton("Live", () => this.scrubber.live(), { title: "The walk as it goes on (Escape on the slider)" });
    this.tapeButton = makeButton("Recorded", () => this.scrubber.go(0), { title: "What was recorded, from its beginning" });
    this.time = make("output", { class: "strip-time quiet" });
    this.canvas = make("canvas", { role: "img", "aria-label": "Plots against time" });
    this.cursor = make("div", { class: "strip-cursor" });
    this.plots = make("div", { class: "strip-plots" }, this.canvas, this.cursor);
    this.element = make("div", { class: "strip" },
      make("div", { class: "strip-head" }, this.liveButton, this.tapeButton,
        make("div", { class: "strip-lanes", role: "group", "aria-label": "Plots to show" }, ...this.switches.map((lane) => lane.element)),
        this.time),
      this.plots, this.scrubber.element);
    this.scrubber.bind(this.plots, GUTTER, () => this.scrubbing);
    this.scrubber.bind(this.scrubber.element, 0, () => true);
    for (const kind of ["frame", "creature", "tape", "document"]) store.on(kind, this.again);
    store.on("tape", () => this.showTape());
    new ResizeObserver(() => this.change()).observe(this.plots);
    this.showTape();
  }

  get scrubbing() {
    return this.store.tape.scrub !== null;
  }

  // Something else than time has changed: all is drawn anew.
  change() {
    this.drawn = null;
    this.again();
  }

  showTape() {
    const { frames, recording, seconds } = this.store.tape;
    const there = frames > 0 && !recording;
    this.tapeButton.hidden = frames === 0;
    this.tapeButton.disabled = recording;
    this.tapeButton.textContent = `${recording ? "Recording" : "Recorded"} ${seconds.toFixed(1)} s`;
    this.liveButton.setAttribute("aria-pressed", String(!this.scrubbing));
    this.tapeButton.setAttribute("aria-pressed", String(this.scrubbing));
    this.scrubber.element.hidden = !there;
    this.plots.classList.toggle("scrubs", this.scrubbing);
  }

  draw() {
    const feet = this.store.creature?.feet;
    if (!feet || !shown(this.element)) return;
    if (this.scrubbing) this.drawTape(feet);
    else this.drawLive(feet);
    this.scrubber.show();
  }

  get lanes() {
    return LANES.filter((_, n) => this.switches[n].on);
  }

  drawLive(feet) {
    this.drawn = null;
    this.cursor.hidden = true;
    const { frame } = this.store;
    if (!frame) return;
    const now = frame.time;
    const fitting = this.history.before(frame, SECONDS).filter(({ stance }) => stance.length === feet.length);
    this.write(`${now.toFixed(2)} s`);
    drawPlots(fit(this.canvas), this.lanes, {
      feet, from: now - SECONDS, to: now, cursor: fitting.at(-1),
      samples: fitting.map((sample, i) => ({ x: sample.time, sample, gap: i === 0 })),
    });
  }

  // The plots of a tape are drawn anew where the cursor's figures change; else only it moves.
  drawTape(feet) {
    const at = this.scrubber.frame ?? 0;
    const { rate, last } = this.scrubber;
    const drawn = `${this.history.version} ${last} ${at}`;
    if (drawn !== this.drawn) {
      this.drawn = drawn;
      drawPlots(fit(this.canvas), this.lanes, {
        feet, from: 0, to: last / rate, cursor: this.history.scrubbed,
        samples: this.tapeSamples(feet),
      });
    }
    this.cursor.hidden = false;
    const share = last > 0 ? at / last : 0;
    this.cursor.style.left = `calc(${GUTTER}px + (100% - ${GUTTER}px) * ${share.toFixed(5)})`;
    this.write(`${(at / rate).toFixed(2)} s of ${this.store.tape.seconds.toFixed(2)} s`);
  }

  tapeSamples(feet) {
    const known = this.history.recorded().filter(({ sample }) => sample.stance.length === feet.length);
    // More samples than pixels cannot be seen.
    const stride = Math.max(1, Math.floor(known.length / Math.max(this.canvas.clientWidth, 1)));
    const taken = known.filter((_, n) => n % stride === 0);
    // Where frames never came to this page there is nothing to draw, and no line across.
    return taken.map(({ x, sample }, i) => ({
      x, sample, gap: i === 0 || x - taken[i - 1].x > LONGEST_GAP * stride,
    }));
  }

  write(words) {
    if (this.time.textContent !== words) this.time.textContent = words;
  }
}
