// A rig from the user's disk, chosen or dropped anywhere on the page, sent with progress.

import { make, makeButton } from "/page/elements.js";
import { keepFile } from "/page/given_files.js";
import { sendFile } from "/page/upload.js";

const MOST = 64 * 2 ** 20; // bytes

export class RigUpload {
  // `taken` hears the server's answer.
  constructor(store, taken) {
    Object.assign(this, { store, taken });
    this.file = make("input", { type: "file", accept: ".glb,.gltf", hidden: true, "aria-label": "Rig file" });
    this.file.addEventListener("change", () => {
      this.send(this.file.files[0]);
      this.file.value = ""; // the same file may be chosen again
    });
    this.bar = make("progress", { max: 1, hidden: true, "aria-label": "Sending the rig" });
    this.button = makeButton("Open a GLB…", () => this.file.click());
    this.element = make("span", { class: "row" }, this.button, this.file, this.bar);
    store.on("rigfile", (file) => this.send(file)); // dropped on the page
  }

  async send(file) {
    if (!file) return;
    const why = refusal(file);
    if (why) {
      this.store.say(why);
      return;
    }
    this.button.disabled = true;
    try {
      const answer = await sendFile(this.store, "/rig", file, this.bar);
      keepFile(answer.rig, "/rig", file);
      this.taken(answer);
    } catch (error) {
      this.store.say(error.message);
    } finally {
      this.button.disabled = false;
    }
  }
}

function refusal(file) {
  if (!/\.(glb|gltf)$/i.test(file.name)) {
    return `${file.name} is no GLB; export the rig as one file that ends in .glb.`;
  }
  if (file.size === 0) return `${file.name} is empty.`;
  const size = (file.size / 2 ** 20).toFixed(0);
  return file.size > MOST ? `${file.name} has ${size} MiB; a rig may have 64.` : null;
}
