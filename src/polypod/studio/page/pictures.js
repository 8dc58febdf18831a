// The pictures that cover a skin. They come as they are in a stranger's file, and the browser
// decodes them beside the page's own work; until they are there the skin has the colours that its
// vertices have of them.

import { THREE } from "three";
import { linear, skinned } from "/page/skinning.js";

const FINEST = 2048; // pixels along the longer side of a picture
const MOST = 16 * 2 ** 20; // pixels of all pictures of a skin together
const WRAPS = {
  repeat: THREE.RepeatWrapping, clamp: THREE.ClampToEdgeWrapping, mirror: THREE.MirroredRepeatWrapping,
};

// The pictures of a skin, decoded: null for what the browser cannot read.
export function decodePictures({ arrays }) {
  const bytes = [];
  while (arrays[`picture${bytes.length}`]) bytes.push(arrays[`picture${bytes.length}`].data);
  const side = Math.min(FINEST, Math.floor(Math.sqrt(MOST / Math.max(bytes.length, 1))));
  return Promise.all(bytes.map((one) => decode(new Blob([one]), side).catch(() => null)));
}

async function decode(blob, side) {
  const asIs = { premultiplyAlpha: "none", colorSpaceConversion: "none" };
  const picture = await createImageBitmap(blob, asIs);
  const share = side / Math.max(picture.width, picture.height);
  if (share >= 1) return picture;
  const size = {
    resizeWidth: Math.max(1, Math.round(share * picture.width)),
    resizeHeight: Math.max(1, Math.round(share * picture.height)),
    resizeQuality: "high",
  };
  const smaller = await createImageBitmap(picture, { ...asIs, ...size });
  picture.close();
  return smaller;
}

// Cover a mesh of `herdMesh` with the pictures of its skin.
export function coverMesh(mesh, { arrays, parts }, pictures, poses) {
  if (!pictures.some(Boolean)) return;
  const { geometry } = mesh;
  const plain = mesh.material;
  const materials = [plain];
  const numbers = new Map();
  const colours = mesh.geometry.getAttribute("color");
  const tints = linear(arrays.tint.data);
  geometry.setAttribute("uv", new THREE.BufferAttribute(arrays.uv.data, 2));
  for (const { first, count, picture, wrap, cutoff } of parts) {
    const bitmap = picture === null ? null : pictures[picture];
    if (!bitmap) {
      geometry.addGroup(first, count, 0);
      continue;
    }
    const key = `${picture} ${wrap} ${cutoff}`;
    if (!numbers.has(key)) {
      numbers.set(key, materials.length);
      materials.push(covered(plain, bitmap, wrap, cutoff, poses));
    }
    geometry.addGroup(first, count, numbers.get(key));
    // What a picture covers has its tint, all else the colour that it had.
    for (const v of arrays.triangles.data.subarray(first, first + count)) {
      colours.array.set(tints.subarray(3 * v, 3 * v + 3), 3 * v);
    }
  }
  colours.needsUpdate = true;
  mesh.material = materials;
}

function covered(plain, bitmap, wrap, cutoff, poses) {
  const map = new THREE.Texture(bitmap, THREE.UVMapping, ...wrap.map((one) => WRAPS[one]));
  map.colorSpace = THREE.SRGBColorSpace;
  map.flipY = false;
  map.anisotropy = 4;
  map.needsUpdate = true;
  const material = skinned(plain.clone(), poses);
  material.map = map;
  material.alphaTest = cutoff;
  return material;
}
