// Marks: discs, rings, squares and diamonds, flat on the ground or facing the viewer, all in one
// draw call. Colours go to the screen as they are.

import { THREE } from "three";
import { hexPart, resolution } from "/page/lines.js";
import { Quads } from "/page/quads.js";

export const DISC = 0;
export const RING = 1;
export const SQUARE = 2;
export const DIAMOND = 3;

const VERTEX = `
uniform vec2 resolution;
uniform float lift;
uniform float facing;
uniform float leastPixels;
attribute vec3 place;
attribute vec2 size;
attribute vec4 tint;
attribute float shape;
varying vec2 across;
varying vec4 vTint;
varying float vShape;
void main() {
  across = position.xy;
  vTint = tint;
  vShape = shape;
  vec4 middle = modelViewMatrix * vec4(place, 1.0);
  // Half the picture is resolution.y / 2 pixels: nothing gets too small to be seen.
  float pixel = -2.0 * middle.z / (projectionMatrix[1][1] * resolution.y);
  vec2 extent = max(0.5 * size, 0.5 * leastPixels * pixel);
  vec4 at = facing > 0.5
    ? middle + vec4(across * extent, 0.0, 0.0)
    : modelViewMatrix * vec4(place + vec3(across.x * extent.x, 0.0, across.y * extent.y), 1.0);
  gl_Position = projectionMatrix * at;
  gl_Position.z -= lift * gl_Position.w;
}`;

const FRAGMENT = `
varying vec2 across;
varying vec4 vTint;
varying float vShape;
void main() {
  float away = vShape < 1.5 ? length(across)
    : vShape < 2.5 ? max(abs(across.x), abs(across.y)) : abs(across.x) + abs(across.y);
  if (away > 1.0) discard;
  if (vShape > 0.5 && vShape < 1.5 && away < 0.62) discard;
  float rim = vShape > 0.5 && vShape < 1.5 ? 0.0 : smoothstep(0.72, 0.9, away);
  gl_FragColor = vec4(vTint.rgb * (1.0 - 0.35 * rim), vTint.a);
}`;

const ACROSS = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]];

export class Marks extends Quads {
  constructor(scene, { over = false, facing = false, leastPixels = 0, order = 5 } = {}) {
    super(scene, {
      material: new THREE.ShaderMaterial({
        uniforms: {
          resolution, lift: { value: over ? 0 : 1e-4 }, facing: { value: facing ? 1 : 0 },
          leastPixels: { value: leastPixels },
        },
        vertexShader: VERTEX, fragmentShader: FRAGMENT,
        transparent: true, depthTest: !over, depthWrite: false, side: THREE.DoubleSide,
      }),
      parts: [["place", 3], ["size", 2], ["tint", 4], ["shape", 1]],
      across: ACROSS,
      order: over ? order + 100 : order,
    });
  }

  add(x, y, z, width, depth, red, green, blue, alpha, shape) {
    const first = this.next();
    const { rows } = this;
    let at = first;
    rows[at++] = x; rows[at++] = y; rows[at++] = z;
    rows[at++] = width; rows[at++] = depth;
    rows[at++] = red; rows[at++] = green; rows[at++] = blue; rows[at++] = alpha;
    rows[at] = shape;
    this.spread(first);
  }

  addHex(x, y, z, size, hex, alpha, shape) {
    this.add(x, y, z, size, size, hexPart(hex, 0), hexPart(hex, 1), hexPart(hex, 2), alpha, shape);
  }
}
