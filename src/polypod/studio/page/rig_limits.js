// How far the joints of the spine turn either way, of the creature that walks.

import { make } from "/page/elements.js";

const TURNS = [["yaw", "sideways"], ["pitch", "up, down"], ["roll", "roll"]];
const SHOWN = "Those of all joints are drawn in the scene: Overlays, joint limits. A creature file sets others.";

export function limitTable(creature, walking) {
  if (!walking) return make("p", { class: "quiet" }, "They are known of what walks; press Walk it first.");
  if (!creature?.limits.length) {
    return make("p", { class: "quiet" }, `Its trunk does not bend. ${SHOWN}`);
  }
  const head = make("tr", {}, make("th", { scope: "col" }, "joint"));
  for (const [, words] of TURNS) head.append(make("th", { scope: "col" }, `${words}, °`));
  const rows = creature.limits.map((limit) => make(
    "tr", {}, make("th", { scope: "row" }, limit.name || "none"),
    ...TURNS.map(([key]) => make("td", {}, `± ${((limit[key] * 180) / Math.PI).toFixed(1)}`)),
  ));
  const table = make(
    "table", { class: "limits" }, make("thead", {}, head), make("tbody", {}, ...rows),
  );
  return make("div", {}, table, make("p", { class: "quiet" }, SHOWN));
}
