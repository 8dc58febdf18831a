// How a number of the document is shown: radians as degrees, lengths of small creatures in mm,
// shares of the cycle in per cent.

const SMALL = 0.1; // m; what never exceeds it is shown in mm

// {factor, unit, decimals} for a range {most, step, unit} as the server gives it.
export function shownAs({ least = 0, most, step, unit }) {
  const wide = Math.max(Math.abs(least), Math.abs(most));
  let factor = 1;
  let name = unit;
  if (unit === "rad" || unit === "rad/s") {
    factor = 180 / Math.PI;
    name = unit === "rad" ? "°" : "°/s";
  } else if ((unit === "m" || unit === "m/s") && wide < SMALL) {
    factor = 1000;
    name = `m${unit}`;
  } else if (unit === "of the cycle") {
    factor = 100;
    name = "%";
  }
  if (unit === "times") name = "×";
  return { factor, unit: name, decimals: decimalsOf(step * factor) };
}

// As many decimals as a step needs to be seen.
export function decimalsOf(step) {
  if (!(step > 0)) return 3;
  return Math.min(6, Math.max(0, Math.ceil(-Math.log10(step) - 1e-9)));
}

export function withUnit(text, unit) {
  if (!unit) return text;
  return unit.startsWith("°") ? text + unit : `${text} ${unit}`;
}

// An angle from -pi (exclusive) to pi.
export function wrapped(angle) {
  const turn = 2 * Math.PI;
  const part = ((angle % turn) + turn) % turn;
  return part > Math.PI ? part - turn : part;
}
