// To come.

export function mountStrip(element, store) {}
