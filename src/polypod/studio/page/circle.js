// How far round the wheels are shown from where the server has them. When a creature changes between
// two gaits of the library its whole circle, needle and disks together, is turned to where the two
// are nearest: phases mean something only against each other, and no foot's step changes by it.
// Shown as it is that would be a jump of everything; so the wheels stay, and turn there slowly.

import { shortWay } from "/page/disks.js";

const LEAST = 0.012; // of the cycle: the server turns by 1/64 at least; less is the tempo's change
const LONGEST_GAP = 0.25; // s between two frames: beyond, nothing is continuous
const EASE = 700; // ms in which what is left of the way falls to a third

export class Circle {
  constructor(store) {
    this.left = 0; // of the cycle, at the time `since`
    this.since = 0;
    this.before = null;
    store.on("frame", (frame) => this.take(frame));
  }

  take(frame) {
    const { before } = this;
    this.before = frame;
    if (!before || !continues(before, frame)) {
      this.left = 0;
      return;
    }
    const elapsed = frame.time - before.time;
    const went = 0.5 * (before.focus.cycleRate + frame.focus.cycleRate) * elapsed;
    const turned = shortWay(frame.focus.needle - before.focus.needle - went);
    if (Math.abs(turned) < LEAST) return;
    const now = performance.now();
    this.left = shortWay(this.turn(now) - turned);
    this.since = now;
  }

  // How much farther round than they are wheels are shown, cycles.
  turn(now = performance.now()) {
    return this.left * Math.exp((this.since - now) / EASE);
  }
}

function continues(before, frame) {
  const [one, other] = [before.focus, frame.focus];
  if (one.kind !== other.kind || one.creature !== other.creature) return false;
  if ((before.tapeFrame === null) !== (frame.tapeFrame === null)) return false;
  return frame.time >= before.time && frame.time - before.time < LONGEST_GAP;
}
