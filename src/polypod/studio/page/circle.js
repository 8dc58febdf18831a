// Where the wheels are shown while they catch up with where the server has them.
//
// When a creature changes between two gaits of the library its whole circle, needle and disks
// together, is turned to where the two are nearest: phases mean something only against each other,
// and no foot's step changes by it. And a foot in the air goes by the disk that it left the ground
// with, and takes the new one when it lands. Shown as they are both would be jumps; so what is shown
// stays where it is and goes there within a moment.

import { shortWay, wrap } from "/page/disks.js";

const LEAST = 0.012; // of the cycle; less is no jump. The server turns the circle by 1/64 at least
const LONGEST_GAP = 0.25; // s between two frames: beyond, nothing is continuous
// Times in which what is left of the way falls to a third, ms.
const CIRCLE_TIME = 700;
const DISK_TIME = 150;

// A way that is still to go, in cycles.
class Way {
  constructor(time) {
    Object.assign(this, { time, left: 0, since: 0 });
  }

  get now() {
    return this.left === 0 ? 0 : this.left * Math.exp((this.since - performance.now()) / this.time);
  }

  // Stay where it is though it has moved by so much.
  stay(moved) {
    if (Math.abs(moved) < LEAST) return;
    this.left = shortWay(this.now - moved);
    this.since = performance.now();
  }
}

export class Circle {
  constructor(store) {
    this.before = null;
    this.forget(0);
    store.on("frame", (frame) => this.take(frame));
  }

  forget(feet) {
    this.whole = new Way(CIRCLE_TIME);
    this.disks = Array.from({ length: feet }, () => ({ start: new Way(DISK_TIME), extent: new Way(DISK_TIME) }));
  }

  take(frame) {
    const { before } = this;
    this.before = frame;
    const { feet, needle, cycleRate } = frame.focus;
    if (!before || !continues(before, frame)) {
      this.forget(feet.length);
      return;
    }
    const went = 0.5 * (before.focus.cycleRate + cycleRate) * (frame.time - before.time);
    const turned = shortWay(needle - before.focus.needle - went);
    this.whole.stay(turned);
    // What the circle takes along is no way of a disk's own.
    const along = Math.abs(turned) < LEAST ? 0 : turned;
    feet.forEach(({ start, extent }, k) => {
      const was = before.focus.feet[k];
      this.disks[k].start.stay(shortWay(start - was.start - along));
      this.disks[k].extent.stay(extent - was.extent);
    });
  }

  // How much farther round than it is the whole circle is shown, cycles.
  get turn() {
    return this.whole.now;
  }

  // Where foot k's disk is shown.
  shown(k, { start, extent }) {
    const { start: way, extent: growth } = this.disks[k];
    const size = extent + growth.now;
    return { start: wrap(start + this.turn + way.now), extent: Math.min(Math.max(size, 0), 1) };
  }
}

function continues(before, frame) {
  const [one, other] = [before.focus, frame.focus];
  if (one.kind !== other.kind || one.creature !== other.creature) return false;
  if (one.feet.length !== other.feet.length) return false;
  if ((before.tapeFrame === null) !== (frame.tapeFrame === null)) return false;
  return frame.time >= before.time && frame.time - before.time < LONGEST_GAP;
}
