// The websocket: orders out, messages and frames in. A lost connection is taken up again.

import { decodeArrays, decodeFrame } from "/page/frames.js";
import { renewToken } from "/page/restart.js";

const FIRST_WAIT = 300; // ms before it tries again, and twice as long each time
const LONGEST_WAIT = 5000;
const PATIENCE = 10000; // ms for which an order waits for its answer

export class Link {
  constructor(store) {
    this.store = store;
    this.waiting = new Map();
    this.next = 1;
    this.wait = FIRST_WAIT;
    this.received = 0; // bytes and frames, for whoever measures
    this.frames = 0;
    this.overlays = [];
    this.watched = 0;
    this.open();
  }

  open() {
    const where = `ws://${location.host}/link?token=${encodeURIComponent(this.store.token)}`;
    this.socket = new WebSocket(where);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => {
      this.wait = FIRST_WAIT;
      this.store.connected = true;
      this.store.tell("link", true);
      // What this tab wanted to see it wants to see again.
      if (this.overlays.length) this.see(this.overlays).catch(() => {});
      if (this.watched) this.send({ do: "watch", creature: this.watched }).catch(() => {});
    };
    this.socket.onmessage = (event) => this.take(event.data);
    this.socket.onclose = () => this.lost();
  }

  lost() {
    this.store.connected = false;
    this.store.tell("link", false);
    for (const [, answer] of this.waiting) answer.reject(new Error("the connection was lost"));
    this.waiting.clear();
    setTimeout(() => this.reopen(), this.wait);
    this.wait = Math.min(2 * this.wait, LONGEST_WAIT);
  }

  // The studio may have been started anew meanwhile.
  async reopen() {
    try {
      await renewToken();
    } catch { /* it is not there yet */ }
    this.open();
  }

  send(order) {
    if (this.socket.readyState !== WebSocket.OPEN) {
      return Promise.reject(new Error("there is no connection; it is being taken up again"));
    }
    const id = this.next++;
    if (order.do === "watch") this.watched = order.creature;
    this.socket.send(JSON.stringify({ ...order, id }));
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => {
        this.waiting.delete(id);
        reject(new Error("the studio has not answered"));
      }, PATIENCE);
      this.waiting.set(id, {
        resolve: (message) => { clearTimeout(timer); resolve(message); },
        reject: (error) => { clearTimeout(timer); reject(error); },
      });
    });
  }

  see(overlays) {
    this.overlays = overlays;
    return this.send({ do: "see", overlays });
  }

  take(data) {
    if (typeof data === "string") {
      this.hear(JSON.parse(data));
      return;
    }
    this.received += data.byteLength;
    const kind = new DataView(data).getUint32(0, true);
    const store = this.store;
    if (kind === 1) {
      this.frames += 1;
      store.before = store.frame;
      store.frame = decodeFrame(data);
      // Without waiting for an answer: three frames may be under way.
      this.socket.send(JSON.stringify({ do: "ack", frame: store.frame.number }));
      store.tell("frame", store.frame);
    } else if (kind === 2) {
      store.tell("arrays", decodeArrays(data));
    }
  }

  hear(message) {
    const store = this.store;
    switch (message.is) {
      case "done":
      case "refused": {
        const answer = this.waiting.get(message.id);
        this.waiting.delete(message.id);
        if (answer && message.is === "done") answer.resolve(message);
        else if (answer) answer.reject(new Error(message.why));
        else if (message.is === "refused") store.say(message.why);
        return;
      }
      case "welcome":
        store.welcome = message;
        store.drives = message.drives;
        break;
      case "role":
        store.drives = message.drives;
        break;
      case "document":
        store.document = message.document;
        store.canUndo = message.can_undo;
        store.canRedo = message.can_redo;
        break;
      case "limits": // of the creature that walks: what of it has changed
        Object.assign(store.creature, { ...message, is: "creature" });
        break;
      case "trouble":
        store.say(message.why);
        break;
      default:
        store[message.is] = message;
    }
    store.tell(message.is, message);
  }
}
