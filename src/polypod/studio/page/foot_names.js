// Feet's names where there is little room: without what all of them share, and without the numbers
// that exporters put behind joints.

const NUMBER = /[_.\- ]\d+$/;
const SHORTEST = 3; // letters
const SEPARATED = /[_.\- :|]$/;

// "LeftLeg1Foot", "RightLeg1Foot" are shown as "LeftLeg1", "RightLeg1"; "b_LeftHand_011" and
// "b_RightHand_08" as "LeftHand", "RightHand".
export function shortNames(feet) {
  let names = feet.map(({ name }) => name);
  if (names.length < 2) return names;
  for (const shorten of [withoutNumbers, withoutEnding, withoutBeginning]) {
    const shorter = shorten(names);
    // Names are to tell feet apart, and to be words.
    const apart = new Set(shorter).size === new Set(names).size;
    if (apart && shorter.every((name) => name.length >= SHORTEST)) names = shorter;
  }
  return names;
}

function withoutNumbers(names) {
  return names.every((name) => NUMBER.test(name)) ? names.map((name) => name.replace(NUMBER, "")) : names;
}

function withoutEnding(names) {
  let shared = sharedBy(names, (name, i) => name.at(-1 - i));
  // Whole words only: from a capital or a separator on.
  while (shared > 0 && !/^[A-Z_.\- ]/.test(names[0].slice(names[0].length - shared))) shared -= 1;
  return names.map((name) => name.slice(0, name.length - shared));
}

function withoutBeginning(names) {
  let shared = sharedBy(names, (name, i) => name.at(i));
  while (shared > 0 && !SEPARATED.test(names[0].slice(0, shared))) shared -= 1;
  return names.map((name) => name.slice(shared));
}

// How many letters all names share, and leave one of the shortest.
function sharedBy(names, letter) {
  const least = Math.min(...names.map((name) => name.length));
  let shared = 0;
  while (shared + 1 < least && names.every((name) => letter(name, shared) === letter(names[0], shared))) shared += 1;
  return shared;
}
