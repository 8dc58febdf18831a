// To come.

export function mountBar(element, store, scene) {}
