// To come.

export function mountScene(element, store) {
  return {};
}
