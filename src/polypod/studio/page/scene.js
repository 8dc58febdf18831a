// The scene: what the world looks like, from where it is seen, and what the pointer does in it.

import { THREE } from "three";
import { addStyle } from "/page/elements.js";
import { Cameras } from "/page/cameras.js";
import { Creatures } from "/page/creatures.js";
import { Ground } from "/page/ground.js";
import { Handles } from "/page/handles.js";
import { resolution } from "/page/lines.js";
import { Obstacles } from "/page/obstacles.js";
import { Overlays } from "/page/overlays.js";
import { Playback } from "/page/playback.js";
import { Rays } from "/page/rays.js";
import { Sky } from "/page/sky.js";
import { Toolbar } from "/page/toolbar.js";
import { Tools } from "/page/tools.js";

const MOST_PIXELS = 2; // of the picture for one of the page's: more is work that nobody sees
const SLOW = 24; // pictures a second
const JUDGED_EVERY = 3; // s
const HELD = 0.5; // of the fineness, while something is dragged and pictures come slowly
const PRINT = 2; // pixels of a picture that is kept, for one of the view's
const SMALL = 0.5; // radii of the creature: what reaches no farther is as good as a point
const SEEN = 0.8; // of the half picture: what is new is well within
const AHEAD = 1.5; // radii of the creature: nearer than that, a new thing would be under it

export function mountScene(element, store) {
  addStyle("scene.css");
  const scene = new Scene(element, store);
  // For whoever measures or tries the page from outside, as `polypod` is.
  store.scene = scene;
  return scene;
}

class Scene {
  constructor(element, store) {
    this.element = element;
    this.store = store;
    this.drawn = 0; // pictures, for whoever measures
    this.software = isSoftware();
    this.fineness = this.software ? 1 : Math.min(devicePixelRatio, MOST_PIXELS);
    this.renderer = makeRenderer(this.software);
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "application");
    this.canvas.setAttribute("aria-label", "View of the creature and its world");
    element.append(this.canvas);
    this.scene = new THREE.Scene();
    this.makeParts();
    this.lastDrawn = this.judged = performance.now();
    this.judgedDrawn = 0;
    this.shown = new THREE.Vector3(); // the middle of what the sun lights
    this.rate = 0; // pictures a second
    this.holding = false; // whether something is held and pictures come slowly
    this.held = false; // whether they are coarse for it
    new ResizeObserver(() => this.resize()).observe(element);
    window.addEventListener("pointerdown", () => this.hold(this.rate < SLOW), true);
    for (const kind of ["pointerup", "pointercancel", "blur"]) {
      window.addEventListener(kind, () => this.hold(false), true);
    }
    this.resize();
    this.renderer.setAnimationLoop((now) => this.draw(now));
  }

  makeParts() {
    const { scene, store, canvas, element } = this;
    this.playback = new Playback(store);
    this.sky = new Sky(scene, 2048);
    this.ground = new Ground(scene, store);
    this.creatures = new Creatures(scene, store, this.software ? 130 : 60);
    this.obstacles = new Obstacles(scene, store);
    this.overlays = new Overlays(scene, store, this.creatures);
    this.overlays.body.heightAt = (x, z) => this.heightAt(x, z);
    this.toolbar = new Toolbar(element, (mode) => { this.mode = mode; });
    const note = (text, event) => this.toolbar.note(text, event);
    note("");
    this.cameras = new Cameras(canvas);
    this.cameras.heightAt = (x, z) => this.heightAt(x, z);
    this.renderer.localClippingEnabled = true;
    this.obstacles.clip(this.cameras.curtain);
    this.rays = new Rays(this.cameras, canvas, this);
    this.handles = new Handles(scene, store, this.obstacles, this.ground, this.rays, note);
    this.tools = new Tools({
      store, scene, canvas, note, rays: this.rays, handles: this.handles, ground: this.ground,
      cameras: this.cameras, creatures: this.creatures,
    });
    // What a view went back for is no longer what is looked at.
    this.handles.onSelect((index) => { if (index === null) this.cameras.settle(); });
    this.tools.onMode((mode) => this.toolbar.show(mode));
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(this.pixels);
    this.renderer.setSize(width, height);
    // Lines are as wide on a fine screen as on a coarse one.
    resolution.value.set(width, height);
    this.cameras.camera.aspect = width / height;
    this.cameras.camera.updateProjectionMatrix();
  }

  // Of the picture, for one of the page's.
  get pixels() {
    return this.held ? HELD * this.fineness : this.fineness;
  }

  // The browser hands on the pointer's moves once a picture: while something is held, pictures that
  // would come slowly are coarse, so that the creature follows the hand.
  hold(held) {
    this.holding = held;
  }

  draw(now) {
    const elapsed = (now - this.lastDrawn) / 1000;
    this.lastDrawn = now;
    if (!this.playback.advance(now)) return;
    if (this.held !== this.holding) {
      // Here, since a canvas of another size is empty until it is drawn.
      this.held = this.holding;
      this.resize();
    }
    this.creatures.update(this.playback);
    this.obstacles.update(this.playback);
    const focus = this.creatures.focus(this.playback.to);
    if (focus) this.look(focus, elapsed);
    this.creatures.choose(this.cameras.camera, this.canvas.height);
    this.tools.hover();
    this.overlays.update(this.playback);
    this.handles.update();
    this.renderer.render(this.scene, this.cameras.camera);
    this.drawn += 1;
    this.spare(now);
  }

  // A weak GPU before a fine screen: rather fewer pixels than fewer pictures.
  spare(now) {
    const seconds = (now - this.judged) / 1000;
    if (seconds < JUDGED_EVERY) return;
    const rate = (this.drawn - this.judgedDrawn) / seconds;
    this.rate = rate;
    this.judged = now;
    this.judgedDrawn = this.drawn;
    // What was hidden or asleep in between tells nothing.
    if (rate < 1 || rate > SLOW || this.fineness <= 1) return;
    this.fineness = Math.max(1, 0.75 * this.fineness);
    this.resize();
  }

  look({ herd, row }, elapsed) {
    const { cameras, sky } = this;
    if (herd.radius) {
      if (Math.abs(herd.radius - cameras.size) > 0.02 * cameras.size) {
        this.ground.suit(1.2 * herd.radius);
        this.toolbar.showGrid(this.ground.grid.value);
      }
      cameras.suit(herd.radius);
    }
    if (!cameras.size) return;
    cameras.update(herd.poses, herd.bodyAt(row), elapsed);
    const seen = cameras.apparent();
    this.shown.copy(cameras.controls.target);
    const lit = Math.min(Math.max(1.2 * seen, 2.5 * cameras.size), 24 * cameras.size);
    const distance = cameras.camera.position.distanceTo(cameras.controls.target);
    sky.follow(this.shown, lit, distance, this.ground.edge);
  }

  // For the panels and the keyboard.

  get mode() {
    return this.tools.mode;
  }

  set mode(mode) {
    this.tools.choose(mode);
  }

  onMode(listener) {
    this.tools.onMode(listener);
  }

  // Show the whole creature.
  frame() {
    this.cameras.frame();
  }

  // Have a place of the world in the picture, [x, y, z], until no obstacle is chosen any more; where
  // it is already, nothing moves.
  reveal(place) {
    if (!this.sees(place, 1)) this.cameras.reveal(new THREE.Vector3(...place));
  }

  // Whether a place is within so much of the half picture.
  sees([x, y, z], share) {
    const place = new THREE.Vector3(x, y, z);
    const seen = place.clone().project(this.cameras.camera);
    return seen.z < 1 && Math.max(Math.abs(seen.x), Math.abs(seen.y)) < share;
  }

  // Choose an obstacle by its number, or null.
  select(index) {
    this.handles.select(index);
  }

  onSelect(listener) {
    this.handles.onSelect(listener);
  }

  heightAt(x, z) {
    return this.ground.relief.height(x, z);
  }

  // Where an event is on the ground, [x, z], or null.
  placeAt(event) {
    if (document.elementFromPoint(event.clientX, event.clientY) !== this.canvas) return null;
    this.rays.aim(event);
    const place = this.rays.groundPlace();
    return place && [place.x, place.z];
  }

  // Where a new thing goes, [x, z]: on the ground in the view's middle, but not under the creature;
  // or ahead of it. The thing reaches `around` [m] about it.
  placeAhead(around = 0) {
    const { centre, size } = this.cameras;
    const least = AHEAD * size + Math.max(around - SMALL * size, 0);
    this.rays.at(0, 0);
    const place = this.rays.groundPlace();
    const near = place ? Math.hypot(place.x - centre.x, place.z - centre.z) : Infinity;
    if (near > least && near < 20 * size) return [place.x, place.z];
    // In its way, and as near as it must be to be seen from where the view is.
    for (let far = 2; far >= 1; far -= 0.25) {
      const [x, z] = this.ahead(far * least);
      if (this.sees([x, this.heightAt(x, z), z], SEEN)) return [x, z];
    }
    return this.ahead(2 * least);
  }

  // A place [x, z] so far ahead of the creature, m.
  ahead(away) {
    const { centre, heading } = this.cameras;
    return [centre.x + away * Math.sin(heading), centre.z + away * Math.cos(heading)];
  }

  // Where a place of the world is on the page, [x, y] in pixels.
  pixelsOf(place) {
    return this.rays.pixelsOf(new THREE.Vector3(...place));
  }

  // The view as a PNG.
  picture() {
    this.renderer.setPixelRatio(PRINT);
    // Drawn and read in one go: the browser may forget the picture after that.
    this.renderer.render(this.scene, this.cameras.camera);
    const coming = new Promise((resolve, reject) => {
      this.canvas.toBlob((blob) => (
        blob ? resolve(blob) : reject(new Error("the browser made no picture of the view"))
      ), "image/png");
    });
    this.renderer.setPixelRatio(this.pixels);
    return coming;
  }
}

function makeRenderer(software) {
  const renderer = new THREE.WebGLRenderer({
    antialias: !software, powerPreference: "high-performance",
  });
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = software ? THREE.BasicShadowMap : THREE.PCFShadowMap;
  renderer.toneMapping = THREE.NoToneMapping;
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
