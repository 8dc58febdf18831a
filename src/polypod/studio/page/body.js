// The Body panel: where it walks and how fast, how it holds itself, what moves its trunk, pushes.

import { redraw } from "/page/canvas.js";
import { addStyle, make, makeSection } from "/page/elements.js";
import { HeadingPad } from "/page/heading_pad.js";
import { PushPad } from "/page/push_pad.js";
import { documentSlider } from "/page/slider.js";

const FRAMES_A_SECOND = 60;
const LIVE = 250; // ms between the numbers of what follows by itself
// Settings are scales; 1 is what the creature's build and gait imply.
const SCALE = { least: 0, most: 2, default: 1, unit: "×", step: 0.05 };
// Commands that are null for a default of the creature's own.
const OWN = ["speed", "step_height", "body_height"];
const BY_SPEED = "by speed";

const TRUNK = [
  ["Spine", "spine"], ["Yaw effect", "spine_yaw"], ["Flexion", "spine_flexion"], ["Gaze", "gaze"],
  ["Tail", "tail"],
];
const MOTION = [["Bounce", "bounce"], ["Nod", "nod"], ["Sway", "sway"]];

export function mountBody(element, store) {
  addStyle("panels.css");
  const sliders = [];
  const add = (slider) => { sliders.push(slider); return slider.element; };
  const command = (label, key, automatic) =>
    add(documentSlider(store, {
      label, automatic, unset: OWN.includes(key), at: ["command", key], range: () => store.creature.ranges[key],
    }));
  const setting = ([label, key]) =>
    add(documentSlider(store, { label, at: ["settings", key], range: () => SCALE }));
  const live = (number) => ({
    words: BY_SPEED, live: () => (store.frame ? number(store.frame.focus) : null),
  });

  const pad = new HeadingPad(store);
  const push = new PushPad(store);
  const stiff = make("p", { class: "quiet", hidden: true }, "This creature's trunk does not bend.");
  element.append(
    makeSection("Walk", command("Speed", "speed"), pad.element, command("Travel", "travel")),
    makeSection(
      "Posture", command("Body height", "body_height"), command("Step height", "step_height"),
      command("Stance width", "stance_width"),
    ),
    makeSection(
      "Tempo", command("Period", "period", live((focus) => (focus.cycleRate > 0 ? 1 / focus.cycleRate : null))),
      command("Duty", "duty", live((focus) => focus.duty)),
      command("Blend over", "blend_cycles"),
    ),
    makeSection("Motion by the gait", ...MOTION.map(setting)),
    makeSection("Spine, head and tail", stiff, ...TRUNK.map(setting)),
    makeSection("Push", push.element),
  );

  const refresh = () => {
    if (!store.document || !store.creature) return;
    for (const slider of sliders) slider.refresh();
    pad.refresh();
    push.refresh();
  };
  store.on("document", refresh);
  store.on("creature", () => {
    stiff.hidden = store.creature.spine.length > 0;
    push.forget();
    refresh();
  });
  followFrames(element, store, pad, sliders.filter((slider) => slider.automatic));
}

// What follows by itself changes with the frames; nothing is drawn while the panel is hidden.
function followFrames(element, store, pad, automatic) {
  let last = 0;
  const turn = redraw(FRAMES_A_SECOND, () => pad.follow(store.frame));
  store.on("frame", () => {
    if (element.hidden || !store.document || !store.creature) return;
    turn();
    if (performance.now() - last < LIVE) return;
    last = performance.now();
    for (const slider of automatic) slider.refresh();
  });
}
