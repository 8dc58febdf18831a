// To come.

export function mountRig(element, store, scene) {}
