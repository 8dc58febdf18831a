// Feet's names where there is little room: without the ending that all of them share.

// "LeftLeg1Foot", "RightLeg1Foot" are shown as "LeftLeg1", "RightLeg1".
export function shortNames(feet) {
  const names = feet.map(({ name }) => name);
  if (names.length < 2) return names;
  let shared = 0;
  while (names.every((name) => shared + 1 < name.length && name.at(-1 - shared) === names[0].at(-1 - shared))) {
    shared += 1;
  }
  // Whole words only: from a capital or a separator on.
  while (shared > 0 && !/^[A-Z_.\- ]/.test(names[0].slice(names[0].length - shared))) shared -= 1;
  return names.map((name) => name.slice(0, name.length - shared));
}
