// Small helpers to make elements: text goes in as text, never as markup.

const SVG = "http://www.w3.org/2000/svg";

// An SVG element with attributes.
export function svg(tag, attributes = {}, ...children) {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

// An HTML element with attributes; children are elements or texts.
export function html(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

// A button that says what it does.
export function button(text, act, attributes = {}) {
  const element = html("button", { type: "button", ...attributes }, text);
  element.addEventListener("click", act);
  return element;
}

// A switch: a button that is pressed or not, remembered under `kept` on this computer.
export function kept(text, name, first, changed, attributes = {}) {
  const stored = localStorage.getItem(name);
  const state = { on: stored === null ? first : stored === "true" };
  const element = button(text, () => {
    state.on = !state.on;
    localStorage.setItem(name, String(state.on));
    element.setAttribute("aria-pressed", String(state.on));
    changed(state.on);
  }, { "aria-pressed": String(state.on), ...attributes });
  return { element, get on() { return state.on; } };
}

// Take a panel's own style sheet in, once.
export function addStyle(name) {
  const href = `/page/${name}`;
  if (document.querySelector(`link[href="${href}"]`)) return;
  document.head.append(html("link", { rel: "stylesheet", href }));
}

// True where an element can be seen at all: what is hidden need not be drawn.
export function shown(element) {
  return !document.hidden && element.getClientRects().length > 0;
}
