// The rigs and meshes that this page gave the studio, for as long as it is open: one that is started
// anew has none of them.

const files = new Map(); // as documents call it: {route, file}

export function keepFile(name, route, file) {
  files.set(name, { route, file });
}

// Give the studio once more what a document names, as far as it came from here. Returned is what can
// be had of that document: meshes and grounds that came from elsewhere, with a scene, are left out.
export async function giveAgain(store, document) {
  const { creature, crowd, obstacle, terrain } = document;
  const meshes = obstacle.filter(({ shape }) => shape === "mesh").map(({ file }) => file);
  const given = new Set([...[creature, ...crowd].map(({ rig }) => rig), ...meshes]);
  for (const name of given) await give(store, name);
  const { meshes: known, grounds } = store.files;
  const there = ({ shape, file }) => shape !== "mesh" || files.has(file) || file in known;
  const lost = terrain?.given !== undefined && !grounds.includes(terrain.given);
  return { ...document, obstacle: obstacle.filter(there), terrain: lost ? null : terrain };
}

async function give(store, name) {
  const kept = files.get(name);
  if (!kept) return;
  const headers = { "Content-Type": "application/octet-stream" };
  const route = `${kept.route}?name=${encodeURIComponent(kept.file.name)}`;
  await store.fetch(route, { method: "POST", headers, body: kept.file });
}
