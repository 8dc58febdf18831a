// Crates and what else lies about: shapes from the document, places from the frames.

import { THREE } from "three";
import { decodeArrays } from "/page/frames.js";
import { hullTriangles } from "/page/hull.js";
import { blendPose } from "/page/playback.js";

const CRATE = 0xccaa78;
const FORBIDDEN = 0xd14036;

const UNIT = {
  box: new THREE.BoxGeometry(1, 1, 1),
  cylinder: new THREE.CylinderGeometry(0.5, 0.5, 1, 40),
  sphere: new THREE.SphereGeometry(0.5, 32, 20),
};

export class Obstacles {
  constructor(scene, store) {
    this.store = store;
    this.group = new THREE.Group();
    scene.add(this.group);
    this.meshes = [];
    this.keys = [];
    this.out = new Float32Array(7);
    this.crate = new THREE.MeshLambertMaterial({ color: CRATE });
    this.forbidden = new THREE.MeshLambertMaterial({ map: stripes() });
    this.geometries = new Map(); // of meshes from files, by their names in documents
    for (const kind of ["document", "backdrop"]) store.on(kind, () => this.match(this.wanted));
  }

  // What stands in the frame that is shown: the tape may be of a time when there was less, or more.
  get wanted() {
    return this.store.backdrop.obstacle ?? this.store.document?.obstacle ?? [];
  }

  // Whether they are another time's: they cannot be taken hold of then.
  get past() {
    return this.store.backdrop.obstacle !== null;
  }

  // Leave out what lies before a plane.
  clip(plane) {
    this.crate.clippingPlanes = this.forbidden.clippingPlanes = [plane];
  }

  // Make the meshes those of the document, and leave alone what did not change its shape.
  match(list) {
    while (this.meshes.length > list.length) this.remove(this.meshes.length - 1);
    list.forEach((obstacle, i) => {
      const key = JSON.stringify([obstacle.shape, obstacle.points, obstacle.file]);
      if (this.keys[i] !== key) {
        if (this.meshes[i]) this.drop(this.meshes[i]);
        this.meshes[i] = this.mesh(obstacle, i);
        this.keys[i] = key;
        this.group.add(this.meshes[i]);
        this.place(i, obstacle);
      }
      const mesh = this.meshes[i];
      mesh.material = obstacle.forbidden ? this.forbidden : this.crate;
      const [x, y, z] = obstacle.shape === "hull" ? [1, 1, 1] : obstacle.size ?? [1, 1, 1];
      mesh.scale.set(x, y, z);
    });
  }

  remove(i) {
    this.drop(this.meshes[i]);
    this.meshes.length = this.keys.length = i;
  }

  drop(mesh) {
    this.group.remove(mesh);
    if (mesh.userData.own) mesh.geometry.dispose();
  }

  mesh(obstacle, i) {
    const own = obstacle.shape === "hull";
    const geometry = own ? hullGeometry(obstacle.points) : UNIT[obstacle.shape] ?? new THREE.BufferGeometry();
    const mesh = new THREE.Mesh(geometry, this.crate);
    mesh.userData = { own, obstacle: i };
    mesh.castShadow = true;
    mesh.receiveShadow = true;
    if (obstacle.shape === "mesh") this.fill(mesh, obstacle.file);
    return mesh;
  }

  // What a file holds, its box of size 1, once it has come; the box itself where it does not.
  async fill(mesh, file) {
    if (!this.geometries.has(file)) this.geometries.set(file, this.fetch(file));
    mesh.geometry = await this.geometries.get(file);
  }

  async fetch(file) {
    try {
      const answer = await this.store.fetch(`/mesh/${encodeURIComponent(file)}`);
      const { place, normal } = decodeArrays(await answer.arrayBuffer()).arrays;
      return solidGeometry(place.data, normal.data);
    } catch (problem) {
      this.store.say(`A mesh did not come: ${problem.message}`);
      this.geometries.delete(file);
      return UNIT.box;
    }
  }

  // Until a frame says where it is: where the document has it begin.
  place(i, obstacle) {
    const { position, rotation, quaternion } = obstacleStart(obstacle);
    this.meshes[i].position.set(...position);
    this.meshes[i].quaternion.set(...(rotation ?? quaternion));
  }

  update({ from, to, share }) {
    const count = Math.min(this.meshes.length, to.obstacles.length / 7);
    const before = from.obstacles.length === to.obstacles.length ? from : to;
    const { out } = this;
    for (let i = 0; i < count; i++) {
      blendPose(out, 0, before.obstacles, to.obstacles, i, share);
      const mesh = this.meshes[i];
      mesh.quaternion.set(out[0], out[1], out[2], out[3]);
      mesh.position.set(out[4], out[5], out[6]);
    }
  }
}

// Where an obstacle of the document begins, and how it is turned there.
export function obstacleStart(obstacle) {
  const yaw = obstacle.yaw ?? 0;
  return {
    position: obstacle.position,
    rotation: obstacle.rotation,
    quaternion: [0, Math.sin(yaw / 2), 0, Math.cos(yaw / 2)],
  };
}

function hullGeometry(points) {
  return solidGeometry(hullTriangles(points));
}

// Triangles [T * 9] with normals, or flat ones.
function solidGeometry(places, normals) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
  // Stripes run across it in plan, as they do on the sides of a box.
  const plan = new Float32Array((places.length / 3) * 2);
  for (let i = 0; i < places.length / 3; i++) {
    plan[2 * i] = 3 * (places[3 * i] + places[3 * i + 1]);
    plan[2 * i + 1] = 3 * (places[3 * i + 2] + places[3 * i + 1]);
  }
  geometry.setAttribute("uv", new THREE.BufferAttribute(plan, 2));
  if (normals) geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
  else geometry.computeVertexNormals();
  return geometry;
}

// Forbidden is told by stripes too, not by colour alone.
function stripes() {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const pen = canvas.getContext("2d");
  pen.fillStyle = `#${FORBIDDEN.toString(16)}`;
  pen.fillRect(0, 0, 64, 64);
  pen.strokeStyle = "#5a1712";
  pen.lineWidth = 14;
  for (let x = -64; x <= 128; x += 32) {
    pen.beginPath();
    pen.moveTo(x - 8, 72);
    pen.lineTo(x + 72, -8);
    pen.stroke();
  }
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.anisotropy = 4;
  return texture;
}
