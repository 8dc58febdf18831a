// Where feet are to stand (P1 Figure 6): places in the body's frame, left and forward, and from the
// world to it.

import { partnerOf } from "/page/disks.js";

// A foot's shift from its rest place as the document has it.
export function shiftOf(store, k) {
  return store.wanted?.spacing?.[k] ?? [0, 0];
}

// [left, forward] of the place a foot prefers at standstill, m: rest, stance width and shift.
export function placeOf(store, k) {
  const [left, forward] = shiftOf(store, k);
  const [restLeft, restForward] = restOf(store, k);
  return [restLeft + left, restForward + forward];
}

// The same without the shift, where a reset puts it.
export function restOf(store, k) {
  const [left, forward] = store.creature.feet[k].rest;
  return [left * (store.wanted?.command.stance_width ?? 1), forward];
}

// Turns places of the world into [left, forward] of the creature in focus, m.
export function viewFrom(frame) {
  const { focus, herds } = frame;
  const body = herds[focus.kind].body;
  const at = 7 * focus.creature + 4;
  const [x, z] = [body[at], body[at + 2]];
  const [sine, cosine] = [Math.sin(focus.heading), Math.cos(focus.heading)];
  return (placeX, placeZ) => {
    const [dx, dz] = [placeX - x, placeZ - z];
    return [dx * cosine - dz * sine, dx * sine + dz * cosine];
  };
}

// Where joint j of the creature in focus is, [x, z] in the world, m: rest is in the body's frame.
export function jointPlace(frame, rest, j) {
  const herd = frame.herds[frame.focus.kind];
  const at = 7 * (frame.focus.creature * herd.joints + j);
  const [qx, qy, qz, qw] = herd.pose.subarray(at, at + 4);
  const [x, y, z] = rest;
  // q v q*, by v + 2 w (u x v) + 2 u x (u x v).
  const [cx, cy, cz] = [qy * z - qz * y, qz * x - qx * z, qx * y - qy * x];
  return [
    x + 2 * (qw * cx + qy * cz - qz * cy) + herd.pose[at + 4],
    z + 2 * (qw * cz + qx * cy - qy * cx) + herd.pose[at + 6],
  ];
}

// All shifts with foot k's changed by [left, forward], and its partner's mirrored where asked.
export function shiftedSpacing(store, begun, k, [left, forward], symmetric) {
  const spacing = begun.map((shift) => [...shift]);
  const { feet } = store.creature;
  const partner = symmetric ? partnerOf(feet, k) : -1;
  // A foot in the middle stays there.
  const aside = symmetric && feet[k].side === 0 ? 0 : left;
  spacing[k] = rounded(begun[k][0] + aside, begun[k][1] + forward);
  if (partner >= 0) spacing[partner] = rounded(begun[partner][0] - left, begun[partner][1] + forward);
  return spacing;
}

function rounded(left, forward) {
  const digits = 1e5; // a hundredth of a millimetre
  return [Math.round(left * digits) / digits, Math.round(forward * digits) / digits];
}
