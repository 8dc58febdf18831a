// The whole of what is asked for as a link: #, and the document as base64url of its JSON. A page
// opened with such a link asks the studio for what it says.

export function linkFor(wanted) {
  return `${location.origin}${location.pathname}#${encode(wanted)}`;
}

export function encode(wanted) {
  const bytes = new TextEncoder().encode(JSON.stringify(wanted));
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

// The document that a hash holds; throws where it holds none.
export function decode(hash) {
  const text = atob(hash.replace(/^#/, "").replaceAll("-", "+").replaceAll("_", "/"));
  const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  return JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
}

// Open what the address says, once this tab drives; and say so when the address no longer holds.
export class LinkOpener {
  constructor(store) {
    this.store = store;
    // What becomes of what the address holds: "waiting" for this tab to drive, "opening", "refused"
    // (it may be of a rig that is not here yet) or "", where there is nothing left to do.
    this.state = location.hash.length > 1 ? "waiting" : "";
    window.addEventListener("hashchange", () => {
      this.state = location.hash.length > 1 ? "waiting" : "";
      this.open();
    });
    for (const kind of ["welcome", "role", "document"]) store.on(kind, () => this.open());
    store.on("document", () => this.drop());
    store.on("rig", () => {
      if (this.state === "refused") this.state = "waiting";
      this.open();
    });
  }

  // Show a link in the address; it is true already, so nothing is to be opened.
  show(wanted) {
    history.replaceState(null, "", linkFor(wanted));
  }

  async open() {
    const { store } = this;
    if (this.state !== "waiting" || !store.document || !store.welcome) return;
    if (!store.drives) {
      store.say("Another tab drives; take over to open what this link holds.");
      return;
    }
    this.state = "opening";
    try {
      const wanted = decode(location.hash);
      if (JSON.stringify(wanted) !== JSON.stringify(store.document)) {
        await store.send({ do: "open", document: wanted });
        store.say("What the link holds is open; undo goes back.", true);
      }
      this.state = "";
    } catch (error) {
      const broken = error instanceof SyntaxError || error instanceof TypeError || error.name === "InvalidCharacterError";
      this.state = broken ? "" : "refused";
      store.say(broken ? "The link is no link of the studio, or was cut off." : `The link cannot be opened: ${error.message}.`);
      if (broken) history.replaceState(null, "", location.pathname);
    }
  }

  // After a change the address no longer says what there is, and a reload must not go back to it.
  drop() {
    if (["waiting", "opening"].includes(this.state) || location.hash.length < 2) return;
    if (location.hash.slice(1) !== encode(this.store.document)) {
      this.state = "";
      history.replaceState(null, "", location.pathname);
    }
  }
}
