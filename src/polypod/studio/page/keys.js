// Keys that hold everywhere, and the dialog that lists them.

import { addStyle, make, makeButton } from "/page/elements.js";
import { Gesture } from "/page/gesture.js";
import { toggleRecord } from "/page/record.js";
import { speedBy, turnBy } from "/page/steer.js";

const TURN = (10 * Math.PI) / 180;
const FASTER = 0.1; // of the range of speeds

// What is typed into keeps its keys; what is moved with arrow keys keeps those.
const TYPED = "input:not([type=range], [type=checkbox], [type=radio]), textarea, select, [contenteditable]";
const MOVED = "input, [role=slider], [role=tab], [role=treeitem], [role=menuitem], [role=menuitemcheckbox], [role=option], [role=listbox], [role=menu]";
const PRESSED = "button, summary, a[href], input[type=checkbox], input[type=radio], [role=button], [role=treeitem], [role^=menuitem]";

const HELP = [
  ["Space", "play and pause"],
  [".", "one step on, while paused"],
  ["← →", "turn by 10°"],
  ["↑ ↓", "faster and slower by a tenth"],
  ["F", "the creature fills the view"],
  ["R", "start and stop the record"],
  ["Ctrl Z", "undo"],
  ["Ctrl Shift Z, Ctrl Y", "redo"],
  ["Delete", "delete the chosen obstacle"],
  ["Escape", "give up what is being picked or drawn"],
  ["?", "this list"],
];

// `bar`: where the button is that shows the list.
export function bindKeys(store, scene, bar) {
  addStyle("panels.css");
  const dialog = helpDialog();
  document.body.append(dialog);
  bar.append(makeButton("?", () => dialog.showModal(), { "aria-label": "Keys", title: "Keys (?)" }));
  const pointed = watchPointer();
  const gesture = new Gesture(store);
  const order = (message) => store.send(message).catch((refusal) => store.say(refusal.message));
  const ready = (act) => () => { if (store.document && store.creature) act(); };
  const actions = {
    " ": () => order({ do: "clock", playing: !store.playing }),
    ".": () => order({ do: "clock", playing: false, steps: 1 }),
    f: () => scene.frame(),
    r: () => toggleRecord(store),
    "?": () => dialog.showModal(),
    ArrowLeft: ready(() => turnBy(store, gesture, TURN)),
    ArrowRight: ready(() => turnBy(store, gesture, -TURN)),
    ArrowUp: ready(() => speedBy(store, gesture, FASTER)),
    ArrowDown: ready(() => speedBy(store, gesture, -FASTER)),
  };
  window.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || dialog.open || event.target.closest?.(TYPED)) return;
    const action = withControl(event, order) ?? plain(event, actions, pointed);
    if (!action) return;
    event.preventDefault();
    // Space held down is one press; arrows held down go on.
    if (!event.repeat || event.key.startsWith("Arrow")) action();
  });
  // A button that the pointer has left in focus would be pressed by the space bar's release.
  window.addEventListener("keyup", (event) => {
    if (event.key === " " && pointed() && event.target.closest?.(PRESSED)) event.preventDefault();
  });
}

function withControl(event, order) {
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return null;
  const key = event.key.toLowerCase();
  if (key === "z") return () => order({ do: event.shiftKey ? "redo" : "undo" });
  return key === "y" ? () => order({ do: "redo" }) : null;
}

function plain(event, actions, pointed) {
  if (event.ctrlKey || event.metaKey || event.altKey) return null;
  const arrow = event.key.startsWith("Arrow");
  if (arrow && (event.shiftKey || event.target.closest?.(MOVED))) return null;
  // Who came to a button by keys presses it with the space bar; who clicked it means the walk.
  if (event.key === " " && !pointed() && event.target.closest?.(PRESSED)) return null;
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  return actions[key] ?? null;
}

// Whether what has the focus got it by the pointer.
function watchPointer() {
  let byPointer = false;
  let pressed = false;
  window.addEventListener("pointerdown", () => { pressed = true; }, true);
  window.addEventListener("keydown", () => { pressed = false; }, true);
  window.addEventListener("focusin", () => { byPointer = pressed; }, true);
  return () => byPointer;
}

function helpDialog() {
  const rows = HELP.map(([keys, words]) => make("tr", {}, make("th", { scope: "row" }, keys), make("td", {}, words)));
  const dialog = make(
    "dialog", { class: "help", "aria-label": "Keys" },
    make("h2", {}, "Keys"), make("table", {}, make("tbody", {}, ...rows)),
    make("p", { class: "quiet" }, "They do nothing while you type into a box."),
  );
  dialog.append(makeButton("Close", () => dialog.close(), { autofocus: true }));
  return dialog;
}
