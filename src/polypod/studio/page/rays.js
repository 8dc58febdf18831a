// What the pointer points at: ground, an obstacle, a creature's skin.

import { THREE } from "three";

const NEAR = 26; // pixels from a body's middle at which a creature is meant although it was missed

export class Rays {
  constructor(cameras, canvas, { ground, obstacles, creatures }) {
    Object.assign(this, { cameras, canvas, ground, obstacles, creatures });
    this.caster = new THREE.Raycaster();
    this.pointer = new THREE.Vector2();
    this.posed = new Float32Array(0);
    this.local = new THREE.Ray();
    this.box = new THREE.Box3();
    this.turn = new THREE.Quaternion();
    this.a = new THREE.Vector3();
    this.b = new THREE.Vector3();
    this.c = new THREE.Vector3();
    this.hit = new THREE.Vector3();
  }

  get ray() {
    return this.caster.ray;
  }

  // Aim at where an event happened; pixels of the page.
  aim({ clientX, clientY }) {
    const frame = this.canvas.getBoundingClientRect();
    this.at(
      (2 * (clientX - frame.left)) / frame.width - 1,
      1 - (2 * (clientY - frame.top)) / frame.height,
    );
  }

  // Aim at a place of the picture, both from -1 to 1.
  at(x, y) {
    this.pointer.set(x, y);
    this.caster.setFromCamera(this.pointer, this.cameras.camera);
  }

  // Where it meets the ground, or null; what lies too far away counts as sky.
  groundPlace() {
    const size = this.cameras.size || 1;
    const place = new THREE.Vector3();
    if (!this.ground.relief.meet(this.ray, 0.1 * size, place)) return null;
    return place.distanceTo(this.cameras.centre) < 400 * size ? place : null;
  }

  // Where it meets a plane, or null.
  planePlace(plane) {
    return this.ray.intersectPlane(plane, new THREE.Vector3());
  }

  obstacle() {
    if (this.obstacles.past) return null;
    const [hit] = this.caster.intersectObjects(this.obstacles.meshes, false);
    if (!hit) return null;
    return { index: hit.object.userData.obstacle, point: hit.point, distance: hit.distance };
  }

  // The nearest creature whose skin it meets: {kind, creature, point, distance}, or null.
  creature() {
    let nearest = null;
    this.creatures.herds.forEach((herd, kind) => {
      if (!herd.arrays || !herd.posed) return;
      for (let c = 0; c < herd.count; c++) {
        if (!this.meetsBox(herd, c)) continue;
        const distance = this.meetSkin(herd, c);
        if (distance < (nearest?.distance ?? Infinity)) {
          nearest = { kind, creature: c, distance, point: this.ray.at(distance, new THREE.Vector3()) };
        }
      }
    });
    return nearest ?? this.nearBody();
  }

  // Legs reach beyond where they are at rest, so the box is taken a good deal larger.
  meetsBox(herd, c) {
    const at = herd.bodyAt(c);
    const { poses, box } = herd;
    this.turn.set(-poses[at], -poses[at + 1], -poses[at + 2], poses[at + 3]);
    this.a.set(poses[at + 4], poses[at + 5], poses[at + 6]);
    this.local.origin.copy(this.ray.origin).sub(this.a).applyQuaternion(this.turn);
    this.local.direction.copy(this.ray.direction).applyQuaternion(this.turn);
    this.box.min.set(box[0], box[1], box[2]);
    this.box.max.set(box[3], box[4], box[5]);
    this.box.expandByVector(this.box.getSize(this.b).multiplyScalar(0.25));
    return this.local.intersectsBox(this.box);
  }

  // How far along the ray the skin of a creature is, as it is posed now; Infinity where it is not.
  meetSkin(herd, c) {
    const { place, triangles } = herd.arrays;
    const corners = this.pose(herd, c);
    let nearest = Infinity;
    for (let t = 0; t < triangles.data.length; t += 3) {
      this.a.fromArray(corners, 3 * triangles.data[t]);
      this.b.fromArray(corners, 3 * triangles.data[t + 1]);
      this.c.fromArray(corners, 3 * triangles.data[t + 2]);
      if (this.ray.intersectTriangle(this.a, this.b, this.c, false, this.hit)) {
        nearest = Math.min(nearest, this.hit.distanceTo(this.ray.origin));
      }
    }
    return place.data.length ? nearest : Infinity;
  }

  // The vertices of a creature, as the shader poses them.
  pose(herd, c) {
    const { place, joint, weight } = herd.arrays;
    const { poses } = herd;
    if (this.posed.length < place.data.length) this.posed = new Float32Array(place.data.length);
    const out = this.posed;
    out.fill(0);
    for (let v = 0; v < place.shape[0]; v++) {
      const px = place.data[3 * v], py = place.data[3 * v + 1], pz = place.data[3 * v + 2];
      for (let n = 4 * v; n < 4 * v + 4; n++) {
        const share = weight.data[n];
        if (share === 0) continue;
        const o = c * herd.stride + 8 * joint.data[n];
        const qx = poses[o], qy = poses[o + 1], qz = poses[o + 2], qw = poses[o + 3];
        const tx = 2 * (qy * pz - qz * py);
        const ty = 2 * (qz * px - qx * pz);
        const tz = 2 * (qx * py - qy * px);
        out[3 * v] += share * (px + qw * tx + qy * tz - qz * ty + poses[o + 4]);
        out[3 * v + 1] += share * (py + qw * ty + qz * tx - qx * tz + poses[o + 5]);
        out[3 * v + 2] += share * (pz + qw * tz + qx * ty - qy * tx + poses[o + 6]);
      }
    }
    return out;
  }

  // A creature that looks tiny, or a thick finger: its body's middle is near enough.
  nearBody() {
    const { camera } = this.cameras;
    const height = this.canvas.clientHeight;
    const width = this.canvas.clientWidth;
    let nearest = null;
    let least = NEAR;
    this.creatures.herds.forEach((herd, kind) => {
      for (let c = 0; herd.posed && c < herd.count; c++) {
        this.a.fromArray(herd.poses, herd.bodyAt(c) + 4);
        const distance = this.a.distanceTo(camera.position);
        this.b.copy(this.a).project(camera);
        if (this.b.z > 1) continue;
        const off = Math.hypot(
          ((this.b.x - this.pointer.x) * width) / 2, ((this.b.y - this.pointer.y) * height) / 2,
        );
        if (off < least) {
          least = off;
          nearest = { kind, creature: c, distance, point: this.a.clone() };
        }
      }
    });
    return nearest;
  }

  // Where a place of the world is on the page, [x, y] in pixels; far off where it is behind the eye.
  pixelsOf(place) {
    const frame = this.canvas.getBoundingClientRect();
    const { x, y, z } = this.b.copy(place).project(this.cameras.camera);
    if (z > 1) return [Infinity, Infinity];
    return [frame.left + ((x + 1) * frame.width) / 2, frame.top + ((1 - y) * frame.height) / 2];
  }

  pixelsFrom(place, { clientX, clientY }) {
    const [x, y] = this.pixelsOf(place);
    return Math.hypot(clientX - x, clientY - y);
  }
}
