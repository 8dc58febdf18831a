// What the strip can plot, one lane above the other against time.

// `lines(feet)`: [{colour, of(sample), strong}], `floor`: a value that is always in sight.
// A lane without lines shows the feet's stances.
export const LANES = [
  { key: "footfalls", title: "Footfalls", about: "When each foot stands" },
  {
    key: "height", title: "Body height", unit: "m", digits: 3, level: (sample) => sample.level,
    now: (sample) => sample.height,
    lines: () => [{ colour: "#ffffff", of: (sample) => sample.height, strong: true }],
    about: "The body's height over the plane of its feet",
  },
  {
    // Apart from the body's own height, which is often a hundredth of theirs.
    key: "particles", title: "Particles", unit: "m", digits: 3, level: (sample) => sample.level,
    now: (sample) => sample.height,
    lines: (feet) => [
      ...feet.map(({ colour }, k) => ({ colour, of: (sample) => sample.level + sample.particle[k] })),
      { colour: "#ffffff", of: (sample) => sample.height, strong: true },
    ],
    about: "The height to which each foot would move the body if it were alone, and the body's own, in white",
  },
  {
    key: "feet", title: "Foot heights", unit: "m", digits: 3, floor: 0,
    now: (sample) => Math.max(...sample.foot),
    lines: (feet) => feet.map(({ colour }, k) => ({ colour, of: (sample) => sample.foot[k] })),
    about: "Each sole's height over the plane of the feet; the number is the highest foot's",
  },
  {
    key: "force", title: "Force", unit: "g", digits: 2, floor: 0, level: () => 1,
    now: (sample) => sample.force,
    lines: (feet) => [
      ...feet.map(({ colour }, k) => ({ colour, of: (sample) => sample.load[k] })),
      { colour: "#ffffff", of: (sample) => sample.force, strong: true },
    ],
    about: "The force with which the feet push the body, in white, and with which each pushes its own particle",
  },
  {
    key: "speed", title: "Speed", unit: "m/s", digits: 2, floor: 0,
    now: (sample) => sample.speed,
    lines: () => [{ colour: "#ffffff", of: (sample) => sample.speed, strong: true }],
    about: "The speed along the way",
  },
];

// The least and greatest of a lane's lines, a little apart so that a still body is a calm line.
export function spanOf(lane, lines, samples) {
  let least = lane.floor ?? Infinity;
  let most = lane.floor ?? -Infinity;
  for (const sample of samples) {
    for (const { of } of lines) {
      const value = of(sample);
      if (value < least) least = value;
      if (value > most) most = value;
    }
  }
  if (!(least <= most)) return [0, 1];
  const room = Math.max((most - least) * 0.08, Math.abs(most) * 0.01, 1e-4);
  return [least === lane.floor ? least : least - room, most + room];
}
