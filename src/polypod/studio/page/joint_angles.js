// How a joint is turned in a frame, by the keys of its limits, radians; see `limits` of the creature
// in docs/studio-protocol.md. Rotations are away from the rest, so what two joints share cancels.

// Angles of a joint that turns, in the order of its `turns`; null where the frame does not have it.
export function anglesOf(frame, limit) {
  const herd = frame?.herds[0];
  const row = frame?.focus.kind === 0 ? frame.focus.creature : 0;
  const moves = limit.moves ?? limit.joint;
  if (!herd || row >= herd.count || Math.max(moves, limit.of) >= herd.joints) return null;
  const turn = product(conjugate(rotation(herd, row, limit.of)), rotation(herd, row, moves));
  if (limit.kind === "hinge") return [wrapped(2 * Math.atan2(dot(turn, limit.axis), turn[3]))];
  return limit.kind === "hip" ? hipAngles(turn, limit) : spineAngles(turn);
}

function rotation(herd, creature, joint) {
  const at = 7 * (creature * herd.joints + joint);
  return herd.pose.subarray(at, at + 4);
}

// Flexion, sideways swing and twist away from the stance: the twist is the turn about the limb
// that comes before the swing.
function hipAngles(turn, { stance, limb, flexion }) {
  let away = product(turn, conjugate(stance));
  if (away[3] < 0) away = away.map((part) => -part);
  const along = dot(away, limb);
  const size = Math.hypot(along, away[3]);
  const twist = size > 1e-9 ? [...limb.map((part) => (part * along) / size), away[3] / size] : [0, 0, 0, 1];
  const swing = product(away, conjugate(twist));
  const sine = Math.hypot(swing[0], swing[1], swing[2]);
  const scale = sine > 1e-9 ? (2 * Math.atan2(sine, swing[3])) / sine : 2;
  const across = cross(limb, flexion);
  return [scale * dot(swing, flexion), scale * dot(swing, across), 2 * Math.atan2(along, away[3])];
}

// Yaw, then inside it pitch, front up, then roll, left side up.
function spineAngles(turn) {
  const ahead = rotated(turn, [0, 0, 1]);
  const left = rotated(turn, [1, 0, 0]);
  const up = rotated(turn, [0, 1, 0]);
  return [
    Math.atan2(ahead[0], ahead[2]), Math.asin(Math.min(Math.max(ahead[1], -1), 1)),
    Math.atan2(left[1], up[1]),
  ];
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

// Quaternions x, y, z, w.
function conjugate([x, y, z, w]) {
  return [-x, -y, -z, w];
}

function product(a, b) {
  const turned = cross(a, b);
  const vector = turned.map((part, i) => part + a[3] * b[i] + b[3] * a[i]);
  return [...vector, a[3] * b[3] - dot(a, b)];
}

function rotated(q, v) {
  return product(product(q, [...v, 0]), conjugate(q)).slice(0, 3);
}

function wrapped(angle) {
  if (angle > Math.PI) return angle - 2 * Math.PI;
  return angle < -Math.PI ? angle + 2 * Math.PI : angle;
}
