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
import { Painter } from "/page/painter.js";
import { Playback } from "/page/playback.js";
import { Rays } from "/page/rays.js";
import { Sky } from "/page/sky.js";
import { Toolbar } from "/page/toolbar.js";
import { Tools } from "/page/tools.js";

const PRINT = 2; // pixels of a picture that is kept, for one of the view's
const SMALL = 0.5; // radii of the creature: what reaches no farther is as good as a point
const SEEN = 0.8; // of the half picture: what is new is well within
const CALM = 500; // ms after the last stir for which pictures still are drawn: views glide on;
const OWED = 2; // pictures at least, where these take longer
// What may make the view look another while time stands: what the page is told ("skin" and "ground" it
// tells itself, when they are there to be drawn), and what hands do to it and to the page.
const TOLD = [
  "frame", "arrays", "document", "creature", "limits", "kinds", "clock", "tape", "backdrop", "link",
  "skin", "ground",
];
const TOUCHED = ["pointerdown", "pointerup", "wheel"];
const PRESSED = ["keydown", "click", "change"];
const STILL = 2e-4; // of the view's distance: moved by less, the view stands
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
    this.scene = new THREE.Scene();
    this.creatures = new Creatures(this.scene, store);
    this.sky = new Sky(this.scene);
    this.painter = new Painter(this.scene, this);
    this.canvas = this.painter.canvas;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "application");
    this.canvas.setAttribute("aria-label", "View of the creature and its world");
    element.append(this.canvas);
    this.makeParts();
    this.lastDrawn = performance.now();
    this.shown = new THREE.Vector3(); // the middle of what the sun lights
    this.eye = new THREE.Vector3(); // where the view was from
    this.listenForStirs();
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
    this.painter.renderer.setAnimationLoop((now) => this.draw(now));
  }

  // While time stands nothing is drawn but after something has stirred.
  listenForStirs() {
    this.stir();
    const stir = () => this.stir();
    for (const kind of TOLD) this.store.on(kind, stir);
    for (const kind of TOUCHED) this.canvas.addEventListener(kind, stir, { capture: true, passive: true });
    for (const kind of PRESSED) window.addEventListener(kind, stir, true);
    this.canvas.addEventListener("pointermove", ({ buttons }) => { if (buttons) stir(); }, true);
    document.addEventListener("visibilitychange", stir);
    this.painter.onChange(stir);
    this.store.on("skin", () => this.painter.forget());
  }

  stir() {
    this.stirred = performance.now();
    this.owed = OWED;
  }

  // Pictures that were drawn, for whoever measures.
  get drawn() {
    return this.painter.drawn;
  }

  makeParts() {
    const { scene, store, canvas, element } = this;
    this.playback = new Playback(store);
    this.ground = new Ground(scene, store);
    this.obstacles = new Obstacles(scene, store);
    this.overlays = new Overlays(scene, store, this.creatures);
    this.overlays.body.heightAt = (x, z) => this.heightAt(x, z);
    this.toolbar = new Toolbar(element, (mode) => { this.mode = mode; });
    const note = (text, event) => this.toolbar.note(text, event);
    note("");
    this.cameras = new Cameras(canvas);
    this.cameras.heightAt = (x, z) => this.heightAt(x, z);
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
    this.painter.resize(width, height);
    // Lines are as wide on a fine screen as on a coarse one.
    resolution.value.set(width, height);
    this.cameras.camera.aspect = width / height;
    this.cameras.camera.updateProjectionMatrix();
    this.stir();
  }

  // Whether it looks another in the next picture whatever anybody does.
  get walks() {
    return this.store.clock.playing && this.store.connected && this.store.tape.scrub === null;
  }

  draw(now) {
    const elapsed = (now - this.lastDrawn) / 1000;
    const { walks, painter } = this;
    this.tools.hover();
    if (!walks && this.owed <= 0 && now - this.stirred > CALM) {
      painter.rest();
      if (painter.coarse) painter.settle(this.cameras.camera, () => this.choose(this.canvas.height));
      return;
    }
    if (walks && now - this.lastDrawn < painter.pause) return;
    if (!this.playback.advance(now)) return;
    this.lastDrawn = now;
    this.owed -= 1;
    // Here, since a canvas of another size is empty until it is drawn.
    painter.unsettle();
    painter.use(painter.wanted);
    this.creatures.update(this.playback);
    this.obstacles.update(this.playback);
    const focus = this.creatures.focus(this.playback.to);
    if (focus) this.look(focus, elapsed);
    this.choose(this.canvas.height);
    this.overlays.update(this.playback);
    this.handles.update();
    painter.draw(this.cameras.camera, now, walks);
  }

  // A coarse picture is no reason for coarser creatures.
  choose(height) {
    this.creatures.choose(this.cameras.camera, Math.max(height, this.canvas.clientHeight));
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
    const { position } = cameras.camera;
    if (this.eye.distanceTo(position) > STILL * distance) this.stir();
    this.eye.copy(position);
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
    const coming = this.painter.picture(this.cameras.camera, PRINT, (height) => this.choose(height));
    this.draw(performance.now());
    return coming;
  }
}
