// The ground: its mesh with a grid in metres, and how high it is where the mouse points.

import { THREE } from "three";
import { decodeArrays } from "/page/frames.js";
import { linear } from "/page/skinning.js";
import { Relief } from "/page/relief.js";

// The ground is a little darker than in print: the page is dark, and what is drawn on it is bright.
const TONE = 0xa9afb5;

const BEYOND = 40; // times as far as it is sent

const DECLARE = "varying vec3 groundPlace;\n#include <common>";
const LINES = `#include <color_fragment>
  {
    vec2 place = groundPlace.xz / grid;
    vec2 width = fwidth(place) + 1e-6;
    vec2 far = abs(fract(place - 0.5) - 0.5) / width;
    vec2 fine = abs(fract(10.0 * place - 0.5) - 0.5) / (10.0 * width);
    // Lines that are closer together than a few pixels would only flicker.
    float shown = 1.0 - smoothstep(0.04, 0.25, max(width.x, width.y));
    float fineShown = 1.0 - smoothstep(0.01, 0.035, max(width.x, width.y));
    float line = shown * (1.0 - smoothstep(0.6, 1.6, min(far.x, far.y)));
    float fineLine = fineShown * (1.0 - smoothstep(0.3, 1.2, min(fine.x, fine.y)));
    diffuseColor.rgb *= (1.0 - 0.36 * line) * (1.0 - 0.13 * fineLine);
  }`;

export class Ground {
  constructor(scene, store) {
    this.scene = scene;
    this.store = store;
    this.number = null; // N of what is shown
    this.wanted = null;
    this.mesh = null;
    this.edge = Infinity; // m to where it ends
    this.relief = new Relief();
    this.grid = { value: 1 }; // m between strong lines; ten weak ones between two
    for (const kind of ["kinds", "backdrop"]) {
      store.on(kind, () => this.fetch(store.backdrop.ground ?? store.kinds?.ground));
    }
  }

  fetch(number) {
    if (number === undefined) return;
    this.wanted = number;
    if (number === this.number) return;
    this.store.fetch(`/ground/${number}`)
      .then((answer) => answer.arrayBuffer())
      .then((bytes) => {
        if (this.wanted === number) this.show(number, decodeArrays(bytes));
      })
      .catch((problem) => {
        // A newer ground may have taken its place meanwhile.
        if (this.wanted === number) this.store.say(`The ground did not come: ${problem.message}.`);
      });
  }

  show(number, { arrays, centre, reach, endless }) {
    this.number = number;
    this.edge = endless ? Infinity : reach;
    const { place, normal, colour, triangles } = arrays;
    if (endless) widen(place.data, centre);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(place.data, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(normal.data, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(linear(colour.data), 3));
    geometry.setIndex(new THREE.BufferAttribute(triangles.data, 1));
    if (this.mesh) {
      this.mesh.geometry.dispose();
      this.mesh.geometry = geometry;
    } else {
      this.mesh = new THREE.Mesh(geometry, this.material());
      this.mesh.receiveShadow = true;
      this.scene.add(this.mesh);
    }
    this.relief.take(place.data, triangles.data);
    this.store.tell("ground", number);
  }

  material() {
    const material = new THREE.MeshLambertMaterial({ color: TONE, vertexColors: true });
    material.onBeforeCompile = (shader) => {
      shader.uniforms.grid = this.grid;
      shader.vertexShader = shader.vertexShader
        .replace("#include <common>", DECLARE)
        .replace("#include <begin_vertex>", "#include <begin_vertex>\n  groundPlace = position;");
      shader.fragmentShader = shader.fragmentShader
        .replace("#include <common>", `uniform float grid;\n${DECLARE}`)
        .replace("#include <color_fragment>", LINES);
    };
    return material;
  }

  // A grid that suits what is looked at: for a fly in centimetres, for a walker in metres.
  suit(size) {
    this.grid.value = 10 ** Math.round(Math.log10(size));
  }
}

// Level ground goes on: its four corners, which come first, are moved far out.
function widen(places, centre) {
  for (let i = 0; i < 12; i += 3) {
    places[i] = centre[0] + BEYOND * (places[i] - centre[0]);
    places[i + 2] = centre[2] + BEYOND * (places[i + 2] - centre[2]);
  }
}
