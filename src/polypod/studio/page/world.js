// To come.

export function mountWorld(element, store, scene) {}
