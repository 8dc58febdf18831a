// One drag on an obstacle: what it was when it was taken, and what the drag makes of it. Each edit
// is of the whole obstacle, so that size and place change at once.

import { THREE } from "three";
import { Gesture } from "/page/gesture.js";
import { extentOf, resized, rounded, withSide } from "/page/obstacle_size.js";

const SMALLEST = 0.02; // leg lengths
const UP = new THREE.Vector3(0, 1, 0);

export class ObstacleEdit {
  constructor(store, index, mesh, ground) {
    Object.assign(this, { store, index, ground });
    this.gesture = new Gesture(store);
    this.before = structuredClone(store.wanted.obstacle[index]);
    // What moves by itself is not where the document has it begin.
    this.centre = mesh.position.clone();
    this.rotation = mesh.quaternion.clone();
    this.size = extentOf(this.before).size;
    this.leg = store.creature?.leg_length ?? 1;
    this.changed = false;
  }

  // The plane in which a handle is dragged.
  plane(grip, corners, camera) {
    const through = this.centre.clone();
    if (grip.part === "corner") through.fromArray(corners, 3 * grip.corner);
    if (grip.part === "ring") through.y = grip.height;
    if (grip.part !== "height") return new THREE.Plane().setFromNormalAndCoplanarPoint(UP, through);
    // Upright, and facing the viewer.
    const normal = camera.position.clone().sub(through).setY(0).normalize();
    if (normal.lengthSq() === 0) normal.set(0, 0, 1);
    return new THREE.Plane().setFromNormalAndCoplanarPoint(normal, through);
  }

  send(change) {
    this.changed = true;
    this.gesture.edit(["obstacle", this.index], { ...this.before, ...change });
  }

  restore() {
    this.send({});
  }

  // Along the ground, rising and falling with it. Returns words for it, as all of these do.
  shift(x, z) {
    const { relief } = this.ground;
    const [px, py, pz] = this.before.position;
    const rise = relief.height(px + x, pz + z) - relief.height(px, pz);
    this.send({ position: rounded([px + x, py + rise, pz + z]) });
    return `${(px + x).toFixed(2)}, ${(pz + z).toFixed(2)} m`;
  }

  turn(began, place, snap) {
    const angleOf = ({ x, z }) => Math.atan2(x - this.centre.x, z - this.centre.z);
    let angle = angleOf(place) - angleOf(began);
    if (snap) angle = Math.round(angle / snap) * snap;
    this.send(turned(this.before, angle));
    const degrees = (180 / Math.PI) * Math.atan2(Math.sin(angle), Math.cos(angle));
    return `${degrees.toFixed(0)}°`;
  }

  // Drag a corner ([+-0.5] x 3) by `move`; the opposite corner stays, or with Alt the centre. With
  // Shift all sides grow alike.
  corner(corner, move, { altKey: symmetric, shiftKey: alike }) {
    const local = move.applyQuaternion(this.rotation.clone().invert());
    const grown = (axis) => Math.max(
      this.size[axis] + 2 * corner[axis] * local.getComponent(axis) * (symmetric ? 2 : 1),
      this.smallest,
    );
    const [x, z] = [grown(0), grown(2)];
    // What must stay alike goes by the side that was dragged further.
    const axis = Math.abs(x - this.size[0]) > Math.abs(z - this.size[2]) ? 0 : 2;
    const side = axis === 0 ? x : z;
    let size = [x, this.size[1], z];
    if (alike) size = this.size.map((value) => (value * side) / this.size[axis]);
    else if (this.round) size = withSide(this.before, this.size, axis, side);
    return this.resize(size, symmetric ? [0, 0, 0] : [corner[0], alike ? 0.5 : 0, corner[2]]);
  }

  height(rise) {
    const side = Math.max(this.size[1] + rise, this.smallest);
    return this.resize(withSide(this.before, this.size, 1, side), [0, 0.5, 0]);
  }

  get round() {
    return ["sphere", "cylinder"].includes(this.before.shape);
  }

  get smallest() {
    return SMALLEST * this.leg;
  }

  // `toward`: to which corner or side it grows; of a sphere what it lies on stays under it.
  resize(size, toward) {
    const way = this.before.shape === "sphere" ? [toward[0], 0.5, toward[2]] : toward;
    const shift = way.map((share, axis) => share * (size[axis] - this.size[axis]));
    const turn = (vector) => new THREE.Vector3(...vector).applyQuaternion(this.rotation).toArray();
    this.send(resized(this.before, size, shift, turn));
    return size.map((side) => side.toFixed(2)).join(" × ") + " m";
  }
}

// Keys and values of an obstacle turned about the vertical by `angle` [rad].
export function turned(obstacle, angle) {
  if (!obstacle.rotation) return { yaw: wrapped((obstacle.yaw ?? 0) + angle) };
  const turn = new THREE.Quaternion().setFromAxisAngle(UP, angle);
  turn.multiply(new THREE.Quaternion(...obstacle.rotation)).normalize();
  return { rotation: turn.toArray() };
}

function wrapped(angle) {
  return Number(Math.atan2(Math.sin(angle), Math.cos(angle)).toFixed(5));
}
