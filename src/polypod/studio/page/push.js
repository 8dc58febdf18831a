// Pushing a creature: an arrow from where it was taken to where the pointer is; let go, and it acts.

import { THREE } from "three";
import { Lines } from "/page/lines.js";

const GRAVITY = 9.81;
const PER_LEG = 0.5; // of sqrt(g x hip height), for a drag of one leg length
const MOST = 1.5; // of the same: harder blows are cut to that
const LEAST = 8; // pixels: less is a click
const FLAT = 0.35; // of the view's direction that must be downward, for the push to be level
const COLOUR = "#ff9d5c";

export class PushDrag {
  constructor(scene, store, creatures, rays, note) {
    Object.assign(this, { store, creatures, rays, note });
    this.lines = new Lines(scene, { width: 4, over: true, order: 20 });
    this.plane = new THREE.Plane();
    this.normal = new THREE.Vector3();
    this.turn = new THREE.Quaternion();
    this.velocity = new THREE.Vector3();
    this.held = null;
  }

  // Take hold of a creature: {kind, creature, point} as the rays find it.
  begin({ kind, creature, point }, event) {
    const herd = this.creatures.herds[kind];
    const offset = point.clone().sub(this.bodyPlace(herd, creature, new THREE.Vector3()));
    this.held = { herd, kind, creature, offset, x: event.clientX, y: event.clientY, hard: false };
    // From above a push is level; seen from the side it may also go up.
    this.rays.cameras.camera.getWorldDirection(this.normal);
    this.level = -this.normal.y > FLAT;
    this.velocity.set(0, 0, 0);
  }

  bodyPlace(herd, creature, out) {
    return out.fromArray(herd.poses, herd.bodyAt(creature) + 4);
  }

  move(event) {
    const { herd, creature, offset, x, y } = this.held;
    const from = this.bodyPlace(herd, creature, new THREE.Vector3()).add(offset);
    if (this.level) this.plane.setFromNormalAndCoplanarPoint(new THREE.Vector3(0, 1, 0), from);
    else this.plane.setFromNormalAndCoplanarPoint(this.normal, from);
    this.rays.aim(event);
    const to = this.rays.planePlace(this.plane);
    this.held.hard = Math.hypot(event.clientX - x, event.clientY - y) >= LEAST;
    if (!to) return;
    const { leg, hip } = this.sizes();
    const unit = Math.sqrt(GRAVITY * hip);
    this.velocity.subVectors(to, from).multiplyScalar((PER_LEG * unit) / leg);
    this.velocity.clampLength(0, MOST * unit);
    this.draw(from, this.velocity.clone().multiplyScalar(leg / (PER_LEG * unit)));
    this.note(`Push ${this.velocity.length().toPrecision(2)} m/s`, event);
  }

  // Of the held creature; of other kinds than the first only the skin's size is known.
  sizes() {
    const { herd, kind } = this.held;
    const facts = this.store.creature;
    if (kind === 0 && facts) return { leg: facts.leg_length, hip: facts.hip_height };
    const height = herd.box ? herd.box[4] - herd.box[1] : 1;
    return { leg: height, hip: 0.7 * height };
  }

  draw(from, arrow) {
    const { lines } = this;
    const to = from.clone().add(arrow);
    const head = Math.min(0.3 * arrow.length(), 0.25 * this.sizes().leg);
    const back = arrow.clone().setLength(head);
    const across = this.rays.cameras.camera.position.clone().sub(to).cross(arrow).setLength(0.5 * head);
    lines.clear().colour(COLOUR);
    lines.add(from.x, from.y, from.z, to.x, to.y, to.z);
    for (const side of [-1, 1]) {
      lines.add(
        to.x, to.y, to.z, to.x - back.x + side * across.x, to.y - back.y + side * across.y,
        to.z - back.z + side * across.z,
      );
    }
    lines.commit();
  }

  // Let go: the push, or false where it was a click.
  end() {
    const { hard, kind, creature } = this.held;
    if (hard && this.velocity.length() > 0) {
      this.store.send({
        do: "push",
        creature: this.number(kind, creature),
        velocity: this.velocity.toArray(),
        at: this.ahead(),
      }).catch((refusal) => this.store.say(refusal.message));
    }
    this.cancel();
    return hard;
  }

  cancel() {
    this.lines.clear().commit();
    this.note("");
    this.held = null;
  }

  // Creatures are counted through all kinds.
  number(kind, creature) {
    let before = 0;
    for (let h = 0; h < kind; h++) before += this.creatures.herds[h].count;
    return before + creature;
  }

  // How far ahead of the body's centre it was taken, within the trunk, m.
  ahead() {
    const { herd, kind, creature, offset } = this.held;
    const body = this.store.creature?.body;
    if (kind !== 0 || !body) return 0;
    const at = herd.bodyAt(creature);
    this.turn.fromArray(herd.poses, at).invert();
    const forward = offset.clone().applyQuaternion(this.turn).z;
    const least = body.centre[2] - body.half_size[2], most = body.centre[2] + body.half_size[2];
    return Math.min(Math.max(forward, least), most);
  }
}
