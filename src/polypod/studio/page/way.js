// Drawing a way with the pointer: a line that follows it, then a path of few points.

import { Lines } from "/page/lines.js";

const CLOSEST = 0.1; // leg lengths between two points of the line
const OFF = 0.06; // leg lengths that the path may be off the line
const SMOOTHINGS = 4;
const MOST = 200; // points of a path

export class WayDrawing {
  constructor(scene, store, ground) {
    this.store = store;
    this.ground = ground;
    this.lines = new Lines(scene, { width: 3, order: 9 });
    this.points = []; // [x, z]
  }

  begin(place) {
    this.points = [[place.x, place.z]];
    this.lines.clear().colour("#6cb4ee");
  }

  move(place) {
    const leg = this.store.creature.leg_length;
    const [x, z] = this.points[this.points.length - 1];
    if (Math.hypot(place.x - x, place.z - z) < CLOSEST * leg) return;
    const lift = 0.015 * leg;
    this.points.push([place.x, place.z]);
    this.lines.add(
      x, this.ground.relief.height(x, z) + lift, z, place.x, place.y + lift, place.z,
    );
    this.lines.commit();
  }

  // The path that was drawn, or null where it was a click.
  end() {
    this.cancel();
    if (this.points.length < 2) return null;
    const leg = this.store.creature.leg_length;
    return simplified(smoothed(this.points), OFF * leg).slice(0, MOST);
  }

  cancel() {
    this.lines.clear().commit();
  }
}

// Points [x, z] without the trembling of a hand; the ends stay.
export function smoothed(points) {
  let line = points;
  for (let n = 0; n < SMOOTHINGS; n++) {
    line = line.map((point, i) => {
      if (i === 0 || i === line.length - 1) return point;
      const [ax, az] = line[i - 1], [bx, bz] = line[i + 1];
      return [(ax + 2 * point[0] + bx) / 4, (az + 2 * point[1] + bz) / 4];
    });
  }
  return line;
}

// As few of the points as keep the line within `off` of all (Douglas and Peucker).
export function simplified(points, off) {
  if (points.length < 3) return points;
  const [ax, az] = points[0];
  const [bx, bz] = points[points.length - 1];
  const length = Math.hypot(bx - ax, bz - az);
  let farthest = 0;
  let most = off;
  for (let i = 1; i < points.length - 1; i++) {
    const [x, z] = points[i];
    // Of a loop, whose ends meet, the farthest point counts.
    const away = length < 1e-9
      ? Math.hypot(x - ax, z - az)
      : Math.abs((x - ax) * (bz - az) - (z - az) * (bx - ax)) / length;
    if (away > most) {
      farthest = i;
      most = away;
    }
  }
  if (farthest === 0) return [points[0], points[points.length - 1]];
  const before = simplified(points.slice(0, farthest + 1), off);
  return [...before.slice(0, -1), ...simplified(points.slice(farthest), off)];
}
