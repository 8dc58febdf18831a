// What the pointer does in the scene. Whatever it takes hold of, a body, a crate, a handle, is
// dragged; else the view turns, as the cameras have it, and a click on the ground is an order.

import { MOVE } from "/page/moves.js";
import { PushDrag } from "/page/push.js";
import { WayDrawing } from "/page/way.js";
import { turned } from "/page/obstacle_edit.js";

const CLICK = 6; // pixels: moved less, it was a click
const NUDGE = 0.05; // leg lengths, by an arrow key
const TURN = Math.PI / 36; // by a key

export const MODES = {
  walk: { title: "Walk", hint: "Click the ground to send it there, with Shift to add a place. Drag its body to push it." },
  path: { title: "Draw a path", hint: "Drag over the ground to draw the way it takes." },
  push: { title: "Push", hint: "Drag from a creature: it is pushed when you let go." },
  crate: { title: "Crates", hint: "Click a crate; drag it, its ring to turn it, its corners to resize it (Shift: all sides alike). Delete removes it." },
};

export class Tools {
  constructor(parts) {
    Object.assign(this, parts); // store, scene, canvas, rays, handles, ground, cameras, creatures, note
    this.mode = "walk";
    this.listeners = new Set();
    this.push = new PushDrag(this.scene, this.store, this.creatures, this.rays, this.note);
    this.way = new WayDrawing(this.scene, this.store, this.ground);
    this.held = null; // what a drag is of: {move, end, cancel}
    this.press = null; // where the pointer went down, while it may still be a click
    this.hovered = null;
    const { canvas } = this;
    // Before the cameras hear of it, which then do not.
    canvas.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    canvas.addEventListener(MOVE, (event) => this.drag(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.moved(event), { capture: true });
    canvas.addEventListener("pointerup", (event) => this.up(event), { capture: true });
    canvas.addEventListener("pointercancel", () => this.cancel(), { capture: true });
    canvas.addEventListener("pointerleave", () => { this.hovered = null; });
    canvas.addEventListener("keydown", (event) => this.key(event));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  onMode(listener) {
    this.listeners.add(listener);
    listener(this.mode);
  }

  choose(mode) {
    if (!(mode in MODES)) throw new Error(`there is no mode ${mode}; there are ${Object.keys(MODES).join(", ")}`);
    this.cancel();
    this.mode = mode;
    for (const listener of this.listeners) listener(mode);
  }

  // What would be taken at the place of an event: {what, ...}.
  target(event) {
    const grip = this.handles.at(event);
    if (grip && this.mode !== "path") return { what: "handle", grip };
    this.rays.aim(event);
    if (this.mode === "path") return { what: "ground", place: this.rays.groundPlace() };
    const obstacle = this.mode === "push" ? null : this.rays.obstacle();
    const creature = this.mode === "crate" ? null : this.rays.creature();
    const place = this.rays.groundPlace();
    const away = place ? place.distanceTo(this.rays.ray.origin) : Infinity;
    if (obstacle && obstacle.distance <= Math.min(creature?.distance ?? Infinity, away)) {
      return { what: "crate", ...obstacle };
    }
    // A push may be taken from anywhere on the body, so the ground before a leg does not hide it.
    if (creature) return { what: "creature", ...creature };
    return { what: "ground", place };
  }

  down(event) {
    if (!event.isPrimary) {
      this.cancel(); // two fingers: the cameras'
      return;
    }
    if (event.button !== 0 || !this.store.creature || !this.store.document) return;
    const target = this.target(event);
    this.press = { x: event.clientX, y: event.clientY, target, shift: event.shiftKey };
    if (!this.store.drives) return;
    this.held = this.take(target, event);
    if (!this.held) return;
    event.stopImmediatePropagation();
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.focus({ preventScroll: true });
  }

  take(target, event) {
    const { handles, push, way } = this;
    switch (target.what) {
      case "handle":
        handles.begin(target.grip, event);
        return handles;
      case "crate":
        handles.select(target.index);
        handles.begin({ part: "body" }, event);
        return this.afterClick(handles);
      case "creature":
        push.begin(target, event);
        return push;
      default:
        if (this.mode !== "path" || !target.place) return null;
        way.begin(target.place);
        return {
          move: (next) => {
            this.rays.aim(next);
            const place = this.rays.groundPlace();
            if (place) way.move(place);
          },
          end: () => this.drawn(way.end()),
          cancel: () => way.cancel(),
        };
    }
  }

  // A hand trembles: nothing moves before the pointer has clearly moved.
  afterClick(held) {
    return {
      move: (event) => { if (!this.press) held.move(event); },
      end: () => held.end(),
      cancel: () => held.cancel(),
    };
  }

  drag(event) {
    if (this.press && Math.hypot(event.clientX - this.press.x, event.clientY - this.press.y) > CLICK) {
      this.press = null;
    }
    this.held?.move(event);
  }

  moved(event) {
    if (this.held) event.stopImmediatePropagation();
    else if (event.buttons === 0 && event.pointerType !== "touch") this.hovered = event;
  }

  up(event) {
    const { press, held } = this;
    this.press = this.held = null;
    if (held) {
      event.stopImmediatePropagation();
      held.end();
    }
    if (press && event.button === 0) this.click(press);
  }

  click({ target, shift }) {
    const { store, handles } = this;
    if (target.what === "creature") this.watch(target);
    if (target.what !== "ground" || this.mode === "path" || this.mode === "push") return;
    if (handles.index !== null) handles.select(null);
    else if (this.mode === "walk" && target.place) {
      if (!store.drives) {
        store.say("Another tab drives; take over to send the creature somewhere.");
        return;
      }
      const place = [target.place.x, target.place.z].map((number) => Number(number.toFixed(4)));
      store.edit(["path"], shift ? [...store.wanted.path, place] : [place]);
    }
  }

  // Its numbers are shown from now on, and views follow it.
  watch({ kind, creature }) {
    const { focus } = this.store.frame;
    if (focus.kind === kind && focus.creature === creature) return;
    this.store.send({ do: "watch", creature: this.push.number(kind, creature) })
      .catch((refusal) => this.store.say(refusal.message));
  }

  drawn(path) {
    if (!path) return;
    this.store.edit(["path"], path.map((place) => place.map((number) => Number(number.toFixed(4)))));
  }

  cancel() {
    const { held } = this;
    this.press = this.held = null;
    held?.cancel();
  }

  key(event) {
    if (event.key === "Escape") {
      if (this.held) this.cancel();
      else if (this.handles.index !== null) this.handles.select(null);
      else this.choose("walk");
      return;
    }
    if (this.handles.index === null || !this.store.drives) return;
    if (event.key === "Delete" || event.key === "Backspace") this.handles.remove();
    else if (event.key === "[" || event.key === "]") this.turn(event.key === "[" ? TURN : -TURN);
    else if (!this.nudge(event.key)) return;
    // Arrow keys steer elsewhere; here they move what is chosen.
    event.preventDefault();
    event.stopPropagation();
  }

  turn(angle) {
    const { handles } = this;
    if (!handles.canTurn) return;
    const { obstacle, index } = handles;
    this.store.edit(["obstacle", index], { ...obstacle, ...turned(obstacle, angle) });
  }

  // Along the axis of the world that looks most like the key's direction.
  nudge(key) {
    const way = { ArrowUp: 0, ArrowLeft: 1, ArrowDown: 2, ArrowRight: 3 }[key];
    if (way === undefined) return false;
    const { x, z } = this.cameras.direction;
    const quarter = Math.round(Math.atan2(-x, -z) / (Math.PI / 2)) + way;
    const step = NUDGE * this.store.creature.leg_length;
    const [px, py, pz] = this.handles.obstacle.position;
    const dx = Math.round(Math.sin((quarter * Math.PI) / 2)) * step;
    const dz = Math.round(Math.cos((quarter * Math.PI) / 2)) * step;
    const rise = this.ground.relief.height(px + dx, pz + dz) - this.ground.relief.height(px, pz);
    this.store.edit(["obstacle", this.handles.index, "position"], [px + dx, py + rise, pz + dz]);
    return true;
  }

  // Once a picture at most: say by the cursor what can be taken.
  hover() {
    const event = this.hovered;
    this.hovered = null;
    if (!event || this.held || !this.store.creature || !this.store.drives) return;
    const { what } = this.target(event);
    this.canvas.style.cursor = this.mode === "path"
      ? "crosshair"
      : { handle: "move", crate: "pointer", creature: "grab", ground: "" }[what];
  }
}
