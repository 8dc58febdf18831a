// Whether the gait is plausible: its verdict always in sight, and below why, with the peak forces.

import { make } from "/page/elements.js";
import { shortNames } from "/page/foot_names.js";

const SIGNS = { plausible: "✓", hard: "▲", implausible: "✕" };
// A foot's load, in times that of standing: what the best animals do, and what none does.
const HARD_LOAD = 9;
const IMPOSSIBLE_LOAD = 11;

export class VerdictView {
  constructor(store) {
    this.store = store;
    this.word = make("strong");
    this.peak = make("span", { class: "quiet" });
    this.badge = make("div", { class: "verdict-badge", role: "status", "aria-label": "Plausibility" }, this.word, this.peak);
    this.sentence = make("p", { class: "verdict-sentence" });
    this.reasons = make("ul", { class: "verdict-reasons" });
    this.facts = make("p", { class: "quiet" });
    this.feet = make("div", { class: "verdict-feet", role: "list", "aria-label": "Peak force of each foot" });
    this.element = make("div", { class: "gait-verdict" }, this.sentence, this.reasons, this.facts, this.feet);
    store.on("verdict", () => this.show());
    store.on("creature", () => this.show());
    this.show();
  }

  show() {
    const { verdict, creature } = this.store;
    this.element.hidden = !verdict;
    this.badge.className = `verdict-badge ${verdict?.verdict ?? ""}`;
    if (!verdict) return;
    this.write(this.word, `${SIGNS[verdict.verdict]} ${verdict.verdict}`);
    this.write(this.peak, `body ${verdict.body_peak.toFixed(2)} g at its peak`);
    const search = verdict.searching ? "; looking for what would mend it…" : "";
    this.write(this.sentence, verdict.sentence + search);
    // The sentence has the first reason in it.
    this.reasons.replaceChildren(...verdict.reasons.slice(1).map((reason) => make("li", {}, reason)));
    const flight = verdict.flight > 0 ? `${verdict.flight.toFixed(2)} s without a foot down` : "always a foot down";
    this.write(this.facts, `At ${verdict.speed.toFixed(2)} m/s: ${flight}. Peak forces, in times the load of standing:`);
    if (creature?.feet.length === verdict.foot_peak.length) this.showFeet(creature.feet, verdict.foot_peak);
  }

  // A screen reader is told only what has changed.
  write(element, words) {
    if (element.textContent !== words) element.textContent = words;
  }

  showFeet(feet, peaks) {
    const short = shortNames(feet);
    this.feet.replaceChildren(...feet.map((foot, k) => {
      const fill = make("span", { class: "verdict-fill" });
      fill.style.width = `${Math.min(100 * peaks[k] / IMPOSSIBLE_LOAD, 100)}%`;
      fill.style.background = foot.colour;
      const bar = make("span", { class: "verdict-bar" }, fill);
      const value = make("span", { class: "verdict-value" }, peaks[k].toFixed(2));
      if (peaks[k] > IMPOSSIBLE_LOAD) value.classList.add("implausible");
      else if (peaks[k] > HARD_LOAD) value.classList.add("hard");
      return make("div", { role: "listitem" }, make("span", { class: "verdict-foot", title: foot.name }, short[k]), bar, value);
    }));
  }
}
