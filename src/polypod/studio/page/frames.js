// Binary messages, as docs/studio-protocol.md lays them out.

const FOCUS = 16;
const FOOT = 20;

// A frame. Joints of kind h: floats [C, J, 7], quaternion and shift. Views, not copies.
export function decodeFrame(buffer) {
  const view = new DataView(buffer);
  const kinds = view.getUint32(16, true);
  const obstacleCount = view.getUint32(20, true);
  const footCount = view.getUint32(24, true);
  const tapeFrame = view.getUint32(28, true);
  let at = 32;
  const herds = [];
  for (let h = 0; h < kinds; h++) {
    herds.push({ count: view.getUint32(at, true), joints: view.getUint32(at + 4, true) });
    at += 8;
  }
  const floats = (count) => {
    const array = new Float32Array(buffer, at, count);
    at += 4 * count;
    return array;
  };
  for (const herd of herds) {
    herd.body = floats(7 * herd.count);
    herd.pose = floats(7 * herd.count * herd.joints);
  }
  const obstacles = floats(7 * obstacleCount);
  const focus = decodeFocus(floats(FOCUS));
  focus.feet = [];
  for (let k = 0; k < footCount; k++) focus.feet.push(decodeFoot(floats(FOOT)));
  return {
    number: view.getUint32(4, true),
    time: view.getFloat64(8, true),
    tapeFrame: tapeFrame === 0 ? null : tapeFrame - 1,
    received: performance.now(),
    herds,
    obstacles,
    focus,
  };
}

function decodeFocus(n) {
  return {
    needle: n[0], cycleRate: n[1], speed: n[2], duty: n[3], height: n[4], preferredHeight: n[5],
    force: n[6], heading: n[7], turnRate: n[8], sink: n[9], caution: n[10], activity: n[11],
    pace: n[12], creature: n[13], kind: n[14], bodyHeight: n[15],
  };
}

function decodeFoot(n) {
  return {
    sole: n.subarray(0, 3), target: n.subarray(3, 6), preferred: n.subarray(6, 9),
    stance: n[9] > 0.5, waiting: n[10], start: n[11], extent: n[12], particle: n[13],
    progress: n[14], liftPhase: n[15], next: n[16] > 0.5, load: n[17], reach: n[18],
  };
}

const TYPES = { f4: Float32Array, u4: Uint32Array, u2: Uint16Array, u1: Uint8Array };

// Named arrays: {name, ...what else the head says, arrays: {name: {data, shape}}}.
export function decodeArrays(buffer) {
  const length = new DataView(buffer).getUint32(4, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length)));
  let at = 8 + length;
  const arrays = {};
  for (const { name, type, shape } of head.arrays) {
    const count = shape.reduce((product, n) => product * n, 1);
    const data = new TYPES[type](buffer, at, count);
    arrays[name] = { data, shape };
    at += Math.ceil(data.byteLength / 4) * 4;
  }
  return { ...head, arrays };
}
