// What is inside a creature, drawn through its skin: bones, spine, pelvis nodes, limits of joints.

import { Lines } from "/page/lines.js";
import { DISC, Marks } from "/page/marks.js";

const BONE = "#e6ebf0";
const SPINE = "#111111"; // and its nodes blue, as P2 draws them
const NODE = "#2f6fe4";
const LIMIT = "#ffd166";
const CHOSEN = "#ffffff";
const FAN_RADIUS = 0.1; // leg lengths
const CHOSEN_RADIUS = 0.17;
// Of all joints these would hide the others; those of a joint that is being limited are shown.
const ROUND = ["twist", "roll"];
const FAN_STEPS = 10;

export class InsideOverlays {
  constructor(scene, store, creatures) {
    this.store = store;
    this.creatures = creatures;
    this.fans = new Lines(scene, { width: 1.5, over: true });
    this.bones = new Lines(scene, { width: 2.5, over: true });
    this.spine = new Lines(scene, { width: 5, over: true, order: 11 });
    this.nodes = new Marks(scene, { over: true, facing: true, leastPixels: 6, order: 12 });
    // Of one joint at a time: its quaternion and shift, and what is turned by them.
    this.chosen = new Set(); // rows of the joints that are being limited
    store.on("joint", (rows) => { this.chosen = new Set(rows); });
    this.pose = new Float32Array(7);
    this.a = new Float32Array(3);
    this.b = new Float32Array(3);
    this.c = new Float32Array(3);
    this.d = new Float32Array(3);
  }

  update({ to }, shown) {
    for (const part of [this.fans, this.bones, this.spine, this.nodes]) part.clear();
    const focus = this.creatures.focus(to);
    const facts = this.store.creature;
    // The server describes the first kind; a frame of the creature before may still be shown.
    if (focus && facts && to.focus.kind === 0 && focus.herd.joints === facts.rest.length + 1) {
      if (shown.has("bones")) this.drawBones(focus, facts);
      this.drawFans(focus, facts, shown.has("limits"));
      if (shown.has("spine")) this.drawSpine(focus, facts);
    }
    for (const part of [this.fans, this.bones, this.spine, this.nodes]) part.commit();
  }

  // Take the pose of a row for `place` and `turned`.
  take({ herd, row }, joint) {
    const at = row * herd.stride + 8 * joint;
    for (let i = 0; i < 7; i++) this.pose[i] = herd.poses[at + i];
  }

  // A direction at rest, turned by the pose.
  turned(out, v) {
    const [qx, qy, qz, qw] = this.pose;
    const tx = 2 * (qy * v[2] - qz * v[1]);
    const ty = 2 * (qz * v[0] - qx * v[2]);
    const tz = 2 * (qx * v[1] - qy * v[0]);
    out[0] = v[0] + qw * tx + qy * tz - qz * ty;
    out[1] = v[1] + qw * ty + qz * tx - qx * tz;
    out[2] = v[2] + qw * tz + qx * ty - qy * tx;
    return out;
  }

  // A place at rest, carried by the pose.
  placed(out, v) {
    this.turned(out, v);
    for (let i = 0; i < 3; i++) out[i] += this.pose[4 + i];
    return out;
  }

  joint(out, focus, facts, j) {
    this.take(focus, j);
    return this.placed(out, facts.rest[j]);
  }

  drawBones(focus, facts) {
    const { a, b } = this;
    this.bones.colour(BONE, 0.9);
    for (const [i, j] of facts.bones) {
      this.joint(a, focus, facts, i);
      this.joint(b, focus, facts, j);
      this.bones.add(a[0], a[1], a[2], b[0], b[1], b[2]);
      this.node(a, 0.012 * facts.leg_length, BONE);
      this.node(b, 0.012 * facts.leg_length, BONE);
    }
  }

  node(place, size, colour) {
    this.nodes.addHex(place[0], place[1], place[2], size, colour, 1, DISC);
  }

  drawSpine(focus, facts) {
    const { a, b } = this;
    this.spine.colour(SPINE, 0.95);
    facts.spine_line.forEach(({ of, place }, i) => {
      this.take(focus, of);
      this.placed(b, place);
      if (i > 0) this.spine.add(a[0], a[1], a[2], b[0], b[1], b[2]);
      a.set(b);
    });
    for (const { of, place } of facts.pelvis) {
      this.take(focus, of);
      this.node(this.placed(b, place), 0.035 * facts.leg_length, NODE);
    }
  }

  // Those of all joints, and larger those of the joints that are being limited.
  drawFans(focus, facts, all) {
    for (const fan of facts.fans) {
      const chosen = this.chosen.has(fan.joint);
      if (!chosen && (!all || ROUND.includes(fan.key))) continue;
      this.fans.colour(chosen ? CHOSEN : LIMIT, chosen ? 1 : 0.85);
      this.drawFan(focus, fan, (chosen ? CHOSEN_RADIUS : FAN_RADIUS) * facts.leg_length);
    }
  }

  // From the least to the most angle, with a straight side at both.
  drawFan(focus, fan, radius) {
    this.take(focus, fan.of);
    const middle = this.placed(this.a, fan.place);
    const start = this.turned(this.b, fan.from);
    const axis = this.turned(this.c, fan.axis);
    const { d, fans } = this;
    // At right angles to both: where the direction is after a quarter turn.
    d[0] = axis[1] * start[2] - axis[2] * start[1];
    d[1] = axis[2] * start[0] - axis[0] * start[2];
    d[2] = axis[0] * start[1] - axis[1] * start[0];
    let [px, py, pz] = middle;
    for (let s = 0; s <= FAN_STEPS; s++) {
      const angle = fan.least + ((fan.most - fan.least) * s) / FAN_STEPS;
      const along = radius * Math.cos(angle), across = radius * Math.sin(angle);
      const x = middle[0] + along * start[0] + across * d[0];
      const y = middle[1] + along * start[1] + across * d[1];
      const z = middle[2] + along * start[2] + across * d[2];
      fans.add(px, py, pz, x, y, z);
      px = x; py = y; pz = z;
    }
    fans.add(px, py, pz, middle[0], middle[1], middle[2]);
  }
}
