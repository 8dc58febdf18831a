// In which order feet are listed everywhere: fore above hind, left before right.

// `feet`: what has `row`, counted forward from the hindmost, and `side`, 1 on the left; returned are
// their indices.
export function foreToHind(feet) {
  return feet.map((_, k) => k).sort((a, b) => feet[b].row - feet[a].row || feet[b].side - feet[a].side);
}
