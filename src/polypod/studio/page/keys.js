// To come.

export function bindKeys(store, scene) {}
