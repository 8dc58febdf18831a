// Lines of a width in pixels, all in one draw call: WebGL's own are a pixel wide. Colours go to the
// screen as they are, without light or fog, so that they are those of the panels.

import { THREE } from "three";
import { Quads } from "/page/quads.js";

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

// x along the line, y across it.
const ACROSS = [[0, -1, 0], [1, -1, 0], [1, 1, 0], [0, 1, 0]];

// Shared by all lines: the size of the picture in pixels of the screen.
export const resolution = { value: new THREE.Vector2(1, 1) };

export class Lines extends Quads {
  // `over`: drawn over everything, else hidden by what is in front.
  constructor(scene, { width = 2, over = false, order = 10 } = {}) {
    super(scene, {
      material: new THREE.ShaderMaterial({
        uniforms: { resolution, width: { value: width }, lift: { value: over ? 0 : 2e-4 } },
        vertexShader: VERTEX, fragmentShader: FRAGMENT,
        transparent: true, depthTest: !over, depthWrite: false, side: THREE.DoubleSide,
      }),
      parts: [["start", 3], ["end", 3], ["tint", 4]],
      across: ACROSS,
      order: over ? order + 100 : order,
    });
    this.tint = new Float32Array(4);
  }

  // The colour of what is added from now on: "#rrggbb".
  colour(hex, alpha = 1) {
    const { tint } = this;
    for (let i = 0; i < 3; i++) tint[i] = hexPart(hex, i);
    tint[3] = alpha;
    return this;
  }

  add(ax, ay, az, bx, by, bz) {
    const at = this.next();
    const { rows, tint } = this;
    rows[at] = ax; rows[at + 1] = ay; rows[at + 2] = az;
    rows[at + 3] = bx; rows[at + 4] = by; rows[at + 5] = bz;
    rows[at + 6] = tint[0]; rows[at + 7] = tint[1]; rows[at + 8] = tint[2]; rows[at + 9] = tint[3];
    this.spread(at);
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
}

// One of the three parts of "#rrggbb", 0 to 1, without making a string of it.
export function hexPart(hex, i) {
  return (digit(hex.charCodeAt(1 + 2 * i)) * 16 + digit(hex.charCodeAt(2 + 2 * i))) / 255;
}

function digit(code) {
  return code < 58 ? code - 48 : (code | 32) - 87;
}
