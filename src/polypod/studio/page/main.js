// The page: a scene, a panel with tabs, a bar above and a strip below, all fed by one store.

import { mountBar } from "/page/bar.js";
import { mountBody } from "/page/body.js";
import { mountFeet } from "/page/feet.js";
import { mountGait } from "/page/gait.js";
import { mountRecord } from "/page/record.js";
import { mountRig } from "/page/rig.js";
import { mountScene } from "/page/scene.js";
import { mountStrip } from "/page/strip.js";
import { mountWorld } from "/page/world.js";
import { Link } from "/page/link.js";
import { bindKeys } from "/page/keys.js";
import { Restart } from "/page/restart.js";
import { Store } from "/page/store.js";
import { mountTabs } from "/page/tabs.js";

const store = new Store();
// For whoever measures: the tests read rates and delays here.
window.polypod = store;

const scene = mountScene(document.querySelector("#scene"), store);
mountBar(document.querySelector("#bar"), store, scene);
mountTabs(document.querySelector("#tabs"), document.querySelector("#page"), [
  ["Gait", (element) => mountGait(element, store)],
  ["Feet", (element) => mountFeet(element, store)],
  ["Body", (element) => mountBody(element, store)],
  ["World", (element) => mountWorld(element, store, scene)],
  ["Rig", (element) => mountRig(element, store)],
  ["Record", (element) => mountRecord(element, store, scene)],
]);
mountStrip(document.querySelector("#strip"), store);
bindKeys(store, scene, document.querySelector("#bar"));
new Restart(document.querySelector("#scene"), store);

const words = document.querySelector("#words");
let timer = 0;
store.on("words", ({ words: text, good }) => {
  words.textContent = text;
  words.className = good ? "good" : "bad";
  clearTimeout(timer);
  timer = setTimeout(() => { words.textContent = ""; words.className = ""; }, 8000);
});
store.on("link", (there) => document.body.classList.toggle("lost", !there));

store.link = new Link(store);
