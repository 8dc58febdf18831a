// A studio that was ended and started again knows nothing of what was done here: it has another
// token, its own document, and no rigs but its own. The page takes the new token, shows what that
// studio shows, and offers to bring back what was here.

import { make, makeButton } from "/page/elements.js";
import { giveAgain } from "/page/given_files.js";

const LOST = "What you had here is back, but for the meshes and the ground of a scene's files: open that scene once more.";
const TOKEN = /name="polypod-token" content="([\w-]+)"/;

// Take the token that the studio has now. Rejects where there is no studio.
export async function renewToken() {
  const answer = await fetch("/", { cache: "no-store" });
  const token = TOKEN.exec(await answer.text())?.[1];
  const meta = document.querySelector("meta[name=polypod-token]");
  if (answer.ok && token) meta.content = token;
}

export class Restart {
  constructor(element, store) {
    this.store = store;
    this.token = store.token;
    this.before = null; // the document that the studio before it had
    this.words = make("p", {}, "The studio was started anew. What you had here is not in it.");
    this.back = makeButton("Bring it back", () => this.bringBack(), { class: "main" });
    this.note = make(
      "div", { class: "notice", role: "status", hidden: true }, this.words,
      make("div", { class: "row" }, this.back, makeButton("Leave it", () => this.close())),
    );
    element.append(this.note);
    store.on("link", (there) => { if (there) this.compare(); });
    store.on("document", ({ document: now }) => this.offer(now));
    store.on("role", () => this.refresh());
  }

  // A connection is there again: whether it is to the same studio.
  compare() {
    const { token, document } = this.store;
    if (token !== this.token) this.before ??= document;
    this.token = token;
  }

  offer(now) {
    if (!this.before) return;
    // Nothing was lost, or it is back already.
    if (JSON.stringify(now) === JSON.stringify(this.before)) this.close();
    else this.note.hidden = false;
    this.refresh();
  }

  refresh() {
    this.back.disabled = !this.store.drives;
    this.back.title = this.store.drives ? "" : "Another tab drives; take over there first";
  }

  close() {
    this.before = null;
    this.note.hidden = true;
  }

  async bringBack() {
    const { store, before } = this;
    this.back.disabled = true;
    try {
      const found = await giveAgain(store, before);
      await store.send({ do: "open", document: found });
      this.close();
      const whole = JSON.stringify(found) === JSON.stringify(before);
      store.say(whole ? "What you had here is back." : LOST, whole);
    } catch (refusal) {
      store.say(refusal.message);
      this.refresh();
    }
  }
}
