// Lines of a width in pixels, all in one draw call: WebGL's own are a pixel wide. Colours go to the
// screen as they are, without light or fog, so that they are those of the panels.

import { THREE } from "three";

const VERTEX = `
uniform vec2 resolution;
uniform float width;
uniform float lift;
attribute vec3 start;
attribute vec3 end;
attribute vec4 tint;
varying vec4 vTint;
void main() {
  vTint = tint;
  vec4 a = modelViewMatrix * vec4(start, 1.0);
  vec4 b = modelViewMatrix * vec4(end, 1.0);
  // What reaches behind the eye ends in front of it.
  float near = projectionMatrix[3][2] / (projectionMatrix[2][2] - 1.0);
  if (a.z > -near) a = mix(a, b, clamp((a.z + near) / (a.z - b.z), 0.0, 1.0));
  if (b.z > -near) b = mix(b, a, clamp((b.z + near) / (b.z - a.z), 0.0, 1.0));
  a = projectionMatrix * a;
  b = projectionMatrix * b;
  vec2 along = (b.xy / b.w - a.xy / a.w) * resolution;
  float size = length(along);
  along = size > 1e-6 ? along / size : vec2(1.0, 0.0);
  vec4 at = position.x < 0.5 ? a : b;
  // Half a width further at both ends, so that the joints of a polyline close.
  vec2 offset = vec2(-along.y, along.x) * position.y + along * (2.0 * position.x - 1.0) * 0.5;
  at.xy += offset * width / resolution * at.w;
  at.z -= lift * at.w;
  gl_Position = at;
}`;

const FRAGMENT = `
varying vec4 vTint;
void main() { gl_FragColor = vTint; }`;

// Two triangles: x along the line, y across it.
const CORNERS = new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, -1, 0, 1, 1, 0, 0, 1, 0]);

// Shared by all lines: the size of the picture in pixels of the screen.
export const resolution = { value: new THREE.Vector2(1, 1) };

export class Lines {
  // `over`: drawn over everything, else hidden by what is in front.
  constructor(scene, { width = 2, over = false, order = 10 } = {}) {
    this.material = new THREE.ShaderMaterial({
      uniforms: { resolution, width: { value: width }, lift: { value: over ? 0 : 2e-4 } },
      vertexShader: VERTEX, fragmentShader: FRAGMENT,
      transparent: true, depthTest: !over, depthWrite: false, side: THREE.DoubleSide,
    });
    this.mesh = new THREE.Mesh(new THREE.InstancedBufferGeometry(), this.material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = over ? order + 100 : order;
    this.capacity = 0;
    this.count = 0;
    this.tint = new Float32Array(4);
    this.grow(64);
    scene.add(this.mesh);
  }

  grow(capacity) {
    const ends = new Float32Array(6 * capacity);
    const tints = new Float32Array(4 * capacity);
    if (this.capacity) {
      ends.set(this.ends);
      tints.set(this.tints);
      this.mesh.geometry.dispose();
    }
    this.ends = ends;
    this.tints = tints;
    this.capacity = capacity;
    const geometry = new THREE.InstancedBufferGeometry();
    this.endBuffer = new THREE.InstancedInterleavedBuffer(ends, 6);
    this.endBuffer.setUsage(THREE.DynamicDrawUsage);
    this.tintBuffer = new THREE.InstancedBufferAttribute(tints, 4);
    this.tintBuffer.setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute("position", new THREE.BufferAttribute(CORNERS, 3));
    geometry.setAttribute("start", new THREE.InterleavedBufferAttribute(this.endBuffer, 3, 0));
    geometry.setAttribute("end", new THREE.InterleavedBufferAttribute(this.endBuffer, 3, 3));
    geometry.setAttribute("tint", this.tintBuffer);
    geometry.instanceCount = this.count;
    this.mesh.geometry = geometry;
  }

  clear() {
    this.count = 0;
    return this;
  }

  // The colour of what is added from now on: "#rrggbb".
  colour(hex, alpha = 1) {
    const { tint } = this;
    for (let i = 0; i < 3; i++) tint[i] = hexPart(hex, i);
    tint[3] = alpha;
    return this;
  }

  add(ax, ay, az, bx, by, bz) {
    if (this.count === this.capacity) this.grow(2 * this.capacity);
    const { ends, tints, tint } = this;
    let at = 6 * this.count;
    ends[at++] = ax; ends[at++] = ay; ends[at++] = az;
    ends[at++] = bx; ends[at++] = by; ends[at++] = bz;
    tints.set(tint, 4 * this.count);
    this.count += 1;
  }

  // A polyline through points [N, 3] of a flat array, from number `first` to before `after`.
  through(points, first, after) {
    for (let i = first; i + 1 < after; i++) this.between(points, i, i + 1);
  }

  between(points, i, j) {
    this.add(
      points[3 * i], points[3 * i + 1], points[3 * i + 2],
      points[3 * j], points[3 * j + 1], points[3 * j + 2],
    );
  }

  // Show what was added since `clear`.
  commit() {
    this.mesh.geometry.instanceCount = this.count;
    this.mesh.visible = this.count > 0;
    if (this.count === 0) return;
    this.endBuffer.clearUpdateRanges();
    this.endBuffer.addUpdateRange(0, 6 * this.count);
    this.endBuffer.needsUpdate = true;
    this.tintBuffer.clearUpdateRanges();
    this.tintBuffer.addUpdateRange(0, 4 * this.count);
    this.tintBuffer.needsUpdate = true;
  }
}

// One of the three parts of "#rrggbb", 0 to 1, without making a string of it.
export function hexPart(hex, i) {
  return (digit(hex.charCodeAt(1 + 2 * i)) * 16 + digit(hex.charCodeAt(2 + 2 * i))) / 255;
}

function digit(code) {
  return code < 58 ? code - 48 : (code | 32) - 87;
}
