// Orders on their way. They reach the server in the order in which the hand gave them, and until
// they are answered `wanted` says what will be asked for: a change that is made out of what there
// is (one more point of a path, one number of an obstacle) is made out of that, or quick hands
// would undo what they did a moment ago.

// What answers the question of a toggle: the order that was given last says how it will be.
const TOGGLES = { playing: "clock", on: "record" };

export class Orders {
  // `carry(order)` sends one and gives a promise of its answer; `present()` is what the server said
  // last: its document.
  constructor(carry, present) {
    Object.assign(this, { carry, present });
    this.given = []; // sent, and not answered yet
    this.held = null; // an edit that waits for the one of its place before it: only the newest does
    this.made = null; // `wanted`, as long as it holds
    this.madeOf = null;
  }

  // Send an order after all that was asked for before. Rejects with the server's word.
  send(order) {
    this.release();
    return this.give({ order, done: null }).done;
  }

  // Change a place of the document: of a drag one edit is on its way at a time and only the newest
  // after it, so that it never runs ahead of the simulation nor floods the link.
  edit(at, to, gesture) {
    const order = { do: "edit", at, to };
    if (gesture !== undefined) order.gesture = gesture;
    const key = JSON.stringify([at, gesture ?? null]);
    if (this.held?.key === key) {
      this.held.order = order;
      this.made = null;
      return this.held.done;
    }
    this.release();
    const one = { order, key, done: null, length: lengthAt(this.wanted, at) };
    if (gesture === undefined || !this.given.some((other) => other.key === key)) return this.give(one).done;
    one.done = new Promise((resolve, reject) => { one.settle = { resolve, reject }; });
    this.held = one;
    this.made = null;
    return one.done;
  }

  // Wait until all that was asked for up to now is done, or refused.
  async settled() {
    this.release();
    await Promise.allSettled(this.given.map(({ done }) => done));
  }

  // What is held back goes now: something else was asked for after it.
  release() {
    const one = this.held;
    this.held = null;
    if (one) this.give(one);
  }

  give(one) {
    this.given.push(one);
    this.made = null;
    const answered = this.carry(one.order).finally(() => {
      this.given.splice(this.given.indexOf(one), 1);
      this.made = null;
      if (this.held && this.held.key === one.key) this.release();
    });
    if (one.settle) answered.then(one.settle.resolve, one.settle.reject);
    else one.done = answered;
    return one;
  }

  // How a toggle will be, `now` where nothing was asked: "playing" of the clock, "on" of the record.
  toggled(key, now) {
    const asked = this.given.filter(({ order }) => order.do === TOGGLES[key] && key in order);
    return asked.at(-1)?.order[key] ?? now;
  }

  // The document as it will be when all orders are done. Not to be changed.
  get wanted() {
    const present = this.present();
    if (this.made === null || this.madeOf !== present) {
      const orders = this.held ? [...this.given, this.held] : this.given;
      this.made = orders.reduce(after, present);
      this.madeOf = present;
    }
    return this.made;
  }
}

// A document after an order, as far as the page can know: who undoes sees what comes back later.
function after(document, { order, length }) {
  if (!document) return document;
  // The document comes before the order's answer: what it took out already is not taken out twice.
  if (order.to === null && length !== undefined && length !== lengthAt(document, order.at)) return document;
  if (order.do === "open") return order.document;
  if (order.do === "gait") return { ...document, gait: order.name && { name: order.name } };
  return order.do === "edit" ? edited(document, order.at, order.to) : document;
}

// How long the list is that has an item at a place; undefined where that is no list.
function lengthAt(document, at) {
  const list = at.slice(0, -1).reduce((part, step) => part?.[step], document);
  return Array.isArray(list) ? list.length : undefined;
}

// A document, or a part of it, with another value at a place; null takes an item out of a list.
function edited(part, [step, ...rest], to) {
  const there = typeof part === "object" && part !== null;
  if (!there || (rest.length && !(step in part))) return part; // the server will refuse it
  if (rest.length === 0 && to === null && Array.isArray(part)) return part.toSpliced(step, 1);
  const copy = Array.isArray(part) ? [...part] : { ...part };
  copy[step] = rest.length ? edited(part[step], rest, to) : to;
  return copy;
}
