// What the creature in focus did: the last seconds as they come, and what was recorded, by the
// frame of the tape. The page keeps it, for the server sends each frame once.

const LIVE_SECONDS = 12;

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
    this.tape = []; // by the tape's frame; holes where no frame came
    this.version = 0; // of the tape, for who draws it
    this.firstNumber = null; // of the simulation's frame that is the tape's first
    store.on("frame", (frame) => this.take(frame));
    store.on("tape", (tape) => this.takeTape(tape));
    store.on("creature", () => { this.live = []; });
  }

  take(frame) {
    const sample = sampleOf(frame);
    if (frame.tapeFrame !== null) {
      if (!this.tape[frame.tapeFrame]) this.keep(frame.tapeFrame, sample);
      return;
    }
    const last = this.live.at(-1);
    const other = `${frame.focus.kind} ${frame.focus.creature} ${sample.stance.length}`;
    if (other !== this.of || (last && sample.time < last.time)) this.live = [];
    this.of = other;
    if (last && sample.time === last.time && this.live.length) return; // paused
    this.live.push(sample);
    while (sample.time - this.live[0].time > LIVE_SECONDS) this.live.shift();
    if (this.store.tape.recording) {
      this.firstNumber ??= frame.number;
      this.keep(frame.number - this.firstNumber, sample);
    }
  }

  takeTape({ recording, frames }) {
    // A new tape, or one that was emptied.
    if ((recording && !this.recording) || frames === 0) {
      this.tape = [];
      this.firstNumber = null;
      this.version += 1;
    }
    this.recording = recording;
    if (!recording && this.tape.length > frames) this.tape.length = frames;
  }

  keep(index, sample) {
    if (index < 0) return;
    this.tape[index] = sample;
    this.version += 1;
  }

  // Samples of the last `seconds`, oldest first.
  recent(seconds) {
    const last = this.live.at(-1);
    if (!last) return [];
    const from = this.live.findIndex((sample) => last.time - sample.time <= seconds);
    // One more, so that lines reach to the edge.
    return this.live.slice(Math.max(from - 1, 0));
  }

  // What is known of the tape: [{frame, sample}].
  recorded() {
    const known = [];
    this.tape.forEach((sample, frame) => known.push({ frame, sample }));
    return known;
  }
}
