// One drag on an obstacle: what it was when it was taken, and what the drag makes of it. Each edit
// is of the whole obstacle, so that size and place change at once.

import { THREE } from "three";
import { Gesture } from "/page/gesture.js";

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

  // Drag a corner ([+-0.5] x 3) by `move`; the opposite corner stays, or with Alt the centre.
  corner(corner, move, symmetric) {
    const local = move.applyQuaternion(this.rotation.clone().invert());
    const size = [...this.before.size];
    for (const axis of [0, 2]) {
      const grown = 2 * corner[axis] * local.getComponent(axis) * (symmetric ? 2 : 1);
      size[axis] = Math.max(this.before.size[axis] + grown, SMALLEST * this.leg);
    }
    // What is round stays round: it goes by the side that was dragged further.
    if (this.before.shape !== "box" && this.before.shape !== "mesh") {
      const [dx, dz] = [size[0] - this.before.size[0], size[2] - this.before.size[2]];
      const axis = Math.abs(dx) > Math.abs(dz) ? 0 : 2;
      size[0] = size[2] = size[axis];
      if (this.before.shape === "sphere") size[1] = size[0];
    }
    return this.resize(size, symmetric ? [0, 0, 0] : [corner[0], 0, corner[2]]);
  }

  height(rise) {
    const size = [...this.before.size];
    size[1] = Math.max(size[1] + rise, SMALLEST * this.leg);
    if (this.before.shape === "sphere") size[0] = size[2] = size[1];
    return this.resize(size, [0, 0.5, 0]);
  }

  // `toward`: to which corner or side it grows; of a sphere what it lies on stays under it.
  resize(size, toward) {
    const was = this.before.size;
    const way = this.before.shape === "sphere" ? [toward[0], 0.5, toward[2]] : toward;
    const shift = new THREE.Vector3(
      way[0] * (size[0] - was[0]), way[1] * (size[1] - was[1]), way[2] * (size[2] - was[2]),
    ).applyQuaternion(this.rotation);
    const [x, y, z] = this.before.position;
    this.send({ size: rounded(size), position: rounded([x + shift.x, y + shift.y, z + shift.z]) });
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

// To a hundredth of a millimetre: what a hand means, and short in a saved scene.
function rounded(numbers) {
  return numbers.map((number) => Number(number.toFixed(5)));
}
