// What is drawn of the creature in focus in every picture: targets, way, trajectory.

import { InsideOverlays } from "/page/overlays_inside.js";
import { Lines } from "/page/lines.js";
import { DIAMOND, DISC, Marks, RING } from "/page/marks.js";

const TRAIL = 5; // s of the body's trajectory
const TRAIL_POINTS = 512;
const WAY = "#6cb4ee";

export class BodyOverlays {
  constructor(scene, store, creatures) {
    this.store = store;
    this.heightAt = () => 0; // of the ground, given by the scene
    this.marks = new Marks(scene, { order: 8, leastPixels: 5 });
    this.lines = new Lines(scene, { width: 2, order: 8 });
    this.trailLines = new Lines(scene, { width: 3, over: true });
    this.inside = new InsideOverlays(scene, store, creatures);
    this.trail = new Float32Array(4 * TRAIL_POINTS); // x, y, z, time; a ring
    this.trailCount = 0; // ever written
  }

  forget() {
    this.trailCount = 0;
  }

  // Remember where the body was.
  take(frame) {
    const herd = frame.herds[frame.focus.kind];
    if (!herd || frame.focus.creature >= herd.count) return;
    const last = 4 * ((this.trailCount - 1) % TRAIL_POINTS);
    if (this.trailCount > 0) {
      if (frame.time === this.trail[last + 3]) return;
      // Begun anew, scrubbed, or another creature is watched.
      if (frame.time < this.trail[last + 3] || this.watched !== frame.focus.creature) this.forget();
    }
    this.watched = frame.focus.creature;
    const at = 4 * (this.trailCount % TRAIL_POINTS);
    const body = 7 * frame.focus.creature;
    this.trail[at] = herd.body[body + 4];
    this.trail[at + 1] = herd.body[body + 5];
    this.trail[at + 2] = herd.body[body + 6];
    this.trail[at + 3] = frame.time;
    this.trailCount += 1;
  }

  update(playback, shown) {
    const leg = this.store.creature?.leg_length ?? 1;
    this.marks.clear();
    this.lines.clear();
    if (shown.has("targets")) this.drawTargets(playback, leg);
    if (shown.has("route")) this.drawRoute(leg);
    this.marks.commit();
    this.lines.commit();
    this.trailLines.clear();
    if (shown.has("trajectory")) this.drawTrail(playback.playhead);
    this.trailLines.commit();
    this.inside.update(playback, shown);
  }

  drawTargets({ to }, leg) {
    const feet = to.focus.feet;
    for (let k = 0; k < feet.length; k++) {
      const { target, preferred, stance } = feet[k];
      const colour = this.store.creature?.feet[k]?.colour ?? "#e6ebf0";
      const lift = 0.008 * leg;
      const alpha = stance ? 0.6 : 1;
      this.lines.colour(colour, 0.7 * alpha);
      this.lines.add(
        target[0], target[1] + lift, target[2], preferred[0], preferred[1] + lift, preferred[2],
      );
      this.marks.addHex(
        target[0], target[1] + lift, target[2], 0.075 * leg, colour, alpha, RING,
      );
      this.marks.addHex(
        preferred[0], preferred[1] + lift, preferred[2], 0.04 * leg, colour, alpha, DIAMOND,
      );
    }
  }

  drawRoute(leg) {
    const path = this.store.document?.path ?? [];
    if (path.length === 0) return;
    const lift = 0.012 * leg;
    this.lines.colour(WAY, 0.9);
    for (let i = 0; i < path.length; i++) {
      const [x, z] = path[i];
      if (i > 0) this.alongGround(path[i - 1][0], path[i - 1][1], x, z, lift, leg);
      const last = i === path.length - 1;
      const y = this.heightAt(x, z) + lift;
      this.marks.addHex(x, y, z, (last ? 0.24 : 0.09) * leg, WAY, 0.95, last ? RING : DISC);
      if (last) this.marks.addHex(x, y, z, 0.08 * leg, WAY, 0.95, DISC);
    }
  }

  // A straight way in plan, laid on the ground.
  alongGround(ax, az, bx, bz, lift, leg) {
    const pieces = Math.min(Math.max(Math.ceil(Math.hypot(bx - ax, bz - az) / (0.5 * leg)), 1), 64);
    let x = ax, z = az, y = this.heightAt(ax, az) + lift;
    for (let i = 1; i <= pieces; i++) {
      const nx = ax + ((bx - ax) * i) / pieces, nz = az + ((bz - az) * i) / pieces;
      const ny = this.heightAt(nx, nz) + lift;
      this.lines.add(x, y, z, nx, ny, nz);
      x = nx; y = ny; z = nz;
    }
  }

  drawTrail(now) {
    const kept = Math.min(this.trailCount, TRAIL_POINTS);
    for (let n = this.trailCount - kept + 1; n < this.trailCount; n++) {
      const a = 4 * ((n - 1) % TRAIL_POINTS), b = 4 * (n % TRAIL_POINTS);
      const age = (now - this.trail[b + 3]) / TRAIL;
      // What lies ahead of the playhead the picture does not show yet.
      if (age > 1 || age < 0) continue;
      this.trailLines.colour("#ffb454", 1 - 0.85 * age);
      this.trailLines.add(
        this.trail[a], this.trail[a + 1], this.trail[a + 2],
        this.trail[b], this.trail[b + 1], this.trail[b + 2],
      );
    }
  }
}
