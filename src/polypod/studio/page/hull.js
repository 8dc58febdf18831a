// The convex hull of points in space, for obstacles that are given as one.

// Triangles of the hull of `points` ([[x, y, z], ...]), counter-clockwise from outside, as flat
// places [T * 9]; empty where the points have no volume.
export function hullTriangles(points) {
  const faces = firstFaces(points);
  if (!faces) return new Float32Array(0);
  points.forEach((point, p) => {
    const seen = faces.filter((face) => over(points, face, point));
    if (seen.length === 0) return;
    // Where what the point sees ends, new faces lead to it.
    const edges = new Map();
    for (const [a, b, c] of seen) {
      for (const [i, j] of [[a, b], [b, c], [c, a]]) {
        if (!edges.delete(`${j} ${i}`)) edges.set(`${i} ${j}`, [i, j]);
      }
    }
    for (const face of seen) faces.splice(faces.indexOf(face), 1);
    for (const [i, j] of edges.values()) faces.push([i, j, p]);
  });
  return new Float32Array(faces.flat().flatMap((i) => points[i]));
}

function firstFaces(points) {
  const spread = Math.max(...points.map((p) => distance(p, points[0])), 0);
  const least = 1e-7 * spread;
  const b = points.findIndex((p) => distance(p, points[0]) > least);
  if (b < 0) return null;
  const c = points.findIndex((p) => length(cross(minus(points[b], points[0]), minus(p, points[0])))
    > least * spread);
  if (c < 0) return null;
  const d = points.findIndex((p) => Math.abs(volume(points, [0, b, c], p)) > least * spread ** 2);
  if (d < 0) return null;
  // The fourth corner lies under the first face.
  const [i, j] = volume(points, [0, b, c], points[d]) > 0 ? [c, b] : [b, c];
  return [[0, i, j], [0, j, d], [j, i, d], [i, 0, d]];
}

function over(points, face, point) {
  const [a, b, c] = face.map((i) => points[i]);
  const normal = cross(minus(b, a), minus(c, a));
  return dot(normal, minus(point, a)) > 1e-9 * length(normal) * (distance(a, b) + distance(a, c));
}

function volume(points, [a, b, c], point) {
  const normal = cross(minus(points[b], points[a]), minus(points[c], points[a]));
  return dot(normal, minus(point, points[a]));
}

const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const length = (a) => Math.hypot(a[0], a[1], a[2]);
const distance = (a, b) => length(minus(a, b));
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];
