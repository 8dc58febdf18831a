// Draws lanes of plots and footfalls against time on one canvas.

import { cut, palette, roundStep } from "/page/canvas.js";
import { foreToHind } from "/page/foot_order.js";
import { spanOf } from "/page/lanes.js";

export const GUTTER = 128; // px to the left, for names and figures
const AXIS = 15; // px below, for the time
const MARGIN = 3; // px above and below a lane
const FULL_LABEL = 30; // px of a lane from which its axis has numbers

// `view`: {feet, samples [{x: s, sample}], from, to (s shown), cursor (a sample, for the figures)}.
export function drawPlots({ context, width, height }, lanes, view) {
  const scale = { width, perSecond: (width - GUTTER) / Math.max(view.to - view.from, 1e-6) };
  scale.place = (second) => GUTTER + (second - view.from) * scale.perSecond;
  context.font = palette().font;
  drawAxis(context, scale, height, view);
  const tall = (height - AXIS) / Math.max(lanes.length, 1);
  lanes.forEach((lane, n) => {
    const box = { top: n * tall + MARGIN, height: tall - 2 * MARGIN };
    if (n > 0) {
      context.fillStyle = palette().line;
      context.fillRect(0, Math.round(n * tall), width, 1);
    }
    drawTitle(context, box, lane, view);
    context.save();
    context.beginPath();
    context.rect(GUTTER, box.top - MARGIN, width - GUTTER, tall);
    context.clip();
    if (lane.lines) drawLines(context, scale, box, lane, view);
    else drawStances(context, scale, box, view);
    context.restore();
  });
}

function drawAxis(context, scale, height, { from, to }) {
  const step = roundStep(to - from, Math.max((scale.width - GUTTER) / 90, 1));
  context.textAlign = "center";
  for (let n = Math.max(Math.ceil(from / step), 0); n * step <= to; n++) {
    const x = Math.round(scale.place(n * step));
    context.fillStyle = palette().line;
    context.fillRect(x, 0, 0.5, height - AXIS);
    context.fillStyle = palette().quiet;
    const room = Math.min(x, scale.width - 18);
    context.fillText(`${Number((n * step).toFixed(3))} s`, room, height - 3);
  }
}

function drawTitle(context, box, lane, { cursor }) {
  const { text, quiet } = palette();
  context.textAlign = "left";
  context.fillStyle = quiet;
  const figure = cursor && lane.now ? `${lane.now(cursor).toFixed(lane.digits)} ${lane.unit}` : "";
  const two = box.height >= FULL_LABEL;
  const room = GUTTER - 14 - (two ? 0 : context.measureText(figure).width);
  context.fillText(cut(context, lane.title, room), 8, box.top + (two ? 11 : box.height / 2 + 4));
  if (!figure) return;
  context.fillStyle = text;
  if (two) context.fillText(figure, 8, box.top + 25);
  else drawRight(context, figure, GUTTER - 4, box.top + box.height / 2 + 4);
}

function drawRight(context, words, x, y) {
  context.textAlign = "right";
  context.fillText(words, x, y);
  context.textAlign = "left";
}

function drawLines(context, scale, box, lane, { feet, samples }) {
  const lines = lane.lines(feet);
  const [least, most] = spanOf(lane, lines, samples.map(({ sample }) => sample));
  const rise = (value) => box.top + box.height * (1 - (value - least) / (most - least));
  if (lane.level && samples.length) {
    const { sample } = samples.at(-1);
    context.fillStyle = palette().quiet;
    for (let x = GUTTER; x < scale.width; x += 8) context.fillRect(x, rise(lane.level(sample)), 3, 0.8);
  }
  for (const { colour, of, strong } of lines) {
    context.strokeStyle = colour;
    context.lineWidth = strong ? 1.8 : 1;
    context.globalAlpha = strong || lines.every((line) => !line.strong) ? 1 : 0.75;
    context.beginPath();
    for (const { x, sample, gap } of samples) {
      if (gap) context.moveTo(scale.place(x), rise(of(sample)));
      else context.lineTo(scale.place(x), rise(of(sample)));
    }
    context.stroke();
  }
  context.globalAlpha = 1;
  if (box.height >= FULL_LABEL) drawSpan(context, box, lane, least, most);
}

// The lane's least and greatest value, at its left edge, over whatever passes there.
function drawSpan(context, box, lane, least, most) {
  for (const [value, bottom] of [[most, box.top + 8], [least, box.top + box.height]]) {
    const words = value.toFixed(lane.digits);
    context.fillStyle = palette().panel;
    context.fillRect(GUTTER + 1, bottom - 9, context.measureText(words).width + 4, 11);
    context.fillStyle = palette().quiet;
    context.fillText(words, GUTTER + 3, bottom);
  }
}

function drawStances(context, scale, box, { feet, samples }) {
  const row = box.height / Math.max(feet.length, 1);
  foreToHind(feet).forEach((k, n) => {
    context.fillStyle = feet[k].colour;
    let from = null;
    samples.forEach(({ x, sample, gap }, i) => {
      const next = samples[i + 1];
      if (gap) from = null;
      if (!sample.stance[k]) return;
      from ??= x;
      // A bar goes on as long as samples follow in which the foot stands.
      if (next && !next.gap && next.sample.stance[k]) return;
      const until = next && !next.gap ? next.x : x;
      const left = scale.place(from);
      context.fillRect(left, box.top + n * row, scale.place(until) - left, Math.max(row - 1.2, 0.8));
      from = null;
    });
  });
}
