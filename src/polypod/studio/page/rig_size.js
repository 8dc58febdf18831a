// How large a rig is and where its front is: what files say least reliably.

import { fillChoice, make, makeButton, makeChoice } from "/page/elements.js";
import { NumberBox } from "/page/number_box.js";

// What one unit of the file may be, m.
const UNITS = [["1", "metres"], ["0.01", "centimetres"], ["0.001", "millimetres"], ["0.0254", "inches"], ["0.3048", "feet"]];
const FRONTS = [["", "as found"], ["+z", "+z"], ["-z", "−z"], ["+x", "+x"], ["-x", "−x"]];

export class RigSize {
  // `changed` is called when something else is asked of the rig.
  constructor(changed) {
    this.changed = changed;
    this.height = new NumberBox({
      label: "Height", unit: "m", decimals: 4, words: "by file",
      read: () => this.draft?.asked.height ?? this.draft?.answer?.height ?? null,
      write: (height) => this.ask("height", height),
    });
    this.reset = makeButton("↺", () => this.ask("height", null), {
      class: "reset", title: "Default: the file's units are metres",
      "aria-label": "Height: back to default, the file's units are metres",
    });
    this.unit = makeChoice("The file's unit", (unit) => { if (unit) this.takeUnit(Number(unit)); });
    this.front = makeChoice("Front", (front) => this.ask("forward", front || null));
    this.element = make(
      "div", {},
      line("Height", this.height.element, this.reset),
      line("File's unit", this.unit), line("Front", this.front),
    );
  }

  ask(key, value) {
    this.draft.asked[key] = value;
    this.changed();
  }

  // One unit of the file is so many metres.
  takeUnit(unit) {
    this.ask("height", unit === 1 ? null : Number((this.draft.fileHeight * unit).toPrecision(6)));
  }

  show(draft) {
    this.draft = draft;
    this.height.refresh();
    this.reset.disabled = draft.asked.height === null;
    this.unit.disabled = draft.fileHeight === null;
    fillChoice(this.unit, [...UNITS, ["", "by height"]], this.unitOf(draft));
    fillChoice(this.front, frontsOf(draft), draft.asked.forward ?? "");
  }

  unitOf({ asked, fileHeight }) {
    if (asked.height === null) return "1";
    const near = ([unit]) => Math.abs(asked.height / (fileHeight * unit) - 1) < 1e-4;
    return fileHeight ? UNITS.find(near)?.[0] ?? "" : "";
  }
}

function frontsOf({ asked, answer }) {
  const found = asked.forward === null && answer?.forward;
  return found ? [["", `as found, ${found.replace("-", "−")}`], ...FRONTS.slice(1)] : FRONTS;
}

function line(words, ...children) {
  return make("div", { class: "row" }, make("span", { class: "form-label wide" }, words), ...children);
}
