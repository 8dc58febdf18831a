// To come.

export function mountFeet(element, store) {}
