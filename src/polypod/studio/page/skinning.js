// Skinning of a whole herd in one draw call: each instance finds its joints' poses in a row of
// a float texture, two texels a joint: a quaternion, and a shift.

import { THREE } from "three";

const DECLARATIONS = `
uniform highp sampler2D poses;
attribute float row;
attribute vec4 joint;
attribute vec4 weight;

vec3 turned(vec4 q, vec3 v) {
  vec3 t = 2.0 * cross(q.xyz, v);
  return v + q.w * t + cross(q.xyz, t);
}
ivec2 texelOf(float j) {
  return ivec2(2 * int(j + 0.5), int(row + 0.5));
}
vec3 posedPart(float j, vec3 v) {
  ivec2 at = texelOf(j);
  return turned(texelFetch(poses, at, 0), v) + texelFetch(poses, at + ivec2(1, 0), 0).xyz;
}
vec3 posed(vec3 v) {
  vec3 sum = weight.x * posedPart(joint.x, v);
  if (weight.y > 0.0) sum += weight.y * posedPart(joint.y, v);
  if (weight.z > 0.0) sum += weight.z * posedPart(joint.z, v);
  if (weight.w > 0.0) sum += weight.w * posedPart(joint.w, v);
  return sum;
}
vec3 posedNormal(vec3 n) {
  vec3 sum = weight.x * turned(texelFetch(poses, texelOf(joint.x), 0), n);
  if (weight.y > 0.0) sum += weight.y * turned(texelFetch(poses, texelOf(joint.y), 0), n);
  if (weight.z > 0.0) sum += weight.z * turned(texelFetch(poses, texelOf(joint.z), 0), n);
  if (weight.w > 0.0) sum += weight.w * turned(texelFetch(poses, texelOf(joint.w), 0), n);
  return sum;
}
#include <common>`;

// A material that draws what is posed as a row of `poses` says.
export function skinned(material, poses) {
  material.onBeforeCompile = (shader) => {
    shader.uniforms.poses = { value: poses };
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", DECLARATIONS)
      .replace("#include <beginnormal_vertex>", "vec3 objectNormal = posedNormal(normal);")
      .replace("#include <begin_vertex>", "vec3 transformed = posed(position);");
  };
  return material;
}

// The texture of a herd: `count` rows of `joints` poses, eight floats each.
export function poseTexture(count, joints) {
  const data = new Float32Array(8 * joints * count);
  const texture = new THREE.DataTexture(data, 2 * joints, count, THREE.RGBAFormat, THREE.FloatType);
  texture.needsUpdate = true;
  return texture;
}

// A mesh that draws up to `count` creatures of a kind, those whose rows `showRows` lists. `arrays`
// are those of /skin/N.
export function herdMesh(arrays, texture, count) {
  const geometry = new THREE.InstancedBufferGeometry();
  geometry.instanceCount = 0;
  const rows = new THREE.InstancedBufferAttribute(new Float32Array(count), 1);
  rows.setUsage(THREE.DynamicDrawUsage);
  geometry.setAttribute("row", rows);
  const { place, normal, joint, weight, colour, triangles } = arrays;
  geometry.setAttribute("position", new THREE.BufferAttribute(place.data, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(normal.data, 3));
  geometry.setAttribute("joint", new THREE.BufferAttribute(joint.data, 4));
  geometry.setAttribute("weight", new THREE.BufferAttribute(weight.data, 4));
  geometry.setAttribute("color", new THREE.BufferAttribute(linear(colour.data), 3));
  geometry.setIndex(new THREE.BufferAttribute(triangles.data, 1));
  // Thin parts are often modelled from one side only, so both are shown.
  const look = { vertexColors: true, roughness: 0.75, metalness: 0, side: THREE.DoubleSide };
  const mesh = new THREE.Mesh(geometry, skinned(new THREE.MeshStandardMaterial(look), texture));
  const depth = new THREE.MeshDepthMaterial({ depthPacking: THREE.RGBADepthPacking });
  mesh.customDepthMaterial = skinned(depth, texture);
  // Where it is only the shader knows.
  mesh.frustumCulled = false;
  mesh.castShadow = true;
  mesh.receiveShadow = true;
  return mesh;
}

// Draw the creatures of the first `count` rows of the mesh's own list.
export function showRows(mesh, count) {
  mesh.visible = count > 0;
  mesh.geometry.instanceCount = count;
  mesh.geometry.getAttribute("row").needsUpdate = true;
}

export function dropMesh(scene, mesh) {
  scene.remove(mesh);
  mesh.geometry.dispose();
  for (const material of [mesh.material].flat()) {
    material.map?.dispose();
    material.dispose();
  }
  mesh.customDepthMaterial.dispose();
}

// Colours as a screen shows them, four bytes each, to the linear ones that three.js lights.
export function linear(bytes) {
  const count = bytes.length / 4;
  const colours = new Float32Array(3 * count);
  const one = new THREE.Color();
  for (let v = 0; v < count; v++) {
    one.setRGB(
      bytes[4 * v] / 255, bytes[4 * v + 1] / 255, bytes[4 * v + 2] / 255, THREE.SRGBColorSpace,
    );
    one.toArray(colours, 3 * v);
  }
  return colours;
}
