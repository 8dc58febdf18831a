// Many quads in one draw call, each with a few numbers of its own, which stand at all its corners.
// They are no instances: without a GPU each instance is as dear as a draw call.

import { THREE } from "three";

const CORNERS = 4;

export class Quads {
  // `parts` are [name, length] of the shader's attributes, in the order of `put`'s numbers; `across`
  // are x and y of the corners, going round, for the attribute `position`.
  constructor(scene, { material, parts, across, order }) {
    this.parts = parts;
    this.across = across;
    this.stride = parts.reduce((sum, [, length]) => sum + length, 0);
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mesh.frustumCulled = false; // where they are only the shader knows
    this.mesh.renderOrder = order;
    this.capacity = 0;
    this.count = 0;
    this.grow(32);
    scene.add(this.mesh);
  }

  grow(capacity) {
    const rows = new Float32Array(CORNERS * this.stride * capacity);
    if (this.capacity) {
      rows.set(this.rows);
      this.mesh.geometry.dispose();
    }
    this.rows = rows;
    this.capacity = capacity;
    this.buffer = new THREE.InterleavedBuffer(rows, this.stride);
    this.buffer.setUsage(THREE.DynamicDrawUsage);
    const geometry = new THREE.BufferGeometry();
    let offset = 0;
    for (const [name, length] of this.parts) {
      geometry.setAttribute(name, new THREE.InterleavedBufferAttribute(this.buffer, length, offset));
      offset += length;
    }
    const corners = new Float32Array(3 * CORNERS * capacity);
    const triangles = new Uint32Array(6 * capacity);
    for (let q = 0; q < capacity; q++) {
      for (let i = 0; i < CORNERS; i++) corners.set(this.across[i], 3 * (CORNERS * q + i));
      triangles.set([0, 1, 2, 0, 2, 3].map((i) => CORNERS * q + i), 6 * q);
    }
    geometry.setAttribute("position", new THREE.BufferAttribute(corners, 3));
    geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    geometry.setDrawRange(0, 6 * this.count);
    this.mesh.geometry = geometry;
  }

  clear() {
    this.count = 0;
    return this;
  }

  // Make room for one more, and return where its numbers go: the same at `stride` further on, for
  // each corner.
  next() {
    if (this.count === this.capacity) this.grow(2 * this.capacity);
    this.count += 1;
    return CORNERS * this.stride * (this.count - 1);
  }

  // The numbers of the first corner hold for all.
  spread(at) {
    const { rows, stride } = this;
    for (let i = 1; i < CORNERS; i++) rows.copyWithin(at + i * stride, at, at + stride);
  }

  // Show what was added since `clear`.
  commit() {
    this.mesh.geometry.setDrawRange(0, 6 * this.count);
    this.mesh.visible = this.count > 0;
    if (this.count === 0) return;
    this.buffer.clearUpdateRanges();
    this.buffer.addUpdateRange(0, CORNERS * this.stride * this.count);
    this.buffer.needsUpdate = true;
  }
}
