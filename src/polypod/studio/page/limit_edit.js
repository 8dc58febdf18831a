// Joint limits as the document has them, and what an edit makes of them.

import { partnerOf } from "/page/disks.js";
import { Gesture } from "/page/gesture.js";

const AT = ["creature", "limit"];
const EQUAL = 1e-6; // rad: what is so near to the default is the default
const PAUSE = 900; // ms between two key strokes that are still one gesture
// What a joint is left at least: a leg's must turn, and from less to more.
const LEAST_LEG = Math.PI / 180;

export class LimitEditor {
  // `mirror` is the switch that says whether the joint of the leg on the other side goes along.
  constructor(store, mirror) {
    Object.assign(this, { store, mirror });
    this.gesture = new Gesture(store);
    this.begun = {};
    this.stroked = null; // what keys are moving, and since when
  }

  // All limits that are said now: by what was asked for, else by the creature's file.
  said() {
    return this.store.wanted.creature.limit ?? this.store.creature.file_limit;
  }

  // The same joint of the leg on the other side, or null.
  partner(joint) {
    const { feet, limits } = this.store.creature;
    const leg = joint.leg >= 0 ? partnerOf(feet, joint.leg) : -1;
    const same = (one) => one.leg === leg && one.index === joint.index && one.kind === joint.kind;
    return leg < 0 ? null : limits.find(same) ?? null;
  }

  // The joints that an edit of one changes.
  together(joint) {
    const partner = this.mirror.on ? this.partner(joint) : null;
    return partner ? [joint, partner] : [joint];
  }

  begin() {
    this.gesture.begin();
    this.stroked = null;
    this.begun = structuredClone(this.said());
  }

  // Let a joint turn from `least` to `most` in one of its ways, since `begin`.
  limit(joint, key, range) {
    const wanted = structuredClone(this.begun);
    for (const one of this.together(joint)) put(wanted, one, key, range);
    this.write(wanted);
  }

  // A number that was typed, or a default that was asked for.
  put(joint, key, range) {
    this.begin();
    this.limit(joint, key, range);
  }

  // A stroke of a key on a handle: strokes in a row are one gesture.
  stroke(joint, key, end, range) {
    const now = performance.now();
    const handle = `${joint.name} ${key} ${end}`;
    if (this.stroked?.handle !== handle || now - this.stroked.at > PAUSE) this.begin();
    this.stroked = { handle, at: now };
    this.limit(joint, key, range);
  }

  // Everything back to what the rig's own file says.
  reset() {
    this.begin();
    this.gesture.edit(AT, null);
  }

  write(wanted) {
    const none = (map) => Object.keys(map).length === 0;
    this.gesture.edit(AT, none(wanted) && none(this.store.creature.file_limit) ? null : wanted);
  }
}

function put(wanted, { name, node, turns }, key, [least, most]) {
  const turn = turns.find((one) => one.key === key);
  if (!turn) return;
  const entry = { ...(wanted[name] ?? wanted[`#${node}`]) };
  delete wanted[`#${node}`];
  const near = (a, b) => Math.abs(a - b) < EQUAL;
  if (near(least, turn.default[0]) && near(most, turn.default[1])) delete entry[key];
  else entry[key] = key === "bend" ? [least, most] : most;
  if (Object.keys(entry).length) wanted[name] = entry;
  else delete wanted[name];
}

// The range after one of its ends was moved to an angle: a bend's ends move alone, others alike.
export function movedEnd(joint, { key, least, most }, end, angle) {
  if (key === "bend") {
    return end === "least"
      ? [clamped(angle, -Math.PI, most - LEAST_LEG), most]
      : [least, clamped(angle, least + LEAST_LEG, Math.PI)];
  }
  const size = clamped(end === "least" ? -angle : angle, joint.leg >= 0 ? LEAST_LEG : 0, Math.PI);
  return [-size, size];
}

function clamped(value, least, most) {
  return Math.min(Math.max(value, least), most);
}
