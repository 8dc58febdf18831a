// All creatures: a herd for each kind, each drawn in one call.

import { blendPose } from "/page/playback.js";
import { decodeArrays } from "/page/frames.js";
import { herdMesh, poseTexture } from "/page/skinning.js";

export class Creatures {
  constructor(scene, store) {
    this.scene = scene;
    this.store = store;
    this.herds = [];
    this.skins = new Map(); // N: promise of arrays
    store.on("kinds", ({ kinds }) => this.rebuild(kinds));
  }

  rebuild(kinds) {
    // The same message tells of new ground; creatures that stay as they are stay.
    const same = kinds.length === this.herds.length && kinds.every(({ skin, count, joints }, h) => (
      this.herds[h].skin === skin && this.herds[h].count === count && this.herds[h].joints === joints
    ));
    if (same) return;
    for (const herd of this.herds) herd.drop(this.scene);
    this.herds = kinds.map(({ skin, count, joints }) => new Herd(skin, count, joints));
    const wanted = new Set(kinds.map(({ skin }) => skin));
    for (const n of this.skins.keys()) if (!wanted.has(n)) this.skins.delete(n);
    for (const herd of this.herds) {
      this.skin(herd.skin)
        .then((arrays) => { if (this.herds.includes(herd)) herd.dress(this.scene, arrays); })
        .catch((problem) => this.store.say(`A creature's skin did not come: ${problem.message}.`));
    }
  }

  // The arrays of /skin/N, fetched once.
  skin(n) {
    if (!this.skins.has(n)) {
      const coming = this.store.fetch(`/skin/${n}`)
        .then((answer) => answer.arrayBuffer())
        .then((bytes) => decodeArrays(bytes).arrays);
      coming.catch(() => this.skins.delete(n)); // asked for again the next time
      this.skins.set(n, coming);
    }
    return this.skins.get(n);
  }

  update({ from, to, share }) {
    for (let h = 0; h < this.herds.length; h++) {
      const herd = this.herds[h];
      const next = to.herds[h];
      // Frames of the creatures before may still be under way.
      if (!next || next.count !== herd.count || next.joints !== herd.joints) continue;
      herd.update(from.herds[h], next, share);
    }
  }

  // Where the poses of the creature in focus begin in its herd's array, or null.
  focus(frame) {
    const herd = this.herds[frame.focus.kind];
    if (!herd || !herd.posed || frame.focus.creature >= herd.count) return null;
    return { herd, row: frame.focus.creature };
  }
}

class Herd {
  constructor(skin, count, joints) {
    this.skin = skin;
    this.count = count;
    this.joints = joints; // the last is the body itself
    this.texture = poseTexture(count, joints);
    this.poses = this.texture.image.data; // [count, joints, 8]: quaternion, shift, spare
    this.stride = 8 * joints;
    this.arrays = null;
    this.mesh = null;
    this.posed = false;
    this.box = null; // [6] least and most of the skin at rest, body frame
    this.radius = 0; // m about the body that holds the skin
  }

  dress(scene, arrays) {
    this.arrays = arrays;
    this.box = boxOf(arrays.place.data);
    const [x0, y0, z0, x1, y1, z1] = this.box;
    this.radius = 0.5 * Math.hypot(x1 - x0, y1 - y0, z1 - z0);
    this.mesh = herdMesh(arrays, this.texture, this.count);
    this.mesh.visible = this.posed;
    scene.add(this.mesh);
  }

  drop(scene) {
    this.texture.dispose();
    if (!this.mesh) return;
    scene.remove(this.mesh);
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.mesh.customDepthMaterial.dispose();
  }

  update(from, to, share) {
    const { poses } = this;
    const all = this.count * this.joints;
    for (let i = 0; i < all; i++) blendPose(poses, 8 * i, from.pose, to.pose, i, share);
    this.texture.needsUpdate = true;
    this.posed = true;
    if (this.mesh) this.mesh.visible = true;
  }

  // Where body `c` begins in `poses`: quaternion, and its place four further.
  bodyAt(c) {
    return (c + 1) * this.stride - 8;
  }
}

function boxOf(places) {
  const box = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
  for (let i = 0; i < places.length; i++) {
    const axis = i % 3;
    if (places[i] < box[axis]) box[axis] = places[i];
    if (places[i] > box[axis + 3]) box[axis + 3] = places[i];
  }
  return box;
}
