// To come.

export function mountRecord(element, store, scene) {}
