// How far the joints of the spine turn either way, of the creature that walks.

import { make } from "/page/elements.js";

const TURNS = [["yaw", "sideways"], ["pitch", "up, down"], ["roll", "roll"]];

export function limitTable(creature, walking) {
  if (!walking) return make("p", { class: "quiet" }, "They are known of what walks: press Walk it first.");
  if (!creature?.limits.length) return make("p", { class: "quiet" }, "Its trunk does not bend.");
  const head = make("tr", {}, make("th", { scope: "col" }, "joint"));
  for (const [, words] of TURNS) head.append(make("th", { scope: "col" }, `${words}, °`));
  const rows = creature.limits.map((limit) => make(
    "tr", {}, make("th", { scope: "row" }, limit.name || "none"),
    ...TURNS.map(([key]) => make("td", {}, `± ${((limit[key] * 180) / Math.PI).toFixed(1)}`)),
  ));
  return make(
    "table", { class: "limits" }, make("thead", {}, head), make("tbody", {}, ...rows),
  );
}
