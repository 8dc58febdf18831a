// A GLB from the user's disk, chosen or dropped anywhere on the page, sent with progress.

import { make, makeButton } from "/page/elements.js";
import { keepFile } from "/page/given_files.js";

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
    this.cover = make("div", { class: "drop", hidden: true }, "Drop a GLB here to see whether it can walk");
    document.body.append(this.cover);
    this.watchDrops();
  }

  // The whole page takes files; what is no file (a text, a picture of the page) goes its own way.
  watchDrops() {
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
      this.send(event.dataTransfer.files[0]);
    });
  }

  async send(file) {
    if (!file) return;
    const why = refusal(file);
    if (why) {
      this.store.say(why);
      return;
    }
    this.bar.hidden = false;
    this.button.disabled = true;
    try {
      const answer = await this.post(file);
      keepFile(answer.rig, file);
      this.taken(answer);
    } catch (error) {
      this.store.say(error.message);
    } finally {
      this.bar.hidden = true;
      this.button.disabled = false;
    }
  }

  // By XMLHttpRequest, for `fetch` tells nothing of how far an upload is.
  post(file) {
    return new Promise((resolve, reject) => {
      const request = new XMLHttpRequest();
      request.open("POST", `/rig?name=${encodeURIComponent(file.name)}`);
      request.setRequestHeader("X-Polypod-Token", this.store.token);
      request.setRequestHeader("Content-Type", "model/gltf-binary");
      request.responseType = "json";
      request.upload.onprogress = (event) => {
        // All sent: the server reads it, for which there is no measure.
        if (event.loaded < event.total) this.bar.value = event.loaded / event.total;
        else this.bar.removeAttribute("value");
      };
      request.onload = () => {
        if (request.status === 200) resolve(request.response);
        else reject(new Error(request.response?.why ?? `${file.name}: ${request.status} ${request.statusText}`));
      };
      request.onerror = () => reject(new Error(`${file.name} was not taken: the studio does not answer.`));
      request.send(file);
    });
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
