// The World panel: ground, obstacles, the way, other creatures, scene files.

import { CrowdPanel } from "/page/crowd_panel.js";
import { addStyle, makeSection } from "/page/elements.js";
import { ObstaclePanel } from "/page/obstacle_panel.js";
import { sceneFiles } from "/page/scene_files.js";
import { TerrainPanel } from "/page/terrain_panel.js";
import { WayPanel } from "/page/way_panel.js";

export function mountWorld(element, store, scene) {
  addStyle("panels.css");
  const parts = [
    ["Ground", new TerrainPanel(store)],
    ["Obstacles", new ObstaclePanel(store, scene)],
    ["Path", new WayPanel(store, scene)],
    ["Creatures beside it", new CrowdPanel(store)],
  ];
  for (const [title, part] of parts) element.append(makeSection(title, part.element));
  element.append(makeSection("Scene file", sceneFiles(store)));
  const refresh = () => {
    if (!store.document || !store.welcome || !store.creature) return;
    for (const [, part] of parts) part.refresh();
  };
  // Lists show at once what is asked for: their numbers are those that the next edit goes by.
  for (const kind of ["document", "wanted", "welcome", "creature"]) store.on(kind, refresh);
}
