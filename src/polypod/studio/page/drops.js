// Files dropped anywhere on the page go where they belong: a rig to its panel, a mesh into the
// world, a scene with its files becomes the world.

import { make } from "/page/elements.js";

const SCENE = /\.(toml|zip)$/i;
const MESH = /\.obj$/i;
const EITHER = /\.(glb|gltf)$/i;
const BINARY = /\.glb$/i;
const HEAD = 20; // bytes of a GLB before its JSON

export class Drops {
  constructor(store, scene, world) {
    Object.assign(this, { store, scene, world });
    this.cover = make(
      "div", { class: "drop", hidden: true },
      "Drop a rig (GLB) to walk it, a mesh (OBJ, GLB) to put it here, or a scene (TOML, ZIP) with its files",
    );
    document.body.append(this.cover);
    // What is no file (a text, a picture of the page) goes its own way.
    const carriesFiles = (event) => event.dataTransfer?.types.includes("Files");
    window.addEventListener("dragover", (event) => {
      if (!carriesFiles(event)) return;
      event.preventDefault();
      event.dataTransfer.dropEffect = "copy";
      this.cover.hidden = false;
    });
    window.addEventListener("dragleave", (event) => {
      if (event.relatedTarget === null) this.cover.hidden = true;
    });
    window.addEventListener("drop", (event) => {
      this.cover.hidden = true;
      if (!carriesFiles(event)) return;
      event.preventDefault();
      this.sort([...event.dataTransfer.files], scene.placeAt(event));
    });
  }

  // `place`: [x, z] where they were dropped on the ground, or null.
  async sort(files, place) {
    if (files.some(({ name }) => SCENE.test(name)) || this.world.waitsFor(files)) {
      await this.world.open(files);
      return;
    }
    const meshes = [];
    const others = [];
    for (const file of files) (await this.isMesh(file) ? meshes : others).push(file);
    if (meshes.length) await this.world.addMeshes(meshes, place);
    if (others.length) this.store.tell("rigfile", others[0]);
    if (others.length > 1) this.store.say(`Of these ${others.length} rigs ${others[0].name} was taken; drop them one by one.`);
  }

  // A glTF without a skin can be no creature; one with a skin is, wherever it is dropped.
  async isMesh(file) {
    if (MESH.test(file.name)) return true;
    if (!EITHER.test(file.name)) return false;
    return !await hasSkin(file);
  }
}

async function hasSkin(file) {
  try {
    const text = BINARY.test(file.name) ? await jsonOf(file) : await file.text();
    return (JSON.parse(text).skins ?? []).length > 0;
  } catch {
    return true; // broken: who reads rigs says how
  }
}

// The JSON of a GLB, as text.
async function jsonOf(file) {
  const length = new DataView(await file.slice(0, HEAD).arrayBuffer()).getUint32(12, true);
  return file.slice(HEAD, HEAD + length).text();
}
