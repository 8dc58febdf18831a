// Elements made by hand. What files say becomes text, never markup.

const SVG = "http://www.w3.org/2000/svg";

// An element with attributes (null and false: left out) and children; strings become text.
export function make(tag, attributes = {}, ...children) {
  return filled(document.createElement(tag), attributes, children);
}

export function makeSvg(tag, attributes = {}, ...children) {
  return filled(document.createElementNS(SVG, tag), attributes, children);
}

function filled(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== null && value !== false) node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children);
  return node;
}

export function makeButton(text, press, attributes = {}) {
  const button = make("button", { type: "button", ...attributes }, text);
  button.addEventListener("click", press);
  return button;
}

// A part of a panel, which folds; its content is the element's.
export function makeSection(title, ...children) {
  const heading = make("summary", {}, make("h2", {}, title));
  return make("details", { open: true, class: "section" }, heading, ...children);
}

// A box to tick, with its words. `change` hears whether it is ticked.
export function makeTick(words, change) {
  const box = make("input", { type: "checkbox" });
  box.addEventListener("change", () => change(box.checked));
  return { element: make("label", { class: "tick" }, box, words), box };
}

// A list to choose from; `choose` hears the value. Fill it with `fillChoice`.
export function makeChoice(label, choose) {
  const list = make("select", { "aria-label": label });
  list.addEventListener("change", () => choose(list.value));
  return list;
}

// Options are [value, words]; what is chosen stays chosen. Untouched where nothing changes, so that
// an open list does not close.
export function fillChoice(list, options, chosen) {
  const wanted = JSON.stringify(options);
  if (list.dataset.options !== wanted) {
    list.dataset.options = wanted;
    list.replaceChildren(...options.map(([value, words]) => make("option", { value }, words)));
  }
  list.value = chosen;
}

export function addStyle(name) {
  const href = `/page/${name}`;
  if (document.querySelector(`link[href="${href}"]`)) return;
  document.head.append(make("link", { rel: "stylesheet", href }));
}

// Save bytes as a file of the user's.
export function saveAs(blob, name) {
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  // The browser reads the address after the click has returned.
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}
