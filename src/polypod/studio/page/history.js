// What the creature in focus did: the last seconds as they come, and what was recorded. The page
// keeps it, for the server sends each frame once.

const LIVE_SECONDS = 12;
const SAME_TIME = 1e-4; // s

// What plots need of a frame.
function sampleOf(frame) {
  const { focus } = frame;
  // Heights are over the plane that the feet stand on, under the body.
  const plane = focus.bodyHeight - focus.height;
  return {
    time: frame.time,
    needle: focus.needle,
    height: focus.height,
    level: focus.preferredHeight - focus.sink, // about which body and particles go up and down
    force: focus.force,
    speed: focus.speed,
    stance: focus.feet.map((foot) => foot.stance),
    foot: focus.feet.map((foot) => foot.sole[1] - plane),
    particle: focus.feet.map((foot) => foot.particle),
    load: focus.feet.map((foot) => foot.load),
  };
}

const histories = new WeakMap();

// The one history of a store, for all who draw it.
export function historyOf(store) {
  if (!histories.has(store)) histories.set(store, new History(store));
  return histories.get(store);
}

class History {
  constructor(store) {
    this.store = store;
    this.live = []; // by time, of the last seconds
    this.tape = []; // by time, of what is recorded as far as its frames came to this page
    this.begin = null; // s, when the tape begins
    this.version = 0; // of the tape, for who draws it
    this.scrubbed = null; // the sample of the tape that is shown
    this.recording = false;
    store.on("frame", (frame) => this.take(frame));
    store.on("tape", (tape) => this.takeTape(tape));
    store.on("creature", () => { this.live = []; });
  }

  take(frame) {
    const sample = sampleOf(frame);
    if (frame.tapeFrame !== null) {
      this.takeScrubbed(frame.tapeFrame, sample);
      return;
    }
    const last = this.live.at(-1);
    const other = `${frame.focus.kind} ${frame.focus.creature} ${sample.stance.length}`;
    if (other !== this.of || (last && sample.time < last.time)) this.live = [];
    this.of = other;
    if (this.live.length && sample.time === last.time) return; // paused
    this.live.push(sample);
    while (sample.time - this.live[0].time > LIVE_SECONDS) this.live.shift();
    if (this.recording) {
      this.tape.push(sample);
      this.version += 1;
    }
  }

  // Frames of the tape carry the time at which they were recorded: now it is known exactly when it
  // began, and what this page missed is filled in.
  takeScrubbed(frame, sample) {
    this.scrubbed = sample;
    const begin = sample.time - frame / tapeRate(this.store);
    if (this.begin !== null && Math.abs(begin - this.begin) > 1e-6) this.version += 1;
    this.begin = begin;
    const after = this.tape.findIndex(({ time }) => time > sample.time - SAME_TIME);
    if (after >= 0 && this.tape[after].time < sample.time + SAME_TIME) return;
    this.tape.splice(after < 0 ? this.tape.length : after, 0, sample);
    this.version += 1;
  }

  takeTape({ recording, frames }) {
    if ((recording && !this.recording) || frames === 0) {
      // A new tape begins with what is shown now, or there is none.
      this.tape = recording ? this.live.slice(-1) : [];
      this.begin = this.tape[0]?.time ?? null;
      this.version += 1;
    }
    this.recording = recording;
  }

  // Samples of the `seconds` before a frame of the walk or of the tape, oldest first.
  before({ time, tapeFrame }, seconds) {
    const known = tapeFrame === null ? this.live : this.tape;
    const end = known.findIndex((sample) => sample.time > time + SAME_TIME);
    const until = end < 0 ? known : known.slice(0, end);
    const from = until.findIndex((sample) => time - sample.time <= seconds);
    // One more, so that lines reach to the edge.
    return from < 0 ? [] : until.slice(Math.max(from - 1, 0));
  }

  // What is known of the tape: [{x: s since it began, sample}].
  recorded() {
    return this.tape.map((sample) => ({ x: sample.time - this.begin, sample }));
  }
}

// Frames of the tape a second.
export function tapeRate({ tape, welcome }) {
  const { frames, seconds } = tape;
  return frames > 1 && seconds > 0 ? (frames - 1) / seconds : welcome?.fps ?? 60;
}
