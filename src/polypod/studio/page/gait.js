// The Gait panel: presets, wheels, numbers, footfalls, and whether the gait is plausible.

import { Footfalls } from "/page/footfalls.js";
import { historyOf } from "/page/history.js";
import { addStyle, html, kept } from "/page/svg.js";
import { disksOf } from "/page/disks.js";
import { FootNumbers } from "/page/foot_numbers.js";
import { NumberField } from "/page/number_field.js";
import { VerdictView } from "/page/verdict.js";
import { GaitEditor } from "/page/wheels_edit.js";
import { Wheels } from "/page/wheels.js";

const FOLLOWS = ""; // the choice of no gait: it follows speed

export function mountGait(element, store) {
  addStyle("gait.css");
  const snap = kept("Snap", "polypod.gait.snap", true, () => {}, { title: "Handles snap to 1/24 of the cycle and to where other feet lift and land; Alt while dragging lets go" });
  const mirror = kept("Mirror", "polypod.gait.mirror", true, () => {}, { "aria-label": "Mirror left and right", title: "An edit of a foot moves the foot on the other side alike" });
  const options = { get snap() { return snap.on; }, get mirror() { return mirror.on; } };
  const editor = new GaitEditor(store, options);
  const wheels = new Wheels(store, editor, (k) => numbers.choose(k));
  const numbers = new FootNumbers(store, editor, (k) => wheels.mark(k));
  const verdict = new VerdictView(store);
  const footfalls = new Footfalls(store, historyOf(store));
  element.append(
    verdict.badge,
    makePresets(store),
    html("div", { class: "row gait-options" }, snap.element, mirror.element, makeBlend(store)),
    wheels.element,
    makeLegend(),
    html("h2", {}, "Footfalls"),
    footfalls.element,
    html("h2", {}, "One foot"),
    numbers.element,
    html("h2", {}, "Tempo"),
    ...makeTempo(store),
    html("h2", {}, "Plausible?"),
    verdict.element,
  );
}

function makePresets(store) {
  const choice = html("select", { id: "gait-choice" });
  choice.addEventListener("change", () => {
    const name = choice.value === FOLLOWS ? null : choice.value;
    store.send({ do: "gait", name, cycles: store.document.command.blend_cycles })
      .catch((refusal) => { store.say(refusal.message); show(); });
  });
  const show = () => {
    const names = store.creature?.gaits ?? [];
    const asked = store.document?.gait?.name ?? FOLLOWS;
    // What was drawn by hand is in the list while it is asked for.
    const own = asked === FOLLOWS || names.includes(asked) ? [] : [asked];
    const listed = [FOLLOWS, ...own, ...names];
    if (JSON.stringify(listed) !== choice.dataset.listed) {
      choice.dataset.listed = JSON.stringify(listed);
      choice.replaceChildren(...listed.map((name) => (
        html("option", { value: name }, name === FOLLOWS ? "follows speed" : name))));
    }
    choice.value = asked;
  };
  store.on("document", show);
  store.on("creature", show);
  return html("div", { class: "row gait-presets" }, html("label", { for: "gait-choice" }, "Gait"), choice);
}

// In how many cycles another gait is blended to.
function makeBlend(store) {
  const cycles = new NumberField({
    label: "Blend in", unit: "cycles",
    commit: (value) => store.edit(["command", "blend_cycles"], value),
  });
  cycles.element.classList.add("gait-blend");
  store.on("document", () => cycles.show(store.document.command.blend_cycles));
  store.on("creature", () => cycles.bound(store.creature.ranges.blend_cycles));
  return cycles.element;
}

function makeLegend() {
  const item = (kind, words) => html("span", {}, html("span", { class: `legend-${kind}` }), words);
  return html("div", { class: "wheel-legend quiet", "aria-hidden": "true" },
    item("swing", "swing"), item("reception", "reception"), item("propulsion", "propulsion"),
    item("start", "lifts"), item("finish", "lands"));
}

// Period and duty: empty boxes follow speed, and say what it makes of them now.
function makeTempo(store) {
  const make = (key, label, unit, scale) => new NumberField({
    label, unit, scale, empty: "by speed", commit: (value) => store.edit(["command", key], value),
  });
  const period = make("period", "Period", "s", 1);
  const duty = make("duty", "Duty", "% of the cycle", 100);
  store.on("creature", () => {
    const { ranges } = store.creature;
    period.bound({ ...ranges.period, default: null });
    duty.bound({ ...ranges.duty, unit: undefined, default: null });
  });
  store.on("document", () => {
    period.show(store.document.command.period);
    duty.show(store.document.command.duty);
  });
  store.on("frame", ({ focus }) => {
    period.hint(focus.cycleRate > 0 ? 1 / focus.cycleRate : null);
    const disks = disksOf(store);
    duty.hint(disks ? focus.duty : null);
  });
  return [period.element, duty.element];
}
