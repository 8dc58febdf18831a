// How finely pictures are drawn, as finely as the machine has time for. Nothing here draws: it is told
// how long pictures take, and says at which level to go on.

// `pixels` of the picture, at most, for one of the page's; `shadow`: side of its map, redrawn `every`
// so many pictures, its edges `soft` or not; `small`: pixels that a creature is high, below which it
// has its coarse and its crude skin; `panels`: how often a second wheels and plots are drawn at most.
export const LEVELS = [
  { pixels: 2, shadow: 2048, every: 1, soft: true, small: [60, 20], panels: 60 },
  { pixels: 1, shadow: 1024, every: 1, soft: false, small: [110, 40], panels: 15 },
  { pixels: 0.75, shadow: 1024, every: 2, soft: false, small: [140, 60], panels: 10 },
  { pixels: 0.55, shadow: 512, every: 2, soft: false, small: [260, 120], panels: 8 },
];
export const BEST = 0;
export const FASTEST = LEVELS.length - 1;

const SLOW = 1000 / 28; // ms: pictures that come slower than this are too slow
const QUICK = 1000 / 45; // ms: with pictures that come as quickly there may be time to spare
const JUDGED = 1000; // ms of pictures, and
const FEWEST = 6; // of them, that a judgement is on
const SETTLING = 3; // pictures after a change that tell nothing: shaders are made in them
const ASLEEP = 2000; // ms: longer than any picture takes
const FIRST_WAIT = 5000; // ms that pictures come quickly before a finer level is tried
const LONGEST_WAIT = 320000;
// Of real time: a simulation that keeps less than the first has too little of the processor, one that
// keeps more than the second has enough.
const LATE = 0.96;
const PROMPT = 0.99;
// ms from one picture to the next, where pictures wait for the simulation; and how waits grow and fade
// from one word on how it keeps up to the next.
const LEAST_PAUSE = 40;
const MOST_PAUSE = 110;
const LONGER = 1.25;
const SHORTER = 0.93;
const TRIAL = 15000; // ms: a finer level that is left sooner was too much

export class Quality {
  constructor(level) {
    this.level = level;
    this.wait = FIRST_WAIT;
    this.tried = Infinity; // ms since a finer level was tried
    this.begin();
  }

  // Something else is drawn, so what was learnt of a finer level is no longer true.
  forget() {
    this.wait = FIRST_WAIT;
    this.quickFor = 0;
  }

  begin() {
    this.settling = SETTLING;
    this.quickFor = 0;
    this.clear();
  }

  clear() {
    this.spent = 0;
    this.intervals = [];
  }

  // Take the time [ms] from one picture to the next, while every picture is wanted; returns the
  // level from now on.
  take(interval) {
    if (interval > ASLEEP) {
      this.clear();
      return this.level;
    }
    if (this.settling > 0) {
      this.settling -= 1;
      return this.level;
    }
    this.spent += interval;
    this.intervals.push(interval);
    if (this.spent < JUDGED || this.intervals.length < FEWEST) return this.level;
    this.tried += this.spent;
    // The middle one: a picture that is late once, as when a rig is read, is no slow machine.
    const usual = this.intervals.sort((a, b) => a - b)[this.intervals.length >> 1];
    if (usual > SLOW) this.coarser();
    else this.finer(usual);
    this.clear();
    return this.level;
  }

  coarser() {
    if (this.level === FASTEST) return;
    // Tried in vain: the next time only after twice as long, so that pictures do not go to and fro.
    if (this.tried < TRIAL) this.wait = Math.min(2 * this.wait, LONGEST_WAIT);
    this.tried = Infinity;
    this.level += 1;
    this.begin();
  }

  finer(usual) {
    this.quickFor = usual < QUICK ? this.quickFor + this.spent : 0;
    if (this.quickFor < this.wait || this.level === BEST) return;
    this.level -= 1;
    this.tried = 0;
    this.begin();
  }
}

// Where no GPU draws, pictures and the simulation share the processor, and a crowd that walks in real
// time is worth more than a few pictures more of it in slow motion.
export class Patience {
  constructor() {
    this.pause = 0; // ms from one picture to the next at least
  }

  // Take the share of real time that the simulation keeps, as it is told a few times a second.
  take(kept) {
    if (kept < LATE) this.pause = Math.min(Math.max(LONGER * this.pause, LEAST_PAUSE), MOST_PAUSE);
    else if (kept > PROMPT) this.pause = this.pause > LEAST_PAUSE ? SHORTER * this.pause : 0;
    return this.pause;
  }
}
