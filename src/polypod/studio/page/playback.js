// When to show what: frames come in bursts, pictures are drawn whenever the screen wants one. The
// playhead runs on the server's clock, one frame behind the newest, and poses are blended there.

const KEPT = 4; // frames
const LARGEST_GAP = 0.25; // s between two frames: beyond, nothing is blended across
const CATCH_UP = 4; // 1/s: how fast the playhead goes to where it should be

export class Playback {
  constructor(store) {
    this.store = store;
    this.frames = []; // the oldest first
    this.playhead = 0; // s, the server's
    this.interval = 1 / 30; // s between frames, on average, the server's
    this.last = 0; // ms, when it was drawn last
    this.from = null;
    this.to = null;
    this.share = 1; // of `to`
    store.on("frame", (frame) => this.take(frame));
  }

  take(frame) {
    const newest = this.frames[this.frames.length - 1];
    if (newest && !continues(newest, frame)) this.frames.length = 0;
    if (this.frames.length === 0) this.playhead = frame.time;
    else if (frame.time > newest.time) {
      this.interval += 0.1 * (frame.time - newest.time - this.interval);
    }
    // Paused, the same moment comes again, perhaps with something moved in it.
    if (newest && frame.time === newest.time) this.frames.pop();
    this.frames.push(frame);
    if (this.frames.length > KEPT) this.frames.shift();
  }

  // Find the two frames to blend at `now` [ms]; false while there is none.
  advance(now) {
    const elapsed = Math.min((now - this.last) / 1000, 0.5);
    this.last = now;
    const frames = this.frames;
    if (frames.length === 0) return false;
    const newest = frames[frames.length - 1];
    const { playing, rate, behind } = this.store.clock;
    const scrubbing = newest.tapeFrame !== null;
    if (!playing || scrubbing || frames.length === 1) {
      this.playhead = newest.time;
    } else {
      const sought = newest.time - this.interval
        + 0.001 * (now - newest.received) * rate * Math.max(behind, 0.1);
      this.playhead += elapsed * rate * Math.max(behind, 0.1);
      this.playhead += (sought - this.playhead) * Math.min(1, CATCH_UP * elapsed);
      this.playhead = Math.min(Math.max(this.playhead, frames[0].time), newest.time);
    }
    let next = frames.length - 1;
    while (next > 1 && frames[next - 1].time >= this.playhead) next--;
    this.to = frames[next];
    this.from = frames[Math.max(next - 1, 0)];
    const span = this.to.time - this.from.time;
    this.share = span > 0 ? Math.min(Math.max((this.playhead - this.from.time) / span, 0), 1) : 1;
    return true;
  }
}

// Whether a frame goes on where the one before it was: the same creatures, a little later.
function continues(before, frame) {
  if ((before.tapeFrame === null) !== (frame.tapeFrame === null)) return false;
  if (frame.time < before.time || frame.time - before.time > LARGEST_GAP) return false;
  if (before.herds.length !== frame.herds.length) return false;
  return before.herds.every((herd, h) => (
    herd.count === frame.herds[h].count && herd.joints === frame.herds[h].joints
  ));
}

// Blend pose number i of two arrays of seven floats into out[o ...]: quaternion, place.
export function blendPose(out, o, from, to, i, share) {
  const s = 7 * i;
  const own = 1 - share;
  const dot = from[s] * to[s] + from[s + 1] * to[s + 1]
    + from[s + 2] * to[s + 2] + from[s + 3] * to[s + 3];
  const other = dot < 0 ? -share : share;
  const x = own * from[s] + other * to[s];
  const y = own * from[s + 1] + other * to[s + 1];
  const z = own * from[s + 2] + other * to[s + 2];
  const w = own * from[s + 3] + other * to[s + 3];
  const scale = 1 / Math.sqrt(x * x + y * y + z * z + w * w);
  out[o] = x * scale;
  out[o + 1] = y * scale;
  out[o + 2] = z * scale;
  out[o + 3] = w * scale;
  out[o + 4] = own * from[s + 4] + share * to[s + 4];
  out[o + 5] = own * from[s + 5] + share * to[s + 5];
  out[o + 6] = own * from[s + 6] + share * to[s + 6];
}
