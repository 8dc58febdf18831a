// A gait as disks, and what dragging does to them. Phases are fractions of the cycle; a foot swings
// from `start` for `extent`, lands, and stands for the rest.

export const SNAPS = 24; // places to which a phase snaps
const SHORTEST = 0.02; // of the cycle, of a swing and of a stance
const DIGITS = 1e6;

export function wrap(phase) {
  const inside = phase - Math.floor(phase);
  return inside < 1 ? inside : 0;
}

// The short way round from 0 to a phase, -0.5 to 0.5.
export function shortWay(phase) {
  return wrap(phase + 0.5) - 0.5;
}

// A phase to write down: free of the last digits of sums and of 4-byte floats.
export function rounded(phase) {
  return wrap(Math.round(wrap(phase) * DIGITS) / DIGITS);
}

// The foot on the other side of the same row, or -1.
export function partnerOf(feet, k) {
  const { side, row } = feet[k];
  return feet.findIndex((foot) => side !== 0 && foot.side === -side && foot.row === row);
}

// The phases at which other feet than those left out lift or land: [{phase, foot}].
export function eventsOf(disks, leftOut) {
  const events = [];
  disks.start.forEach((start, foot) => {
    if (leftOut.includes(foot)) return;
    events.push({ phase: start, foot }, { phase: wrap(start + disks.extent[foot]), foot });
  });
  return events;
}

// By how much a handle really moves that was dragged by `delta`: on to the nearest place of the
// grid or event of another foot.
export function snappedShift(disk, part, delta, events) {
  const gripped = part === "finish" ? disk.start + disk.extent : disk.start;
  const raw = gripped + delta;
  let best = Math.round(raw * SNAPS) / SNAPS - raw;
  const nearer = (correction) => {
    if (Math.abs(correction) < Math.abs(best)) best = correction;
  };
  for (const { phase } of events) {
    nearer(shortWay(phase - raw));
    if (part === "whole") nearer(shortWay(phase - raw - disk.extent));
  }
  return delta + best;
}

// One disk with its start, finish or whole sector moved by `delta` cycles.
export function shiftedDisk({ start, extent }, part, delta) {
  if (part === "whole") return { start: rounded(start + delta), extent };
  const wanted = part === "start" ? extent - delta : extent + delta;
  const inside = Math.min(Math.max(wanted, SHORTEST), 1 - SHORTEST);
  const kept = Math.round(inside * DIGITS) / DIGITS;
  return { start: part === "start" ? rounded(start + extent - kept) : rounded(start), extent: kept };
}

// All disks with the foot's changed, and its partner's alike where `partner` is one: their distance
// on the circle, mostly half a cycle, stays as it was.
export function shiftedDisks(disks, k, part, delta, partner = -1) {
  const start = disks.start.map(rounded);
  const extent = disks.extent.map((share) => Math.round(share * DIGITS) / DIGITS);
  for (const foot of partner < 0 ? [k] : [k, partner]) {
    const disk = { start: disks.start[foot], extent: disks.extent[foot] };
    const moved = shiftedDisk(disk, part, delta);
    start[foot] = moved.start;
    extent[foot] = moved.extent;
  }
  return { start, extent };
}

// The disks to edit: those drawn by hand, or else those in use, for the duty of the library's gaits
// follows the speed. Null while neither is known.
export function disksOf(store) {
  const asked = store.wanted?.gait;
  if (isDrawn(store)) return { start: asked.start, extent: asked.extent };
  return disksInUse(store);
}

// Whether the gait asked for was drawn by hand.
export function isDrawn(store) {
  const asked = store.wanted?.gait;
  return Boolean(asked?.start && store.creature && !store.creature.gaits.includes(asked.name));
}

export function disksInUse(store) {
  const feet = store.frame?.focus.feet;
  if (!feet || feet.length !== store.creature?.feet.length) return null;
  return { start: feet.map((foot) => foot.start), extent: feet.map((foot) => foot.extent) };
}

// Where the needle is now: it turns on between two frames.
export function needleNow(store) {
  const { frame, clock } = store;
  if (!frame) return 0;
  const turns = clock.playing && frame.tapeFrame === null;
  const since = turns ? Math.min((performance.now() - frame.received) / 1000, 0.25) : 0;
  return wrap(frame.focus.needle + frame.focus.cycleRate * since * clock.rate * clock.behind);
}

export function percent(share) {
  return `${(100 * share).toFixed(1).replace(/\.0$/, "")} %`;
}
