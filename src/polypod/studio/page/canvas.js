// A canvas as sharp as the screen, and colours out of the style sheet.

import { whenShown } from "/page/switches.js";

// Fit a canvas to its place on the page; returns a context in CSS pixels, with its size.
export function fit(canvas) {
  const width = Math.max(Math.floor(canvas.clientWidth), 1);
  const height = Math.max(Math.floor(canvas.clientHeight), 1);
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  if (canvas.width !== width * ratio || canvas.height !== height * ratio) {
    canvas.width = width * ratio;
    canvas.height = height * ratio;
  }
  // Drawn by the processor: a few lines and words are no work for a GPU, and where there is none the
  // browser would have to act one, which takes longer than the whole scene.
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return { context, width, height };
}

let colours = null;

export function palette() {
  if (!colours) {
    const style = getComputedStyle(document.documentElement);
    const of = (name) => style.getPropertyValue(name).trim();
    colours = {
      text: of("--text"), quiet: of("--quiet"), line: of("--line"), raised: of("--raised"),
      accent: of("--accent"), ground: of("--ground"), panel: of("--panel"),
      font: "11px system-ui, 'DejaVu Sans', sans-serif",
    };
  }
  return colours;
}

// How often a second anything on the page is redrawn at most: seldom where pictures come slowly, for
// then each takes from the scene what it takes.
export const pace = { most: 60 };

// Call `draw` at most `rate` times a second, and only while something new has come.
export function redraw(rate, draw) {
  let due = false;
  let timer = 0;
  let last = -Infinity;
  const go = (now) => {
    timer = 0;
    if (now - last < 990 / Math.min(rate, pace.most)) {
      timer = requestAnimationFrame(go);
      return;
    }
    last = now;
    if (due) draw();
    due = false;
  };
  const ask = () => {
    due = true;
    if (!timer) timer = requestAnimationFrame(go);
  };
  // What was drawn while nobody saw it may have been left out.
  whenShown(() => { if (last > -Infinity) ask(); });
  return ask;
}

// A text cut to a width, with dots.
export function cut(context, text, width) {
  if (context.measureText(text).width <= width) return text;
  let kept = text;
  while (kept.length > 1 && context.measureText(`${kept}…`).width > width) kept = kept.slice(0, -1);
  return `${kept}…`;
}

// A round step for an axis so that about `count` of them fit into a span.
export function roundStep(span, count) {
  const raw = span / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find((n) => n * power >= raw);
  return step * power;
}
