// The bar above: time, view, undo and redo, and how fast everything goes.

import { addStyle, fillChoice, make, makeButton, makeChoice } from "/page/elements.js";
import { CAMERAS } from "/page/cameras.js";
import { OverlayMenu } from "/page/overlay_menu.js";
import { QUALITIES } from "/page/painter.js";
import { Rates } from "/page/rates.js";

const SLOWEST = 0.1;
const FASTEST = 2;

export function mountBar(element, store, scene) {
  addStyle("bar.css");
  element.append(
    clockPart(store), ratePart(store), viewPart(scene), historyPart(store),
    new Rates(store, scene).element,
  );
}

function order(store, what) {
  store.send(what).catch((refusal) => store.say(refusal.message));
}

function clockPart(store) {
  const play = makeButton("", () => order(store, { do: "clock", playing: !store.playing }), {
    class: "play", title: "Play or pause (Space)",
  });
  const step = makeButton("Step", () => order(store, { do: "clock", playing: false, steps: 1 }), {
    title: "One frame on, while paused (.)",
  });
  const restart = makeButton("Restart", () => order(store, { do: "restart" }), {
    title: "Everything stands again where it began",
  });
  const refresh = () => {
    play.textContent = store.clock.playing ? "Pause" : "Play";
    for (const button of [play, step, restart]) button.disabled = !store.drives;
  };
  for (const kind of ["clock", "welcome", "role"]) store.on(kind, refresh);
  refresh();
  return make("div", { class: "group", role: "group", "aria-label": "Time" }, play, step, restart);
}

// How fast time goes: a slider for the hand, a box for the number, a button for real time.
function ratePart(store) {
  const range = make("input", {
    type: "range", min: Math.log2(SLOWEST), max: Math.log2(FASTEST), step: 0.01,
    "aria-label": "Time scale", title: "How fast time goes",
  });
  const box = make("input", {
    type: "number", min: SLOWEST, max: FASTEST, step: 0.1, "aria-label": "Time scale, times real time",
  });
  const reset = makeButton("1×", () => send(1), { title: "Real time", "aria-label": "Time scale to real time" });
  let sent = null;
  const send = (rate) => {
    const bounded = Math.min(Math.max(rate, SLOWEST), FASTEST);
    if (bounded === sent) return;
    sent = bounded;
    order(store, { do: "clock", rate: Number(bounded.toFixed(2)) });
  };
  range.addEventListener("input", () => send(2 ** range.valueAsNumber));
  box.addEventListener("change", () => {
    if (Number.isFinite(box.valueAsNumber)) send(box.valueAsNumber);
    refresh();
  });
  const refresh = () => {
    const { rate } = store.clock;
    sent = null;
    if (document.activeElement !== range) range.value = String(Math.log2(rate));
    range.setAttribute("aria-valuetext", `${rate.toFixed(2)} times real time`);
    if (document.activeElement !== box) box.value = String(Number(rate.toFixed(2)));
    for (const input of [range, box, reset]) input.disabled = !store.drives;
  };
  for (const kind of ["clock", "welcome", "role"]) store.on(kind, refresh);
  refresh();
  return make("div", { class: "group rate", role: "group", "aria-label": "Time scale" },
    range, box, make("span", { class: "quiet", "aria-hidden": "true" }, "×"), reset);
}

function viewPart(scene) {
  const camera = makeChoice("Camera", (mode) => scene.cameras.choose(mode));
  fillChoice(camera, Object.entries(CAMERAS).map(([mode, { title }]) => [mode, title]), scene.cameras.mode);
  scene.cameras.onMode((mode) => {
    camera.value = mode;
    camera.title = `Camera: ${CAMERAS[mode].hint}`;
  });
  const frame = makeButton("Frame", () => scene.frame(), { title: "Show the whole creature (F)" });
  return make("div", { class: "group", role: "group", "aria-label": "View" },
    camera, frame, new OverlayMenu(scene.overlays).element, qualityChoice(scene.painter));
}

// How finely it is drawn.
function qualityChoice(painter) {
  const choice = makeChoice("Picture quality", (pinned) => painter.choose(pinned));
  const options = Object.entries(QUALITIES).map(([value, { title }]) => make("option", { value }, title));
  choice.append(make("optgroup", { label: "Picture quality" }, ...options));
  painter.onChange(() => {
    choice.value = painter.pinned;
    choice.title = `Picture quality: ${QUALITIES[painter.pinned].hint}`;
  });
  return choice;
}

function historyPart(store) {
  const undo = makeButton("Undo", () => order(store, { do: "undo" }), { title: "Undo (Ctrl+Z)" });
  const redo = makeButton("Redo", () => order(store, { do: "redo" }), { title: "Redo (Ctrl+Shift+Z)" });
  const refresh = () => {
    undo.disabled = !store.drives || !store.canUndo;
    redo.disabled = !store.drives || !store.canRedo;
  };
  for (const kind of ["document", "welcome", "role"]) store.on(kind, refresh);
  refresh();
  return make("div", { class: "group", role: "group", "aria-label": "History" }, undo, redo);
}
