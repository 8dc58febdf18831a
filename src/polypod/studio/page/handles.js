// Handles of the chosen obstacle: its outline, a ring to turn it, corners to resize it, a knob for
// its height. Dragging them edits the document; the obstacle follows by the server's word.

import { THREE } from "three";
import { Lines } from "/page/lines.js";
import { DISC, Marks, SQUARE } from "/page/marks.js";
import { ObstacleEdit } from "/page/obstacle_edit.js";

const OUTLINE = "#ffd166";
const KNOB = "#ffffff";
const RING = "#6cb4ee";
const KNOB_PIXELS = 13;
const REACH_MOUSE = 13; // pixels about a knob that still take it
const REACH_TOUCH = 26;
const RING_STEPS = 48;
const RING_SIZE = 1.45; // of the way to the farthest corner
const STALK = 0.4; // of the ring's radius: how far over the top the knob for the height is
const SMALL = 0.16; // of the obstacle's size on the screen: knobs take no more, so it can be held
const TURN_SNAP = Math.PI / 12; // with Ctrl

// Corners of the unit box, and its edges as pairs of them.
const CORNERS = [0, 1, 2, 3, 4, 5, 6, 7].map((n) => [n & 1 ? 0.5 : -0.5, n & 2 ? 0.5 : -0.5, n & 4 ? 0.5 : -0.5]);
const UPPER = [2, 3, 6, 7];
const EDGES = CORNERS.flatMap((_, i) => [1, 2, 4].filter((bit) => !(i & bit)).map((bit) => [i, i | bit]));

export class Handles {
  constructor(scene, store, obstacles, ground, rays, note) {
    Object.assign(this, { store, obstacles, ground, rays, note });
    this.lines = new Lines(scene, { width: 2, over: true, order: 15 });
    this.knobs = new Marks(scene, { over: true, facing: true, leastPixels: KNOB_PIXELS, order: 16 });
    this.index = null;
    this.listeners = new Set();
    this.edit = null; // under way
    this.corners = new Float32Array(24);
    this.bounds = new THREE.Box3();
    this.place = new THREE.Vector3();
    this.next = new THREE.Vector3();
    store.on("document", ({ document }) => {
      if (this.index !== null && this.index >= document.obstacle.length) this.select(null);
    });
  }

  onSelect(listener) {
    this.listeners.add(listener);
  }

  select(index) {
    if (index === this.index) return;
    this.index = index;
    for (const listener of this.listeners) listener(index);
  }

  get mesh() {
    return this.index === null || this.obstacles.past ? undefined : this.obstacles.meshes[this.index];
  }

  get obstacle() {
    return this.store.wanted.obstacle[this.index];
  }

  // Draw them where the obstacle is now.
  update() {
    this.lines.clear();
    this.knobs.clear();
    if (this.mesh) this.draw(this.mesh);
    this.lines.commit();
    this.knobs.commit();
  }

  // Where its corners are, and the ring about it.
  measure(mesh) {
    const { corners, place } = this;
    mesh.updateMatrixWorld();
    if (!mesh.geometry.boundingBox) mesh.geometry.computeBoundingBox();
    this.bounds.copy(mesh.geometry.boundingBox);
    CORNERS.forEach(([x, y, z], i) => {
      this.bounds.getCenter(place);
      place.x += x * (this.bounds.max.x - this.bounds.min.x);
      place.y += y * (this.bounds.max.y - this.bounds.min.y);
      place.z += z * (this.bounds.max.z - this.bounds.min.z);
      place.applyMatrix4(mesh.matrixWorld).toArray(corners, 3 * i);
    });
    this.ringRadius = 0;
    this.ringHeight = Infinity;
    for (let i = 0; i < 24; i += 3) {
      const away = Math.hypot(corners[i] - mesh.position.x, corners[i + 2] - mesh.position.z);
      this.ringRadius = Math.max(this.ringRadius, RING_SIZE * away);
      this.ringHeight = Math.min(this.ringHeight, corners[i + 1]);
    }
  }

  draw(mesh) {
    const { lines, knobs, corners, place } = this;
    this.measure(mesh);
    lines.colour(OUTLINE, 0.95);
    for (const [i, j] of EDGES) lines.between(corners, i, j);
    if (this.canTurn) this.drawRing(mesh);
    for (const i of UPPER) {
      knobs.addHex(corners[3 * i], corners[3 * i + 1], corners[3 * i + 2], 0, KNOB, 1, SQUARE);
    }
    const knob = this.heightPlace(place);
    lines.add(knob.x, knob.y - STALK * this.ringRadius, knob.z, knob.x, knob.y, knob.z);
    knobs.addHex(knob.x, knob.y, knob.z, 0, OUTLINE, 1, DISC);
  }

  get canTurn() {
    return this.obstacle?.shape !== "sphere";
  }

  // The knob for its height, over the middle of its upper side.
  heightPlace(out) {
    const { corners } = this;
    out.set(0, STALK * this.ringRadius, 0);
    for (const i of UPPER) {
      out.x += corners[3 * i] / 4;
      out.y += corners[3 * i + 1] / 4;
      out.z += corners[3 * i + 2] / 4;
    }
    return out;
  }

  drawRing(mesh) {
    const { lines } = this;
    lines.colour(RING, 0.95);
    for (let s = 0; s < RING_STEPS; s++) {
      const a = this.ringPlace(this.place, (2 * Math.PI * s) / RING_STEPS);
      const b = this.ringPlace(this.next, (2 * Math.PI * (s + 1)) / RING_STEPS);
      lines.add(a.x, a.y, a.z, b.x, b.y, b.z);
    }
    const knob = this.ringPlace(this.place, headingOf(mesh.quaternion));
    this.knobs.addHex(knob.x, knob.y, knob.z, 0, RING, 1, DISC);
  }

  ringPlace(out, heading) {
    const { x, z } = this.mesh.position;
    return out.set(
      x + this.ringRadius * Math.sin(heading), this.ringHeight, z + this.ringRadius * Math.cos(heading),
    );
  }

  // Which handle an event is on: {part, ...} or null.
  at(event) {
    if (!this.mesh) return null;
    this.measure(this.mesh); // where it is now, not where it was drawn last
    const reach = event.pointerType === "touch" ? REACH_TOUCH : REACH_MOUSE;
    const { rays, place } = this;
    if (rays.pixelsFrom(this.heightPlace(place), event) < reach) return { part: "height" };
    const least = Math.min(reach, Math.max(SMALL * this.pixelsWide(), 5));
    for (const i of UPPER) {
      place.fromArray(this.corners, 3 * i);
      if (rays.pixelsFrom(place, event) < least) return { part: "corner", corner: i };
    }
    // Where the ring passes before it or behind it, the obstacle itself is meant.
    this.rays.aim(event);
    if (!this.canTurn || this.rays.obstacle()?.index === this.index) return null;
    return this.onRing(event, reach) ? { part: "ring", height: this.ringHeight } : null;
  }

  // How large it looks: between two opposite corners of its upper side.
  pixelsWide() {
    const [ax, ay] = this.rays.pixelsOf(this.place.fromArray(this.corners, 3 * UPPER[0]));
    const [bx, by] = this.rays.pixelsOf(this.place.fromArray(this.corners, 3 * UPPER[3]));
    return Math.hypot(bx - ax, by - ay);
  }

  onRing(event, reach) {
    for (let s = 0; s < 2 * RING_STEPS; s++) {
      this.ringPlace(this.place, (Math.PI * s) / RING_STEPS);
      if (this.rays.pixelsFrom(this.place, event) < 0.8 * reach) return true;
    }
    return false;
  }

  begin(grip, event) {
    this.edit = new ObstacleEdit(this.store, this.index, this.mesh, this.ground);
    this.grip = grip;
    this.rays.aim(event);
    const plane = this.edit.plane(grip, this.corners, this.rays.cameras.camera);
    this.plane = plane;
    this.began = this.rays.planePlace(plane);
  }

  move(event) {
    this.rays.aim(event);
    const place = this.rays.planePlace(this.plane);
    if (!place || !this.began) return;
    switch (this.grip.part) {
      case "body":
        this.note(this.edit.shift(place.x - this.began.x, place.z - this.began.z), event);
        break;
      case "ring":
        this.note(this.edit.turn(this.began, place, event.ctrlKey ? TURN_SNAP : 0), event);
        break;
      case "corner":
        this.note(this.edit.corner(CORNERS[this.grip.corner], place.sub(this.began), event), event);
        break;
      default:
        this.note(this.edit.height(place.y - this.began.y), event);
    }
  }

  end() {
    this.edit = null;
    this.note("");
  }

  // As it was before the drag.
  cancel() {
    if (this.edit.changed) this.edit.restore();
    this.end();
  }

  remove() {
    if (this.index === null) return;
    const { index } = this;
    this.select(null);
    this.store.edit(["obstacle", index], null);
  }
}

function headingOf({ x, y, z, w }) {
  return Math.atan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y));
}
