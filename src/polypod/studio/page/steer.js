// Asking for a direction or a speed, from the pad and from the keys.

import { wrapped } from "/page/units.js";

// The direction asked for (rad about +Y from +Z toward +X), where nothing leads along a path; else
// the one in which the creature walks.
export function headingOf(store) {
  const { path, command } = store.wanted;
  return wrapped(path.length && store.frame ? store.frame.focus.heading : command.heading);
}

// Walk in a direction. A path leads elsewhere, so it goes.
export function headFor(store, gesture, heading) {
  gesture.edit(["command", "heading"], wrapped(heading));
  if (store.wanted.path.length) gesture.edit(["path"], []);
}

// Turn on from what was last asked for by an angle, rad.
export function turnBy(store, gesture, angle) {
  gesture.continue();
  headFor(store, gesture, headingOf(store) + angle);
}

// Walk faster or slower by a share of the range of speeds.
export function speedBy(store, gesture, share) {
  const { least, most, default: usual } = store.creature.ranges.speed;
  gesture.continue();
  const speed = store.wanted.command.speed ?? usual;
  gesture.edit(["command", "speed"], Math.min(most, Math.max(least, speed + share * (most - least))));
}

// "30° to the left", as one would say a direction.
export function spokenDirection(heading) {
  const degrees = Math.round((wrapped(heading) * 180) / Math.PI);
  if (degrees === 0) return "ahead, +z";
  return `${Math.abs(degrees)}° to the ${degrees > 0 ? "left" : "right"} of +z`;
}
