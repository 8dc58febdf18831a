// To come.

export function mountGait(element, store) {}
