// Light and air: a sun whose shadows follow what is looked at, a sky, and fog toward it.

import { THREE } from "three";

const SKY = 0x66788a;
const TOWARD_SUN = new THREE.Vector3(0.5, 1.0, 0.35).normalize();

export class Sky {
  constructor(scene) {
    this.scene = scene;
    scene.background = new THREE.Color(SKY);
    scene.fog = new THREE.Fog(SKY, 10, 100);
    scene.add(new THREE.HemisphereLight(0xdfe9f5, 0x6f675c, 1.5));
    this.sun = new THREE.DirectionalLight(0xfff3e0, 2.4);
    this.sun.castShadow = true;
    scene.add(this.sun, this.sun.target);
    this.reach = 0;
    this.right = new THREE.Vector3();
    this.up = new THREE.Vector3();
    this.centre = new THREE.Vector3();
  }

  // Have the shadow's map be so many texels a side.
  grain(texels) {
    const { shadow } = this.sun;
    if (shadow.mapSize.x === texels) return;
    shadow.mapSize.set(texels, texels);
    shadow.map?.dispose();
    shadow.map = null;
    this.reach = 0; // its bias goes by the texel
  }

  // Light what is within `reach` metres of `centre`; fog begins well beyond the view's distance,
  // and hides where the ground ends, `edge` metres away.
  follow(centre, reach, distance, edge) {
    const { fog } = this.scene;
    const clear = 10 * distance + 8 * reach;
    fog.near = Math.min(clear, distance + 0.3 * edge);
    fog.far = Math.min(4 * clear, distance + 0.9 * edge);
    const { sun } = this;
    const camera = sun.shadow.camera;
    // Zooming does not change the shadow's grain all the time, only by steps.
    const stepped = 1.5 ** Math.ceil(Math.log(reach) / Math.log(1.5));
    if (stepped !== this.reach) {
      this.reach = stepped;
      camera.left = camera.bottom = -stepped;
      camera.right = camera.top = stepped;
      camera.near = 0.1 * stepped;
      camera.far = 8 * stepped;
      camera.updateProjectionMatrix();
      sun.shadow.normalBias = (3 * stepped) / sun.shadow.mapSize.x;
      sun.shadow.bias = -0.0004;
    }
    this.settle(centre, (2 * stepped) / sun.shadow.mapSize.x);
    sun.target.position.copy(this.centre);
    sun.position.copy(this.centre).addScaledVector(TOWARD_SUN, 4 * stepped);
    sun.target.updateMatrixWorld();
  }

  // Move the centre by whole texels of the shadow's map, so that edges do not crawl.
  settle(centre, texel) {
    this.right.set(0, 1, 0).cross(TOWARD_SUN).normalize();
    this.up.copy(TOWARD_SUN).cross(this.right);
    const u = Math.round(centre.dot(this.right) / texel) * texel;
    const v = Math.round(centre.dot(this.up) / texel) * texel;
    const w = centre.dot(TOWARD_SUN);
    this.centre.set(0, 0, 0).addScaledVector(this.right, u).addScaledVector(this.up, v)
      .addScaledVector(TOWARD_SUN, w);
  }
}
