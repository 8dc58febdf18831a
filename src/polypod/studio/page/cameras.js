// Where the view is from: an orbit that stays, one that follows, and an animator's three sides.

import { THREE, OrbitControls } from "three";

const KEPT = "polypod.camera";
const WIDE = 38; // degrees across the height of the picture
const NARROW = 7; // from far away, nearly parallel: what an animator expects of a side view
const ROOM = 0.85; // of the half picture: what is to be seen is not at its very edge
const FARTHER = 1.15; // steps in which the view goes back
const EASE = 260; // ms to frame the creature
const TURN_TIME = 0.35; // s in which side views follow a turn
const RISE_TIME = 0.4; // s in which views follow the body up and down, so that they do not bob

const SIDE_LIFT = 0.06;
const MOST_LIFT = 1.2;
const LIFT_TIME = { up: 0.25, down: 1.2 }; // s in which side views rise before a hill, and sink after
const LOOKED_FOR = 14; // sizes: how far off hills are looked for
const HILL_STEPS = 40;

// Title, what it does, and for side views from where: [left, up, forward] of the creature, a
// little from above, so that the ground is seen, and farther from above where a hill is between.
export const CAMERAS = {
  follow: { title: "Follow", hint: "keeps its distance while the creature walks" },
  orbit: { title: "Orbit", hint: "stays where it is" },
  side: { title: "Side", hint: "from its left", from: [1, SIDE_LIFT, 0] },
  front: { title: "Front", hint: "from ahead of it", from: [0, SIDE_LIFT, 1] },
  // A little from behind, so that ahead is up.
  top: { title: "Top", hint: "from above, ahead is up", from: [0, 1, -1e-3] },
};

const easeInOut = (t) => t * t * (3 - 2 * t);

export class Cameras {
  constructor(canvas) {
    this.camera = new THREE.PerspectiveCamera(WIDE, 1, 0.01, 1000);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = 0.497 * Math.PI;
    this.cameFrom = null; // {offset, mode} of a view that went back for a while
    this.controls.addEventListener("start", () => { this.cameFrom = null; });
    this.lift = SIDE_LIFT; // of side views: tangent of how far from above they are
    this.heightAt = null; // (x, z): of the ground
    const kept = localStorage.getItem(KEPT);
    this.mode = kept in CAMERAS ? kept : "follow";
    this.listeners = new Set();
    this.size = 0; // m: radius of what is to be seen; 0 until it is known
    this.heading = 0; // rad
    this.centre = new THREE.Vector3(); // of the creature, its ups and downs smoothed
    this.lastCentre = new THREE.Vector3();
    this.lastHeading = 0;
    this.direction = new THREE.Vector3(0.7, 0.45, 0.85).normalize(); // of the eye, from the target
    this.offset = new THREE.Vector3();
    this.away = new THREE.Vector3();
    this.curtain = new THREE.Plane(new THREE.Vector3(0, 1, 0), 1e9); // obstacles before it are not drawn
    this.eased = null;
    this.begun = false;
  }

  // Hear of the mode when it changes.
  onMode(listener) {
    this.listeners.add(listener);
    listener(this.mode);
  }

  choose(mode) {
    if (!(mode in CAMERAS)) throw new Error(`there is no camera ${mode}; there are ${Object.keys(CAMERAS)}`);
    const framed = this.apparent();
    const was = this.mode;
    this.mode = mode;
    localStorage.setItem(KEPT, mode);
    const { from } = CAMERAS[mode];
    if (from || CAMERAS[was].from) this.lens(from ? NARROW : WIDE, framed);
    if (from) this.controls.target.copy(this.centre);
    for (const listener of this.listeners) listener(mode);
  }

  // How much of the world the picture is high, at the target, m.
  apparent() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return 2 * distance * Math.tan(THREE.MathUtils.degToRad(this.camera.fov) / 2);
  }

  // Change the angle of the lens, and the distance so that the creature stays as large.
  lens(fov, height) {
    this.camera.fov = fov;
    const distance = height / (2 * Math.tan(THREE.MathUtils.degToRad(fov) / 2));
    this.offset.subVectors(this.camera.position, this.controls.target).setLength(distance);
    this.camera.position.copy(this.controls.target).add(this.offset);
    this.bound();
  }

  bound() {
    // A narrow lens is as much further away.
    const further = Math.tan(THREE.MathUtils.degToRad(WIDE) / 2)
      / Math.tan(THREE.MathUtils.degToRad(this.camera.fov) / 2);
    this.controls.minDistance = 0.4 * this.size * further;
    this.controls.maxDistance = 60 * this.size * further;
  }

  // Show the whole creature, from where the view is; at once or with a short glide.
  frame(glide = true) {
    if (this.size === 0) return;
    const half = THREE.MathUtils.degToRad(this.camera.fov) / 2;
    const narrower = Math.atan(Math.tan(half) * Math.min(this.camera.aspect, 1));
    const distance = (1.25 * this.size) / Math.sin(narrower);
    this.ease(this.camera.position.clone().sub(this.controls.target).setLength(distance), glide);
  }

  // Go back until a place is in the picture, as well as the creature; `settle` comes back from there.
  reveal(place) {
    if (this.size === 0) return;
    const offset = this.camera.position.clone().sub(this.controls.target);
    this.cameFrom ??= { offset: offset.clone(), mode: this.mode };
    const seen = new THREE.PerspectiveCamera();
    const at = new THREE.Vector3();
    for (let distance = offset.length(); distance < this.controls.maxDistance; distance *= FARTHER) {
      seen.copy(this.camera);
      seen.position.copy(offset.setLength(distance)).add(this.centre);
      seen.lookAt(this.centre);
      seen.near = 0.02 * distance;
      seen.updateProjectionMatrix();
      seen.updateMatrixWorld();
      at.copy(place).project(seen);
      if (at.z < 1 && Math.max(Math.abs(at.x), Math.abs(at.y)) < ROOM) break;
    }
    this.ease(offset);
  }

  // Back to where the view was before `reveal`, if nobody has moved it since.
  settle() {
    if (this.cameFrom?.mode === this.mode) this.ease(this.cameFrom.offset);
    this.cameFrom = null;
  }

  // Look at the creature from `to` off it.
  ease(to, glide = true) {
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.eased = {
      start: performance.now(),
      lasts: glide && !calm ? EASE : 0,
      target: this.controls.target.clone().sub(this.centre),
      eye: this.camera.position.clone().sub(this.centre),
      to,
    };
  }

  // Another creature, or the first: `size` [m] is its radius.
  suit(size) {
    if (Math.abs(size - this.size) < 0.02 * size) return;
    this.size = size;
    this.bound();
    if (this.begun) this.frame(false);
  }

  // Go with the creature: its place, its body's quaternion at poses[at ...], and seconds since.
  update(poses, at, elapsed) {
    this.track(poses, at, elapsed);
    if (!this.begun) this.begin();
    const { camera, controls } = this;
    if (this.mode === "follow") {
      this.offset.subVectors(this.centre, this.lastCentre);
      camera.position.add(this.offset);
      controls.target.add(this.offset);
    } else if (this.mode !== "orbit") {
      this.keepSide(elapsed);
    }
    if (this.eased) this.glide();
    controls.update();
    const distance = camera.position.distanceTo(controls.target);
    camera.near = 0.02 * distance;
    camera.far = distance + 400 * this.size + 20 * distance;
    camera.updateProjectionMatrix();
    this.direction.subVectors(camera.position, controls.target).normalize();
    // From a side no obstacle that stands between hides the creature.
    const before = CAMERAS[this.mode].from ? 2 * this.size : 2 * distance;
    this.offset.copy(this.centre).addScaledVector(this.direction, before);
    this.curtain.setFromNormalAndCoplanarPoint(this.away.copy(this.direction).negate(), this.offset);
    this.lastCentre.copy(this.centre);
    this.lastHeading = this.heading;
  }

  track(poses, at, elapsed) {
    const x = poses[at], y = poses[at + 1], z = poses[at + 2], w = poses[at + 3];
    const heading = Math.atan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y));
    const far = Math.hypot(poses[at + 4] - this.centre.x, poses[at + 6] - this.centre.z);
    const jumped = !this.begun || far > 4 * this.size;
    const rise = jumped ? 1 : 1 - Math.exp(-elapsed / RISE_TIME);
    const turn = jumped ? 1 : 1 - Math.exp(-elapsed / TURN_TIME);
    this.centre.x = poses[at + 4];
    this.centre.y += (poses[at + 5] - this.centre.y) * rise;
    this.centre.z = poses[at + 6];
    const off = heading - this.heading;
    this.heading += Math.atan2(Math.sin(off), Math.cos(off)) * turn;
  }

  begin() {
    this.begun = true;
    this.lastCentre.copy(this.centre);
    this.lastHeading = this.heading;
    const up = new THREE.Vector3(0, 1, 0);
    this.controls.target.copy(this.centre);
    this.camera.fov = CAMERAS[this.mode].from ? NARROW : WIDE;
    this.camera.position.copy(this.direction).applyAxisAngle(up, this.heading).add(this.centre);
    this.bound();
    this.frame(false);
  }

  // A side view: the user may zoom and shift it; who turns it is back to following.
  keepSide(elapsed) {
    const { camera, controls, offset } = this;
    offset.subVectors(camera.position, controls.target);
    const distance = offset.length();
    const turned = offset.divideScalar(distance).dot(this.direction) < 0.9999;
    const [left, least, forward] = CAMERAS[this.mode].from;
    const up = least === SIDE_LIFT ? this.rise(left, forward, elapsed) : least;
    if (turned && this.sided === this.mode) {
      this.choose("follow");
      return;
    }
    // What it was shifted by turns with the creature.
    const shift = controls.target.sub(this.lastCentre);
    rotateLevel(shift, this.heading - this.lastHeading);
    controls.target.add(this.centre);
    offset.set(left, up, forward).setLength(distance);
    rotateLevel(offset, this.heading);
    camera.position.copy(controls.target).add(offset);
    this.sided = this.mode;
  }

  // How far from above a view is from a side, so that no hill hides the creature.
  rise(left, forward, elapsed) {
    const sine = Math.sin(this.heading), cosine = Math.cos(this.heading);
    const x = left * cosine + forward * sine, z = forward * cosine - left * sine;
    let wanted = SIDE_LIFT;
    // Over the way of the view to the feet on this side, in the middle and to either hand.
    for (const hand of this.heightAt ? [-0.5, 0, 0.5] : []) {
      const px = this.centre.x + hand * this.size * z, pz = this.centre.z - hand * this.size * x;
      const foot = this.heightAt(px, pz);
      for (let i = 1; i <= HILL_STEPS; i++) {
        const away = (LOOKED_FOR * this.size * i) / HILL_STEPS;
        const hill = this.heightAt(px + away * x, pz + away * z) - foot;
        wanted = Math.max(wanted, hill / away);
      }
    }
    wanted = Math.min(wanted, MOST_LIFT);
    const time = wanted > this.lift ? LIFT_TIME.up : LIFT_TIME.down;
    this.lift = this.sided === this.mode
      ? this.lift + (wanted - this.lift) * (1 - Math.exp(-elapsed / time))
      : wanted;
    return this.lift;
  }

  glide() {
    const { start, lasts, target, eye, to } = this.eased;
    const t = lasts ? Math.min((performance.now() - start) / lasts, 1) : 1;
    const share = easeInOut(t);
    // It ends looking at the centre.
    this.controls.target.copy(target).multiplyScalar(1 - share).add(this.centre);
    this.camera.position.copy(eye).lerp(to, share).add(this.centre);
    if (t === 1) this.eased = null;
  }
}

// Turn a vector about the vertical, from +z toward +x.
function rotateLevel(vector, angle) {
  const { x, z } = vector;
  vector.x = x * Math.cos(angle) + z * Math.sin(angle);
  vector.z = z * Math.cos(angle) - x * Math.sin(angle);
}
