// What the world takes from the user's disk: meshes to stand about, and scenes with their files.

import { make, makeButton, saveAs } from "/page/elements.js";
import { keepFile } from "/page/given_files.js";
import { sendFile } from "/page/upload.js";

const MOST = 64 * 2 ** 20; // bytes
const MESHES = ".obj,.glb,.gltf";
const NAMED = `${MESHES},.npy,.png,.raw,.tif,.tiff`; // what scenes name, besides rigs
const SCENE = /\.(toml|zip)$/i;
// Extents in leg lengths between which a mesh is taken as large as its file has it, and what others
// are made.
const SMALLEST = 0.05;
const LARGEST = 15;
const USUAL = 2;

export class WorldUpload {
  // `put` has an obstacle put into the world.
  constructor(store, put) {
    Object.assign(this, { store, put });
    this.waiting = null; // a scene whose files are missing: {scene, wants}
    this.bar = make("progress", { max: 1, hidden: true, "aria-label": "Sending files" });
    const mesh = chooser("Mesh file", MESHES, (files) => this.addMeshes(files, null));
    const scene = chooser("Scene file", `.toml,.zip,${NAMED}`, (files) => this.open(files));
    this.meshButton = make("span", {}, makeButton("+ mesh…", () => mesh.click(), { "aria-label": "Add a mesh" }), mesh);
    this.element = make(
      "div", {},
      make(
        "div", { class: "row" },
        makeButton("Save scene", () => this.save()),
        makeButton("Open scene…", () => scene.click()), scene, this.bar,
      ),
      make("p", { class: "quiet" }, "A scene that names files is saved as a ZIP with them; open that, or choose or drop a scene together with what it names."),
    );
  }

  // Whether these are what a scene lacked.
  waitsFor(files) {
    return files.some(({ name }) => this.waiting?.wants.includes(name));
  }

  async send(route, file) {
    if (file.size > MOST) throw new Error(`it has ${(file.size / 2 ** 20).toFixed(0)} MiB; a file may have 64`);
    return sendFile(this.store, route, file, this.bar);
  }

  // One after the other, the first at `place` [x, z] where there is one.
  async addMeshes(files, place) {
    for (const [i, file] of files.entries()) {
      try {
        const { name, parts, ...mesh } = await this.send("/mesh", file);
        keepFile(mesh.file, "/mesh", file);
        await this.put(this.obstacle(mesh), i === 0 ? place : null, name.replace(/\.\w+$/, ""));
        this.tell(name, parts, mesh);
      } catch (error) {
        this.store.say(`${file.name}: ${error.message}`);
      }
    }
  }

  obstacle({ file, size, close }) {
    const factor = this.factor(size);
    const made = { shape: "mesh", file, size: size.map((side) => Number((factor * side).toPrecision(5))), yaw: 0 };
    return close ? { ...made, close } : made;
  }

  // How much larger it is made than its file has it: 1 where it suits the creature.
  factor(size) {
    const leg = this.store.creature.leg_length;
    const largest = Math.max(...size);
    return largest > LARGEST * leg || largest < SMALLEST * leg ? (USUAL * leg) / largest : 1;
  }

  tell(name, parts, { size, close }) {
    const words = [`${name} stands here, of ${parts} convex ${parts === 1 ? "part" : "parts"}`];
    if (close) words.push("lids were put on the holes of its surface");
    if (this.factor(size) !== 1) {
      words.push(`its file has it ${Math.max(...size).toPrecision(3)} m large, which was changed to suit the creature`);
    }
    this.store.say(`${words.join("; ")}.`, true);
  }

  // A scene among the files, or the one that waits for them.
  async open(files) {
    const scene = files.find(({ name }) => SCENE.test(name)) ?? this.waiting?.scene;
    if (!scene) {
      this.store.say("None of these is a scene (TOML or ZIP).");
      return;
    }
    let file = scene;
    try {
      for (file of files) if (!SCENE.test(file.name)) await this.send("/file", file);
      file = scene;
      await this.store.orders.settled();
      await this.send("/scene", scene);
      this.waiting = null;
      this.store.say(`${scene.name} is open.`, true);
    } catch (error) {
      const wants = error.wants ?? [];
      this.waiting = wants.length ? { scene, wants } : null;
      this.store.say(wants.length
        ? `${scene.name} names ${wants.join(", ")}: drop ${wants.length === 1 ? "that file" : "those files"} too, and it is opened.`
        : `${file.name}: ${error.message}`);
    }
  }

  async save() {
    const { store } = this;
    try {
      if (!namesFiles(store.wanted)) return await this.take("scene.toml");
      try {
        return await this.take("scene.zip");
      } catch (error) {
        // What is too large for a zip lies where its scene was opened.
        await this.take("scene.toml");
        store.say(`${error.message}; saved is the scene alone, to lie where they are.`);
      }
    } catch (error) {
      store.say(error.message);
    }
    return undefined;
  }

  async take(name) {
    const answer = await this.store.fetchSettled(`/export/${name}`);
    saveAs(await answer.blob(), name);
  }
}

function namesFiles({ creature, crowd, obstacle, terrain }) {
  return [creature, ...crowd].some(({ rig }) => rig.startsWith("upload:"))
    || obstacle.some(({ shape }) => shape === "mesh") || Boolean(terrain?.given);
}

function chooser(label, accept, choose) {
  const input = make("input", { type: "file", accept, multiple: true, hidden: true, "aria-label": label });
  input.addEventListener("change", async () => {
    const files = [...input.files];
    input.value = ""; // the same file may be chosen again
    if (files.length) await choose(files);
  });
  return input;
}
