// A coarser skin for creatures that look small: vertices that are close together, belong to the
// same joint and face the same way become one. Facing keeps thin legs from closing to nothing.

// `cells` along the radius of the creature; `facing` tells ways apart: by octants, or by the sides of a
// tetrahedron, to which a leg is still as thick as it is.
export const COARSE = { cells: 7, facing: octant };
export const CRUDE = { cells: 2.5, facing: side };

const SAME = 1e-4; // of the radius: vertices so close to each other are at one place

// From the arrays of a skin, the same arrays with fewer vertices.
export function coarsened(arrays, radius, { cells, facing } = COARSE) {
  const { place, normal, joint, weight, colour, triangles } = arrays;
  const cell = radius / cells;
  const ways = waysOfPlaces(place.data, normal.data, radius * SAME);
  const found = new Map();
  const into = new Uint32Array(place.shape[0]);
  for (let v = 0; v < place.shape[0]; v++) {
    const key = keyOf(place.data, ways, joint.data, weight.data, v, cell, facing);
    if (!found.has(key)) found.set(key, found.size);
    into[v] = found.get(key);
  }
  const count = found.size;
  const out = {
    place: { data: new Float32Array(3 * count), shape: [count, 3] },
    normal: { data: new Float32Array(3 * count), shape: [count, 3] },
    joint: { data: new Uint16Array(4 * count), shape: [count, 4] },
    weight: { data: new Float32Array(4 * count), shape: [count, 4] },
    colour: { data: new Uint8Array(4 * count), shape: [count, 4] },
  };
  const sums = new Float32Array(4 * count);
  const members = new Uint32Array(count);
  for (let v = 0; v < place.shape[0]; v++) {
    const w = into[v];
    members[w] += 1;
    for (let i = 0; i < 3; i++) {
      out.place.data[3 * w + i] += place.data[3 * v + i];
      out.normal.data[3 * w + i] += normal.data[3 * v + i];
    }
    for (let i = 0; i < 4; i++) {
      sums[4 * w + i] += colour.data[4 * v + i];
      // Its joints are those of one of the vertices: all move much alike.
      out.joint.data[4 * w + i] = joint.data[4 * v + i];
      out.weight.data[4 * w + i] = weight.data[4 * v + i];
    }
  }
  for (let w = 0; w < count; w++) finish(out, sums, w, members[w]);
  out.triangles = remaining(triangles.data, into);
  return out;
}

// Where vertices face, those of one place all alike: edges that are drawn sharp, or lie between parts
// of a picture, have a vertex for each side, and a skin whose sides went apart there would be torn.
function waysOfPlaces(place, normal, same) {
  const sums = new Map();
  const keys = Array.from({ length: place.length / 3 }, (_, v) => (
    Array.from(place.subarray(3 * v, 3 * v + 3), (at) => Math.round(at / same)).join(" ")
  ));
  keys.forEach((key, v) => {
    const sum = sums.get(key) ?? [0, 0, 0];
    for (let i = 0; i < 3; i++) sum[i] += normal[3 * v + i];
    sums.set(key, sum);
  });
  // Rounded: what faces along an axis is on the same side of it on both sides of the creature.
  return Float32Array.from(keys.flatMap((key) => sums.get(key).map((sum) => Number(sum.toFixed(3)))));
}

function octant(x, y, z) {
  return (x > 0 ? 1 : 0) | (y > 0 ? 2 : 0) | (z > 0 ? 4 : 0);
}

function side(x, y, z) {
  const toward = [x + y + z, x - y - z, y - x - z, z - x - y];
  return toward.indexOf(Math.max(...toward));
}

function keyOf(place, normal, joint, weight, v, cell, facing) {
  let strongest = 4 * v;
  for (let n = 4 * v + 1; n < 4 * v + 4; n++) if (weight[n] > weight[strongest]) strongest = n;
  const way = facing(normal[3 * v], normal[3 * v + 1], normal[3 * v + 2]);
  // What lies on a cell's side to within rounding, as a trunk's middle does, is in one of the two.
  const [x, y, z] = [0, 1, 2].map((i) => Math.floor(place[3 * v + i] / cell + 0.001));
  return `${x} ${y} ${z} ${joint[strongest]} ${way}`;
}

function finish(out, sums, w, members) {
  const { place, normal, colour } = out;
  const size = Math.hypot(...normal.data.subarray(3 * w, 3 * w + 3)) || 1;
  for (let i = 0; i < 3; i++) {
    place.data[3 * w + i] /= members;
    normal.data[3 * w + i] /= size;
  }
  for (let i = 0; i < 4; i++) colour.data[4 * w + i] = sums[4 * w + i] / members;
}

// Triangles that still have three corners.
function remaining(triangles, into) {
  const kept = [];
  for (let t = 0; t < triangles.length; t += 3) {
    const a = into[triangles[t]], b = into[triangles[t + 1]], c = into[triangles[t + 2]];
    if (a !== b && b !== c && c !== a) kept.push(a, b, c);
  }
  return { data: new Uint32Array(kept), shape: [kept.length / 3, 3] };
}
