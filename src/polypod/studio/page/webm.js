// A WebM that a browser recorded says neither how long it is nor where its pictures are that need no
// other (it is written as it goes), so players cannot go to and fro in it. This writes both into
// it: the Duration into its Info, and Cues before its first Cluster. Everything else stays as it is.
//
// WebM is EBML: elements of an id, a size and content (RFC 8794, RFC 9559). Ids are written here with
// their marker bits, as the standard lists them.

const HEADER = 0x1a45dfa3, SEGMENT = 0x18538067, INFO = 0x1549a966, DURATION = 0x4489;
const SCALE = 0x2ad7b1, SEEK_HEAD = 0x114d9b74, CUES = 0x1c53bb6b, CLUSTER = 0x1f43b675;
const TIMESTAMP = 0xe7, SIMPLE_BLOCK = 0xa3, BLOCK_GROUP = 0xa0, BLOCK = 0xa1, REFERENCE = 0xfb;
const CUE_POINT = 0xbb, CUE_TIME = 0xb3, CUE_POSITIONS = 0xb7, CUE_TRACK = 0xf7, CUE_CLUSTER = 0xf1;
const BESIDE_CLUSTERS = [CLUSTER, CUES, 0x1254c367]; // and tags
const MILLISECOND = 1e6; // ns, the usual scale of timestamps
const USUAL_PICTURE = 1 / 30; // s, for which the last picture is shown where there is only one
const KEY_FRAME = 0x80; // a flag of a simple block

// The same video with its duration and cues: a Blob. What is no such WebM, or has a duration
// already, is given back as it is.
export async function seekable(blob) {
  const bytes = new Uint8Array(await blob.arrayBuffer());
  const places = survey(bytes);
  if (!places) return blob;
  const info = makeInfo(bytes, places);
  const { begin, info: old, clusters } = places;
  // All that is written anew stands before the first cluster, so all clusters go on by as much.
  const makeShifted = (shift) => makeCues(places.keys, (at) => at - begin + shift);
  const shift = info.length - (old.end - old.at) + makeShifted(0).length;
  const pieces = [
    bytes.subarray(0, old.at), info, bytes.subarray(old.end, clusters), makeShifted(shift),
    bytes.subarray(clusters),
  ];
  return new Blob(pieces, { type: blob.type });
}

// Where everything is: `begin` of the segment's content, `info`, the first of the `clusters`, and
// `keys` {time, track, at: its cluster}, pictures that need no other; times in ticks of `scale`.
function survey(bytes) {
  const top = [...elements(bytes, 0, bytes.length)];
  const segment = top.find(({ id }) => id === SEGMENT);
  if (top[0]?.id !== HEADER || !segment) return null;
  const children = [...elements(bytes, segment.content, segment.end)];
  const info = children.find(({ id }) => id === INFO);
  const clusters = children.filter(({ id }) => id === CLUSTER);
  // What points to places in the file would point to others afterwards.
  const pointed = children.some(({ id }) => id === SEEK_HEAD || id === CUES);
  if (!info || clusters.length === 0 || pointed) return null;
  const facts = [...elements(bytes, info.content, info.end)];
  const told = facts.find(({ id }) => id === DURATION);
  if (told) return null;
  const scale = facts.find(({ id }) => id === SCALE);
  const blocks = clusters.flatMap((cluster) => [...blocksOf(bytes, cluster)]);
  if (blocks.length === 0) return null;
  return {
    begin: segment.content, info, clusters: clusters[0].at,
    scale: scale ? unsigned(bytes, scale.content, scale.end) : MILLISECOND,
    times: blocks.map(({ time }) => time).sort((a, b) => a - b),
    keys: blocks.filter(({ key }) => key),
  };
}

// Elements one after the other: {id, at, content, end}. What has no size ends with its parent, or
// where something begins that stands beside it: only segments and clusters are written so.
function* elements(bytes, from, end) {
  for (let at = from; at < end;) {
    const head = headAt(bytes, at);
    if (!head) return; // cut off
    const { id, content, size } = head;
    const after = size === null ? endOfUnsized(bytes, id, content, end) : content + size;
    yield { id, at, content, end: Math.min(after, end) };
    at = after;
  }
}

function headAt(bytes, at) {
  const id = vint(bytes, at, true);
  const size = id && vint(bytes, at + id.length, false);
  return size && { id: id.value, content: at + id.length + size.length, size: size.value };
}

function endOfUnsized(bytes, id, content, end) {
  if (id !== CLUSTER) return end;
  for (let at = content; at < end;) {
    const head = headAt(bytes, at);
    if (!head) return end;
    if (BESIDE_CLUSTERS.includes(head.id)) return at;
    at = head.content + head.size;
  }
  return end;
}

// A number of variable length: {value, length}, null where the bytes end; null as the value where
// it says that a size is not known.
function vint(bytes, at, marked) {
  const first = bytes[at];
  const length = Math.clz32(first) - 23;
  if (first === undefined || length > 8 || at + length > bytes.length) return null;
  let value = marked ? first : first & (0xff >> length);
  let ones = (first & (0xff >> length)) === 0xff >> length;
  for (let i = 1; i < length; i++) {
    value = value * 256 + bytes[at + i];
    ones &&= bytes[at + i] === 0xff;
  }
  return { value: ones && !marked ? null : value, length };
}

function unsigned(bytes, from, end) {
  return bytes.subarray(from, end).reduce((number, byte) => number * 256 + byte, 0);
}

// {time, track, key, at} of each block of a cluster.
function* blocksOf(bytes, cluster) {
  let start = 0;
  for (const element of elements(bytes, cluster.content, cluster.end)) {
    if (element.id === TIMESTAMP) start = unsigned(bytes, element.content, element.end);
    const simple = element.id === SIMPLE_BLOCK;
    if (!simple && element.id !== BLOCK_GROUP) continue;
    const parts = simple ? [] : [...elements(bytes, element.content, element.end)];
    const block = simple ? element : parts.find(({ id }) => id === BLOCK);
    const track = block && vint(bytes, block.content, false);
    if (!track) continue;
    const after = block.content + track.length; // two bytes of time, then the flags
    const offset = (bytes[after] * 256 + bytes[after + 1]) << 16 >> 16;
    const key = simple ? (bytes[after + 2] & KEY_FRAME) !== 0 : !parts.some(({ id }) => id === REFERENCE);
    yield { time: start + offset, track: track.value, key, at: cluster.at };
  }
}

// The last picture is shown for as long as one before it, on average.
function makeInfo(bytes, { info, scale, times }) {
  const last = times.at(-1);
  const shown = times.length > 1 ? (last - times[0]) / (times.length - 1) : (USUAL_PICTURE * 1e9) / scale;
  const duration = new Uint8Array(8);
  new DataView(duration.buffer).setFloat64(0, last + shown);
  return element(INFO, [...bytes.subarray(info.content, info.end), ...element(DURATION, duration)]);
}

// As long wherever clusters are: places are written in eight bytes. One of a track and cluster.
function makeCues(keys, place) {
  const first = keys.filter((key, i) => i === 0 || key.at !== keys[i - 1].at);
  return element(CUES, first.flatMap(({ time, track, at }) => [...element(CUE_POINT, [
    ...element(CUE_TIME, eightBytes(time)),
    ...element(CUE_POSITIONS, [
      ...element(CUE_TRACK, [track]), ...element(CUE_CLUSTER, eightBytes(place(at))),
    ]),
  ])]));
}

function eightBytes(number) {
  const bytes = new Uint8Array(8);
  new DataView(bytes.buffer).setBigUint64(0, BigInt(number));
  return bytes;
}

// An element with its size in eight bytes, 2^53 at most.
function element(id, content) {
  const head = [];
  for (let rest = id; rest > 0; rest = Math.floor(rest / 256)) head.unshift(rest % 256);
  const size = eightBytes(content.length);
  size[0] = 0x01;
  return Uint8Array.from([...head, ...size, ...content]);
}
