// Usage: node play-three.mjs FILE.glb TIME,TIME,... NODE,NODE,...
// Plays the last animation in three.js and prints JSON: positions[time][node] = [x, y, z] in world.
import { readFile } from 'node:fs/promises';
import { AnimationMixer, Texture, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

// Node has no images: textures say nothing about where joints are, so each is left empty.
globalThis.self ??= globalThis;
class NoTextures {
  constructor() {
    this.name = 'no-textures';
  }
  loadTexture() {
    return Promise.resolve(new Texture());
  }
}

const [path, timeList, nodeList] = process.argv.slice(2);
const file = await readFile(path);
const bytes = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
const gltf = await new GLTFLoader().register(() => new NoTextures()).parseAsync(bytes, '');
const nodes = await Promise.all(
  nodeList.split(',').map((index) => gltf.parser.getDependency('node', Number(index))),
);
const mixer = new AnimationMixer(gltf.scene);
mixer.clipAction(gltf.animations.at(-1)).play();

const positions = timeList.split(',').map((time) => {
  // The end of a looping clip is its beginning: stay a hair before it.
  mixer.setTime(Math.min(Number(time), gltf.animations.at(-1).duration * (1 - 1e-12)));
  gltf.scene.updateMatrixWorld(true);
  return nodes.map((node) => new Vector3().setFromMatrixPosition(node.matrixWorld).toArray());
});
console.log(JSON.stringify({ animation: gltf.animations.at(-1).name, positions }));
