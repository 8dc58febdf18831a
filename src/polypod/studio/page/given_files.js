// The rigs that this page gave the studio, for as long as it is open: one that is started anew has
// none of them.

const files = new Map(); // rig, as documents call it: the file

export function keepFile(rig, file) {
  files.set(rig, file);
}

// Give the studio the rigs of a document once more, as far as they came from here.
export async function giveAgain(store, { creature, crowd }) {
  for (const { rig } of [creature, ...crowd]) {
    const file = files.get(rig);
    if (!file) continue;
    const headers = { "Content-Type": "model/gltf-binary" };
    await store.fetch(`/rig?name=${encodeURIComponent(file.name)}`, { method: "POST", headers, body: file });
  }
}
