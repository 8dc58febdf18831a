// What the page knows: the last word of the server on everything, and who wants to hear of it.
// Nothing here is changed by the page itself: it sends orders, and the server's answer changes it.

import { Orders } from "/page/orders.js";

export class Store {
  constructor() {
    this.document = null; // see docs/studio-protocol.md
    this.creature = null;
    this.kinds = null;
    this.clock = { playing: true, rate: 1, time: 0, frame: 0, behind: 1 };
    this.verdict = null;
    this.tape = { recording: false, frames: 0, seconds: 0, scrub: null, kinds: [] };
    this.welcome = null;
    this.files = null; // meshes and grounds that are there
    this.backdrop = { obstacle: null, ground: null }; // what stood in the frame of the tape that is shown
    this.drives = false;
    this.canUndo = false;
    this.canRedo = false;
    this.connected = false;
    this.frame = null; // as frames.js decodes it
    this.before = null; // the frame before it
    this.link = null; // see link.js
    this.orders = new Orders((order) => this.link.send(order), () => this.document);
    this.listeners = new Map();
  }

  // Call `listener` whenever something of a kind comes: "document", "creature", "kinds", "clock",
  // "limits", "verdict", "tape", "files", "backdrop", "welcome", "role", "frame", "arrays", "link",
  // "words", "rig" (was given), "wanted" (an edit was asked for); "joint": rows of the joints that are
  // being limited; "skin" and "ground" when these are there to be drawn. Returns how to stop.
  on(kind, listener) {
    if (!this.listeners.has(kind)) this.listeners.set(kind, new Set());
    this.listeners.get(kind).add(listener);
    return () => this.listeners.get(kind).delete(listener);
  }

  tell(kind, value) {
    for (const listener of this.listeners.get(kind) ?? []) listener(value);
  }

  // The document as it will be when all that is on its way is done: what a change is made out of,
  // and what controls show. Not to be changed.
  get wanted() {
    return this.orders.wanted;
  }

  // Whether time goes on, and whether the walk is recorded, as was asked last.
  get playing() {
    return this.orders.toggled("playing", this.clock.playing);
  }

  get recording() {
    return this.orders.toggled("on", this.tape.recording);
  }

  // Send an order; resolves when it is done, rejects with the server's word when it is refused.
  send(order) {
    return this.orders.send(order);
  }

  // Change a place of the document. What is refused is said to the user, and controls go back to
  // what holds; edits of one gesture (a drag) are one step of undo.
  edit(at, to, gesture = undefined) {
    const done = this.orders.edit(at, to, gesture).catch((refusal) => {
      this.say(refusal.message);
      if (this.document) this.tell("document", { document: this.document });
    });
    this.tell("wanted", this.wanted);
    return done;
  }

  // Say something to the user, in the line at the bottom.
  say(words, good = false) {
    this.tell("words", { words, good });
  }

  get token() {
    return document.querySelector("meta[name=polypod-token]").content;
  }

  // Fetch what depends on what was asked for, after all of that is done.
  async fetchSettled(route, options = {}) {
    await this.orders.settled();
    return this.fetch(route, options);
  }

  // Fetch a route with the token; throws the server's own word where it says no.
  async fetch(route, options = {}) {
    const headers = { ...(options.headers ?? {}), "X-Polypod-Token": this.token };
    const answer = await fetch(route, { ...options, headers });
    if (answer.status === 204) throw new Error("it is there no more");
    if (answer.ok) return answer;
    let why = `${answer.status} ${answer.statusText}`;
    try {
      why = (await answer.json()).why ?? why;
    } catch { /* no JSON: the status says it */ }
    throw new Error(why);
  }
}

let gestures = 0;

// A name for a new gesture.
export function newGesture() {
  gestures += 1;
  return `g${gestures}-${performance.now().toFixed(0)}`;
}
