// How high the ground is: its triangles in buckets of the plan, so that asking costs nothing.

const MOST_BUCKETS = 256; // along a side

export class Relief {
  constructor() {
    this.columns = 0;
    this.lowest = 0;
    this.highest = 0;
  }

  take(places, triangles) {
    this.places = places;
    this.triangles = triangles;
    this.bound(places);
    const count = triangles.length / 3;
    const side = Math.min(Math.max(Math.ceil(Math.sqrt(count / 2)), 1), MOST_BUCKETS);
    this.columns = this.rows = side;
    this.cellX = Math.max((this.mostX - this.leastX) / side, 1e-9);
    this.cellZ = Math.max((this.mostZ - this.leastZ) / side, 1e-9);
    // Counted first and filled then: two flat arrays instead of thousands of lists.
    this.start = new Uint32Array(side * side + 1);
    this.eachBucket((bucket) => { this.start[bucket + 1] += 1; });
    for (let b = 0; b < side * side; b++) this.start[b + 1] += this.start[b];
    const filled = this.start.slice();
    this.listed = new Uint32Array(this.start[side * side]);
    this.eachBucket((bucket, triangle) => { this.listed[filled[bucket]++] = triangle; });
  }

  bound(places) {
    this.leastX = this.leastZ = this.lowest = Infinity;
    this.mostX = this.mostZ = this.highest = -Infinity;
    for (let i = 0; i < places.length; i += 3) {
      this.leastX = Math.min(this.leastX, places[i]);
      this.mostX = Math.max(this.mostX, places[i]);
      this.lowest = Math.min(this.lowest, places[i + 1]);
      this.highest = Math.max(this.highest, places[i + 1]);
      this.leastZ = Math.min(this.leastZ, places[i + 2]);
      this.mostZ = Math.max(this.mostZ, places[i + 2]);
    }
  }

  eachBucket(visit) {
    const { places, triangles } = this;
    for (let t = 0; t < triangles.length; t += 3) {
      const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
      const first = this.column(Math.min(places[a], places[b], places[c]));
      const last = this.column(Math.max(places[a], places[b], places[c]));
      const top = this.row(Math.min(places[a + 2], places[b + 2], places[c + 2]));
      const bottom = this.row(Math.max(places[a + 2], places[b + 2], places[c + 2]));
      for (let row = top; row <= bottom; row++) {
        for (let column = first; column <= last; column++) {
          visit(row * this.columns + column, t);
        }
      }
    }
  }

  column(x) {
    return Math.min(Math.max(Math.floor((x - this.leastX) / this.cellX), 0), this.columns - 1);
  }

  row(z) {
    return Math.min(Math.max(Math.floor((z - this.leastZ) / this.cellZ), 0), this.rows - 1);
  }

  // The highest ground at x, z; beyond its edge that at the edge.
  height(x, z) {
    if (this.columns === 0) return 0;
    const inX = Math.min(Math.max(x, this.leastX), this.mostX);
    const inZ = Math.min(Math.max(z, this.leastZ), this.mostZ);
    const bucket = this.row(inZ) * this.columns + this.column(inX);
    let highest = -Infinity;
    for (let i = this.start[bucket]; i < this.start[bucket + 1]; i++) {
      highest = Math.max(highest, this.heightIn(this.listed[i], inX, inZ));
    }
    return highest === -Infinity ? this.lowest : highest;
  }

  heightIn(t, x, z) {
    const { places, triangles } = this;
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const bx = places[b] - places[a], bz = places[b + 2] - places[a + 2];
    const cx = places[c] - places[a], cz = places[c + 2] - places[a + 2];
    const px = x - places[a], pz = z - places[a + 2];
    const area = bx * cz - bz * cx;
    if (Math.abs(area) < 1e-14) return -Infinity; // upright: a step's face
    const u = (px * cz - pz * cx) / area;
    const v = (bx * pz - bz * px) / area;
    if (u < -1e-6 || v < -1e-6 || u + v > 1 + 1e-6) return -Infinity;
    return places[a + 1] + u * (places[b + 1] - places[a + 1]) + v * (places[c + 1] - places[a + 1]);
  }

  // Where a ray first meets the ground, written into `out`; false where it goes to the sky.
  // `step` [m] is how closely it looks.
  meet(ray, step, out) {
    const { origin, direction } = ray;
    if (direction.y < -1e-6 || origin.y < this.highest) {
      // No need to look above the highest place.
      let t = origin.y > this.highest ? (this.highest - origin.y) / direction.y : 0;
      const reach = direction.y < 0
        ? (this.lowest - 1e-6 - origin.y) / direction.y
        : t + 500 * step;
      const stride = Math.max(step, (reach - t) / 1000);
      let before = t;
      for (; t < reach + stride; before = t, t += stride) {
        if (this.above(ray, t) <= 0) return this.refine(ray, before, t, out);
      }
    }
    return false;
  }

  above({ origin, direction }, t) {
    const height = this.height(origin.x + t * direction.x, origin.z + t * direction.z);
    return origin.y + t * direction.y - height;
  }

  refine(ray, before, after, out) {
    for (let i = 0; i < 24; i++) {
      const middle = 0.5 * (before + after);
      if (this.above(ray, middle) <= 0) after = middle;
      else before = middle;
    }
    out.copy(ray.direction).multiplyScalar(after).add(ray.origin);
    return true;
  }
}
