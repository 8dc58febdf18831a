// The World panel: ground, obstacles, the way, other creatures, scene files.

import { CrowdPanel } from "/page/crowd_panel.js";
import { Drops } from "/page/drops.js";
import { addStyle, makeSection } from "/page/elements.js";
import { ObstaclePanel } from "/page/obstacle_panel.js";
import { TerrainPanel } from "/page/terrain_panel.js";
import { WayPanel } from "/page/way_panel.js";
import { WorldUpload } from "/page/world_upload.js";

export function mountWorld(element, store, scene) {
  addStyle("panels.css");
  const obstacles = new ObstaclePanel(store, scene);
  const upload = new WorldUpload(store, (...mesh) => obstacles.put(...mesh));
  obstacles.clear.before(upload.meshButton);
  new Drops(store, scene, upload);
  const parts = [
    ["Ground", new TerrainPanel(store)],
    ["Obstacles", obstacles],
    ["Path", new WayPanel(store, scene)],
    ["Creatures beside it", new CrowdPanel(store)],
  ];
  for (const [title, part] of parts) element.append(makeSection(title, part.element));
  element.append(makeSection("Scene file", upload.element));
  const refresh = () => {
    if (!store.document || !store.welcome || !store.creature || !store.files) return;
    for (const [, part] of parts) part.refresh();
  };
  // Lists show at once what is asked for: their numbers are those that the next edit goes by.
  const kinds = ["document", "wanted", "welcome", "creature", "files"];
  for (const kind of kinds) store.on(kind, refresh);
}
