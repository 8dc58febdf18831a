// What draws: three.js's renderer, at the level of quality that the machine has time for or that a
// person has pinned. Pictures that are kept are drawn at the best.

import { THREE } from "three";
import { pace } from "/page/canvas.js";
import { BEST, FASTEST, LEVELS, Patience, Quality } from "/page/quality.js";

const KEPT = "polypod.quality";
// Without a GPU: where to begin, so that the first seconds are no show of slides.
const SOFTWARE = 2;

export const QUALITIES = {
  auto: { title: "Auto", hint: "as fine as there is time for" },
  best: { title: "Best", hint: "everything fine, however long it takes" },
  fast: { title: "Fast", hint: "coarse, so that it moves smoothly" },
};

export class Painter {
  // `parts`: {sky, creatures} of the scene, which have their own part in a level.
  constructor(scene, parts) {
    this.scene = scene;
    this.parts = parts;
    const software = isSoftware();
    this.renderer = makeRenderer(software);
    this.canvas = this.renderer.domElement;
    this.quality = new Quality(software ? SOFTWARE : BEST);
    this.patience = software ? new Patience() : null;
    this.listeners = new Set();
    this.filming = false; // a video is made of the view
    this.drawn = 0; // pictures, for whoever measures
    this.last = 0; // ms, when the picture before was wanted; 0 where it was not
    this.settled = false; // the picture is finer than its level, for nothing stirs
    const kept = localStorage.getItem(KEPT);
    this.pinned = kept in QUALITIES ? kept : "auto";
    this.use(this.wanted);
  }

  // Hear of what is pinned, and of the level, when they change.
  onChange(listener) {
    this.listeners.add(listener);
    listener();
  }

  choose(pinned) {
    if (!(pinned in QUALITIES)) throw new Error(`there is no quality ${pinned}; there are ${Object.keys(QUALITIES).join(", ")}`);
    this.pinned = pinned;
    localStorage.setItem(KEPT, pinned);
    this.tell();
  }

  tell() {
    for (const listener of this.listeners) listener();
  }

  // Take the share of real time that the simulation keeps while it walks.
  share(kept) {
    this.patience?.take(kept);
  }

  // ms from one picture to the next, at least.
  get pause() {
    return this.filming ? 0 : this.patience?.pause ?? 0;
  }

  get wanted() {
    if (this.filming || this.pinned === "best") return BEST;
    return this.pinned === "fast" ? FASTEST : this.quality.level;
  }

  // Other creatures: they may be easier to draw.
  forget() {
    this.quality.forget();
  }

  resize(width, height) {
    this.size = [width, height];
    this.fit(this.pixels);
  }

  fit(pixels) {
    if (!this.size) return;
    this.renderer.setPixelRatio(pixels);
    // The style stretches a coarse picture over the same place.
    this.renderer.setSize(...this.size);
  }

  // Of the picture, for one of the page's.
  get pixels() {
    const { pixels } = LEVELS[this.level];
    return pixels < 1 ? pixels : Math.min(devicePixelRatio, pixels);
  }

  // Whether a finer picture could be drawn of what stands still.
  get coarse() {
    return this.pinned === "auto" && this.level !== BEST && !this.settled;
  }

  // Draw what stands still once more, with as many pixels and as fine creatures as can be; `prepare` is
  // called before. Shadows and materials stay: to change them takes longer than a picture, and hands
  // may come back any moment.
  settle(camera, prepare) {
    this.settled = true;
    this.fit(Math.min(devicePixelRatio, LEVELS[BEST].pixels));
    this.parts.creatures.small = LEVELS[BEST].small;
    prepare();
    this.renderer.render(this.scene, camera);
    this.drawn += 1;
  }

  // Back to the level, before the next picture.
  unsettle() {
    if (!this.settled) return;
    this.settled = false;
    this.fit(this.pixels);
    this.parts.creatures.small = LEVELS[this.level].small;
  }

  // Go over to a level.
  use(level) {
    if (level === this.level) return;
    const before = LEVELS[this.level];
    this.level = level;
    const next = LEVELS[level];
    const { sky, creatures } = this.parts;
    this.fit(this.pixels);
    sky.grain(next.shadow);
    creatures.small = next.small;
    pace.most = next.panels;
    this.renderer.shadowMap.type = next.soft ? THREE.PCFShadowMap : THREE.BasicShadowMap;
    if (before?.soft !== next.soft) {
      this.scene.traverse(({ material }) => {
        for (const one of [material ?? []].flat()) one.needsUpdate = true;
      });
    }
    this.renderer.shadowMap.needsUpdate = true;
  }

  // Nothing was to be drawn: how long it was until the next picture tells nothing.
  rest() {
    this.last = 0;
  }

  // Draw; `now` [ms] is when the picture was begun, `walks` whether the next is wanted at once.
  draw(camera, now, walks) {
    const { shadowMap } = this.renderer;
    // What stands still is drawn at once with its own shadow.
    const due = this.drawn % LEVELS[this.level].every === 0 || !walks;
    shadowMap.autoUpdate = false;
    shadowMap.needsUpdate ||= due;
    this.renderer.render(this.scene, camera);
    this.drawn += 1;
    // Pictures that waited tell nothing of how long they take.
    const judged = this.pinned === "auto" && !this.filming && this.pause === 0 && !document.hidden;
    if (walks && this.last && judged) this.quality.take(now - this.last);
    this.last = walks ? now : 0;
  }

  // The view as a PNG, of `pixels` for one of the page's, and as good as can be; `prepare` is called
  // with the picture's height before it is drawn.
  picture(camera, pixels, prepare) {
    const { level } = this;
    this.unsettle();
    this.use(BEST);
    this.fit(pixels);
    prepare(this.canvas.height);
    // Drawn and read in one go: the browser may forget the picture after that.
    this.renderer.render(this.scene, camera);
    const coming = new Promise((resolve, reject) => {
      this.canvas.toBlob((blob) => (
        blob ? resolve(blob) : reject(new Error("the browser made no picture of the view"))
      ), "image/png");
    });
    this.use(level);
    this.fit(this.pixels);
    this.rest();
    return coming;
  }
}

function makeRenderer(software) {
  const renderer = new THREE.WebGLRenderer({
    antialias: !software, powerPreference: "high-performance",
  });
  renderer.shadowMap.enabled = true;
  renderer.toneMapping = THREE.NoToneMapping;
  renderer.localClippingEnabled = true;
  return renderer;
}

// Whether pictures are drawn without a GPU. Then smooth edges would take most of the time.
function isSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const named = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = named ? gl.getParameter(named.UNMASKED_RENDERER_WEBGL) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
