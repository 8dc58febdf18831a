// The Record panel: what is recorded, and everything that can be taken away.

import { addStyle, fillChoice, make, makeButton, makeChoice, makeSection, saveAs } from "/page/elements.js";
import { LinkOpener, linkFor } from "/page/link_state.js";
import { Video } from "/page/video.js";

const FILES = [
  ["GLB, the rig with this motion", "walk.glb"],
  ["NPZ, the record as numbers", "walk.npz"],
];

const ALL = "all";

export function mountRecord(element, store, scene) {
  addStyle("panels.css");
  element.append(
    makeSection("Record", ...recording(store)),
    makeSection("Export what was recorded", exports(store)),
    makeSection("The view", view(element, store, scene)),
    makeSection("Link", ...link(store)),
  );
}

// Start or stop the record; also bound to a key.
export function toggleRecord(store) {
  return store.send({ do: "record", on: !store.recording }).catch((refusal) => store.say(refusal.message));
}

function recording(store) {
  const button = makeButton("● Record", () => toggleRecord(store), { class: "record" });
  const words = make("p", { role: "status" });
  const show = () => {
    const { recording: on, frames, seconds } = store.tape;
    button.textContent = on ? "■ Stop" : "● Record";
    button.setAttribute("aria-pressed", String(on));
    words.textContent = frames || on
      ? `${on ? "Recording" : "Recorded"}: ${seconds.toFixed(1)} s, ${frames} frames.`
      : "Nothing is recorded yet.";
  };
  store.on("tape", show);
  show();
  const note = make("p", { class: "quiet" }, "It goes on while you build the world, and holds all that stood meanwhile. A new one takes its place. Scrub it in the strip below.");
  return [make("div", { class: "row" }, button), words, note];
}

// What was recorded, of one creature or of all.
function exports(store) {
  const whose = makeChoice("Creature to export", () => {});
  const row = make("label", { class: "row" }, "Of", whose);
  const buttons = FILES.map(([words, name]) => makeButton(words, async () => {
    for (const button of buttons) button.disabled = true;
    try {
      const answer = await store.fetchSettled(`/export/${name}?creature=${whose.value}`);
      saveAs(await answer.blob(), fileName(whose, name));
    } catch (error) {
      store.say(error.message);
    }
    show();
  }));
  const show = () => {
    const { frames, recording: on } = store.tape;
    const names = store.tape.kinds.flatMap(({ name, count }) => Array(count).fill(name));
    const each = names.map((name, i) => [String(i), names.length > 1 ? `${name}, ${i + 1}` : name]);
    const all = [ALL, `all ${names.length}, as a ZIP`];
    const there = each.some(([value]) => value === whose.value) || whose.value === ALL;
    fillChoice(whose, names.length > 1 ? [...each, all] : each, there ? whose.value : "0");
    row.hidden = names.length < 2;
    for (const button of buttons) button.disabled = frames === 0 || on;
  };
  store.on("tape", show);
  show();
  return make("div", { class: "column" }, row, ...buttons);
}

// "Fox-walk.glb", of creature 3 of many "Fox-3-walk.glb", of all "walks.zip".
function fileName(whose, name) {
  if (whose.value === ALL) return "walks.zip";
  const words = whose.selectedOptions[0]?.textContent ?? "";
  return [...words.split(", "), name].map((word) => word.replace(/[^\p{L}\p{N}._-]+/gu, "_")).join("-");
}

function view(element, store, scene) {
  const picture = makeButton("PNG, a picture of it", async () => {
    try {
      saveAs(await scene.picture(), "view.png");
    } catch (error) {
      store.say(`There is no picture: ${error.message}`);
    }
  });
  const film = makeButton("", () => (video.running ? video.stop() : video.start()));
  const words = make("p", { class: "quiet", role: "status" });
  let timer = 0;
  const show = () => {
    scene.painter.filming = video.running;
    film.textContent = video.running ? "■ Stop the video" : "Video of it";
    film.setAttribute("aria-pressed", String(video.running));
    film.disabled = !video.possible;
    clearInterval(timer);
    if (video.running) timer = setInterval(() => { words.textContent = `${video.seconds.toFixed(0)} s of video.`; }, 500);
    words.textContent = video.possible ? "" : "This browser makes no videos of a page.";
  };
  const video = new Video(store, scene.canvas, show);
  show();
  return make("div", { class: "column" }, picture, film, words);
}

function link(store) {
  const opener = new LinkOpener(store);
  const box = make("input", { type: "text", readonly: true, "aria-label": "Link", hidden: true, class: "wide-box" });
  box.addEventListener("focus", () => box.select());
  const button = makeButton("Copy a link to all this", async () => {
    await store.orders.settled();
    opener.show(store.document);
    box.value = linkFor(store.document);
    box.hidden = false;
    try {
      await navigator.clipboard.writeText(box.value);
      store.say("The link is in the clipboard.", true);
    } catch {
      box.focus();
      store.say("The browser keeps its clipboard closed; copy the link from its box.");
    }
  });
  // What the box says is true as long as nothing has changed.
  store.on("document", () => { if (box.value !== linkFor(store.document)) box.hidden = true; });
  const note = make(
    "p", { class: "quiet" },
    "It holds creature, gait, numbers and world, not the record. A rig or a mesh of your own is known to this studio for as long as it runs; after that, drop a rig's file on the page once more.",
  );
  return [make("div", { class: "row" }, button), box, note];
}
