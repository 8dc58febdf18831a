// To come.

export function mountBody(element, store) {}
