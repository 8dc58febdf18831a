// Save what is asked of the world as a scene file, and open one.

import { make, makeButton, saveAs } from "/page/elements.js";

const MOST = 1 << 20; // bytes of a scene file

export function sceneFiles(store) {
  const file = make("input", { type: "file", accept: ".toml", hidden: true, "aria-label": "Scene file" });
  file.addEventListener("change", async () => {
    const [chosen] = file.files;
    if (chosen) await openScene(store, chosen);
    file.value = ""; // the same file may be opened again
  });
  return make(
    "div", { class: "row" },
    makeButton("Save scene", () => saveScene(store)),
    makeButton("Open scene…", () => file.click()), file,
  );
}

async function saveScene(store) {
  try {
    const answer = await store.fetchSettled("/export/scene.toml");
    saveAs(await answer.blob(), "scene.toml");
  } catch (error) {
    store.say(error.message);
  }
}

async function openScene(store, file) {
  if (file.size > MOST) {
    store.say(`${file.name} is no scene file: those have at most 1 MiB.`);
    return;
  }
  try {
    await store.fetchSettled("/scene", { method: "POST", body: await file.text() });
    store.say(`${file.name} is open.`, true);
  } catch (error) {
    store.say(error.message);
  }
}
