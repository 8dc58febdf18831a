// All creatures: a herd for each kind, drawn in three calls: those near by, those that look small, and
// those that look tiny. Who is out of sight is not drawn at all.

import { THREE } from "three";
import { blendPose } from "/page/playback.js";
import { decodeArrays } from "/page/frames.js";
import { COARSE, coarsened, CRUDE } from "/page/coarse.js";
import { coverMesh, decodePictures } from "/page/pictures.js";
import { dropMesh, herdMesh, poseTexture, showRows } from "/page/skinning.js";

const FINE = 300; // vertices: with fewer there are no coarser skins
const SHADOW = 3; // radii about a creature in which its shadow may still be seen

export class Creatures {
  constructor(scene, store) {
    this.scene = scene;
    this.store = store;
    this.frustum = new THREE.Frustum();
    this.matrix = new THREE.Matrix4();
    this.ball = new THREE.Sphere();
    this.herds = [];
    this.small = [0, 0]; // pixels high, below which a creature has its coarse and its crude skin
    this.skins = new Map(); // N: promise of a skin, and of its pictures
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
      this.dress(herd).catch((problem) => {
        // One that is gone meanwhile, as when much is undone at once, is missed by nobody.
        if (this.herds.includes(herd)) this.store.say(`A creature's skin did not come: ${problem.message}.`);
      });
    }
  }

  async dress(herd) {
    const { skin, pictures } = await this.skin(herd.skin);
    if (!this.herds.includes(herd)) return;
    herd.dress(this.scene, skin.arrays);
    this.store.tell("skin", herd.skin);
    const decoded = await pictures;
    if (!this.herds.includes(herd)) return;
    coverMesh(herd.skins[0], skin, decoded, herd.texture);
    this.store.tell("skin", herd.skin);
  }

  // What /skin/N says, fetched once, and its pictures, which are decoded meanwhile.
  skin(n) {
    if (!this.skins.has(n)) {
      const coming = this.store.fetch(`/skin/${n}`)
        .then((answer) => answer.arrayBuffer())
        .then((bytes) => {
          const skin = decodeArrays(bytes);
          return { skin, pictures: decodePictures(skin) };
        });
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

  // Choose who is drawn, and how finely, in a picture of `height` pixels.
  choose(camera, height) {
    camera.updateMatrixWorld();
    this.matrix.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    this.frustum.setFromProjectionMatrix(this.matrix);
    for (const herd of this.herds) if (herd.skins.length && herd.posed) this.chooseOf(herd, camera, height);
  }

  chooseOf(herd, camera, height) {
    const { ball, frustum, small } = this;
    const { skins } = herd;
    const rows = skins.map((mesh) => mesh.geometry.getAttribute("row").array);
    const counts = skins.map(() => 0);
    for (let c = 0; c < herd.count; c++) {
      ball.center.fromArray(herd.poses, herd.bodyAt(c) + 4);
      ball.radius = SHADOW * herd.radius;
      if (!frustum.intersectsSphere(ball)) continue;
      const distance = ball.center.distanceTo(camera.position);
      const pixels = (herd.radius * height * camera.projectionMatrix.elements[5]) / distance;
      const wanted = pixels < small[1] ? 2 : pixels < small[0] ? 1 : 0;
      const skin = Math.min(wanted, skins.length - 1);
      rows[skin][counts[skin]++] = c;
    }
    skins.forEach((mesh, n) => showRows(mesh, counts[n]));
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
    this.skins = []; // meshes: fine, coarse, crude
    this.posed = false;
    this.box = null; // [6] least and most of the skin at rest, body frame
    this.radius = 0; // m about the body that holds the skin
  }

  dress(scene, arrays) {
    this.arrays = arrays;
    this.box = boxOf(arrays.place.data);
    const [x0, y0, z0, x1, y1, z1] = this.box;
    this.radius = 0.5 * Math.hypot(x1 - x0, y1 - y0, z1 - z0);
    this.add(scene, arrays);
    if (arrays.place.shape[0] < FINE) return;
    for (const how of [COARSE, CRUDE]) this.add(scene, coarsened(arrays, this.radius, how));
  }

  add(scene, arrays) {
    const mesh = herdMesh(arrays, this.texture, this.count);
    this.skins.push(mesh);
    scene.add(mesh);
  }

  drop(scene) {
    this.texture.dispose();
    for (const mesh of this.skins) dropMesh(scene, mesh);
  }

  update(from, to, share) {
    const { poses } = this;
    const all = this.count * this.joints;
    for (let i = 0; i < all; i++) blendPose(poses, 8 * i, from.pose, to.pose, i, share);
    this.texture.needsUpdate = true;
    this.posed = true;
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
