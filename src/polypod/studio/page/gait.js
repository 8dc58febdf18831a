// The Gait panel: presets, wheels, footfalls, numbers, and whether the gait is plausible.

import { addStyle, fillChoice, make, makeChoice, makeSection } from "/page/elements.js";
import { FootNumbers } from "/page/foot_numbers.js";
import { Footfalls } from "/page/footfalls.js";
import { historyOf } from "/page/history.js";
import { documentSlider } from "/page/slider.js";
import { shown, Switch, whenShown } from "/page/switches.js";
import { VerdictView } from "/page/verdict.js";
import { Wheels } from "/page/wheels.js";
import { GaitEditor } from "/page/wheels_edit.js";

const FOLLOWS = ""; // the choice of no gait: it follows speed
const BY_SPEED = "by speed";
const LIVE = 250; // ms between the numbers of what follows by itself

export function mountGait(element, store) {
  addStyle("panels.css");
  addStyle("gait.css");
  const snap = new Switch("Snap", "polypod.gait.snap", true, () => {}, {
    title: "Handles snap to 1/24 of the cycle and to where other feet lift and land; Alt while dragging lets go",
  });
  const mirror = new Switch("Mirror", "polypod.gait.mirror", true, () => {}, {
    "aria-label": "Mirror left and right", title: "An edit of a foot moves the foot on the other side alike",
  });
  const editor = new GaitEditor(store, snap, mirror);
  const wheels = new Wheels(store, editor, (k) => numbers.choose(k));
  const numbers = new FootNumbers(store, editor, (k) => wheels.mark(k));
  const verdict = new VerdictView(store);
  const sliders = makeSliders(store, element);
  element.append(
    verdict.badge,
    make("div", { class: "row gait-presets" }, makePresets(store), snap.element, mirror.element),
    sliders.blend.element,
    wheels.element,
    makeLegend(),
    makeSection("Footfalls", new Footfalls(store, historyOf(store)).element),
    makeSection("One foot", numbers.element),
    makeSection("Tempo", sliders.period.element, sliders.duty.element),
    makeSection("Plausible?", verdict.element),
  );
}

function makePresets(store) {
  const choice = makeChoice("Gait", (value) => {
    const name = value === FOLLOWS ? null : value;
    store.send({ do: "gait", name })
      .catch((refusal) => { store.say(refusal.message); show(); });
  });
  const show = () => {
    const names = store.creature?.gaits ?? [];
    const asked = store.wanted?.gait?.name ?? FOLLOWS;
    // What was drawn by hand is in the list while it is asked for.
    const own = asked === FOLLOWS || names.includes(asked) ? [] : [asked];
    const options = [...own, ...names].map((name) => [name, name]);
    fillChoice(choice, [[FOLLOWS, "follows speed"], ...options], asked);
  };
  store.on("document", show);
  store.on("creature", show);
  return choice;
}

function makeLegend() {
  const item = (kind, words) => make("span", {}, make("span", { class: `legend-${kind}` }), words);
  return make("div", { class: "wheel-legend quiet", "aria-hidden": "true" },
    item("swing", "swing"), item("reception", "reception"), item("propulsion", "propulsion"),
    item("start", "lifts"), item("finish", "lands"));
}

// In how many cycles a change blends; period and duty, which follow speed unless they are set.
function makeSliders(store, element) {
  const slider = (label, key, live) => documentSlider(store, {
    label, at: ["command", key], range: () => store.creature.ranges[key],
    automatic: live && { words: BY_SPEED, live: () => (store.frame ? live(store.frame.focus) : null) },
  });
  const sliders = {
    blend: slider("Blend in", "blend_cycles"),
    period: slider("Period", "period", (focus) => (focus.cycleRate > 0 ? 1 / focus.cycleRate : null)),
    duty: slider("Duty", "duty", (focus) => focus.duty),
  };
  let last = -Infinity;
  const refresh = () => {
    if (!store.document || !store.creature) return;
    last = performance.now();
    for (const each of Object.values(sliders)) each.refresh();
  };
  store.on("document", refresh);
  store.on("creature", refresh);
  whenShown(refresh);
  store.on("frame", () => { if (performance.now() - last > LIVE && shown(element)) refresh(); });
  return sliders;
}
