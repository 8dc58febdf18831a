// A rig as it is being looked at: what is asked of it, and what the server found in it. It is no
// creature of the scene before it is told to walk.

const NAMED = "polypod.rigs"; // names of uploads, kept for as long as the tab is

export class RigDraft {
  // `asked` holds what is not left to be found: {leg, spine, forward, height}, null where it is;
  // legs as {hip, foot} and spines as nodes, or as texts where the document has them.
  constructor(rig, asked = {}) {
    this.rig = rig;
    this.asked = { leg: null, spine: null, forward: null, height: null, ...asked };
    this.answer = null;
    this.joints = [];
    this.byNode = new Map();
    this.fileHeight = null; // m, of the file if its units are metres; known where none was asked
  }

  // Take the server's answer to what was asked.
  take(answer) {
    this.answer = answer;
    this.joints = answer.joints;
    this.byNode = new Map(answer.joints.map((joint) => [joint.node, joint]));
    this.count = new Map();
    for (const { name } of answer.joints) this.count.set(name, (this.count.get(name) ?? 0) + 1);
    if (this.asked.height === null) this.fileHeight = answer.height;
    if (!answer.walks) return;
    // From here on nodes are known, so texts give way to them.
    if (this.asked.leg) this.asked.leg = answer.legs.map(({ hip, foot }) => ({ hip, foot }));
    if (this.asked.spine) this.asked.spine = answer.spine;
  }

  get walks() {
    return this.answer?.walks ?? false;
  }

  // Its legs: asked for, else found; [] as long as the server could read neither.
  get legs() {
    const asked = this.asked.leg;
    if (asked && asked.every((leg) => typeof leg === "object")) return asked;
    return this.answer?.legs ?? [];
  }

  // Its legs, each with its row and side; those that the server has not seen yet are the last.
  placedLegs() {
    const found = this.answer?.legs ?? [];
    return this.legs.map(({ hip, foot }) => (
      found.find((leg) => leg.hip === hip && leg.foot === foot) ?? { row: -1, side: 0 }
    ));
  }

  get spine() {
    const asked = this.asked.spine;
    if (asked && asked.every((node) => typeof node === "number")) return asked;
    return this.answer?.spine ?? [];
  }

  get forward() {
    return this.asked.forward ?? this.answer?.forward ?? "+z";
  }

  label(node) {
    return this.byNode.get(node)?.name || `#${node}`;
  }

  // How an order names a node: by its name where that is plain and the only one, else by number.
  text(node) {
    const name = this.byNode.get(node)?.name ?? "";
    const plain = name !== "" && name === name.trim() && !/[:#]/.test(name);
    return plain && this.count.get(name) === 1 ? name : `#${node}`;
  }

  // What the server is asked, as `creature` of the document and POST /judge have it.
  question() {
    const { leg, spine, forward, height } = this.asked;
    const legText = (one) => (typeof one === "string" ? one : `${this.text(one.hip)}:${this.text(one.foot)}`);
    const nodeText = (one) => (typeof one === "string" ? one : this.text(one));
    return {
      rig: this.rig, leg: leg && leg.map(legText), spine: spine && spine.map(nodeText), forward, height,
    };
  }

  // Nodes from a foot up to its hip; [] where the hip is not above the foot.
  chain({ hip, foot }) {
    const nodes = [];
    for (let node = foot; node !== undefined && node >= 0; node = this.byNode.get(node)?.parent) {
      nodes.push(node);
      if (node === hip) return nodes;
    }
    return [];
  }

  isBelow(node, hip) {
    return node !== hip && this.chain({ hip, foot: node }).length > 0;
  }

  // Nodes from back to head, along the direction that it faces.
  backToHead(nodes) {
    const { ahead } = axes(this.forward);
    return [...nodes].sort((a, b) => ahead(this.byNode.get(a).place) - ahead(this.byNode.get(b).place));
  }
}

// What is ahead, up and left in a file whose creature faces `forward`; y is up.
export function axes(forward) {
  const sign = forward[0] === "-" ? -1 : 1;
  const along = forward[1] === "x" ? 0 : 2;
  // Left is up x ahead: of +z that is +x, of +x it is -z.
  const left = along === 2 ? (place) => sign * place[0] : (place) => -sign * place[2];
  return { ahead: (place) => sign * place[along], up: (place) => place[1], left };
}

// Names of uploads are for show alone: the server knows them by what is in them.
export function rememberName(rig, name) {
  sessionStorage.setItem(NAMED, JSON.stringify({ ...namesOfRigs(), [rig]: name }));
}

export function forgetName(rig) {
  const names = namesOfRigs();
  delete names[rig];
  sessionStorage.setItem(NAMED, JSON.stringify(names));
}

// The uploads that were looked at in this tab: they can be chosen again.
export function rigsRemembered() {
  return Object.keys(namesOfRigs()).filter((rig) => rig.startsWith("upload:"));
}

export function nameOfRig(rig) {
  if (!rig.startsWith("upload:")) return rig;
  return namesOfRigs()[rig] ?? `upload ${rig.slice(7, 13)}`;
}

function namesOfRigs() {
  return JSON.parse(sessionStorage.getItem(NAMED) ?? "{}");
}
