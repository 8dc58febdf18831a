"""What reading a stranger's rig would take, estimated before it is read.

A file of a few kilobytes may claim millions of vertices (accessors without bytes, many nodes that
show one mesh), pictures of gigapixels, or trees so large that looking through them takes minutes.
What is refused here could be read, but no creature is like it.
"""

from __future__ import annotations

import io
import struct
import warnings

from PIL import Image

from polypod.errors import RigError
from polypod.rigs.accessors import AccessorReader
from polypod.rigs.colours import FORMATS
from polypod.rigs.container import JSON_CHUNK, MAGIC, load_buffers, resolve_uri, split
from polypod.rigs.fields import Place

LARGEST_FILE = 64 << 20  # bytes
MOST_VALUES = 500_000  # of its JSON, about 100 bytes each once read
MOST_NODES = 800
MOST_ENDS = 150  # nodes without children: each may be a foot, and is compared with all others
MOST_JOINTS = 20_000  # of all skins together; each may list them all
MOST_VERTICES = 400_000  # as often as they are shown
MOST_WORK = 40_000_000  # nodes times vertices, which finding legs goes by: some 5 s
MOST_BYTES = 256 << 20  # of arrays
MOST_PIXELS = 1 << 26  # of all pictures together
# A vertex as shown: place, colour, and eight joints with their weights, each twice.
VERTEX_BYTES = 352
# An array is there as it was in the file, as it is read, and once more while it is judged.
COPIES = 3


def judge_upload(data: bytes, name: str, what: str = "rig") -> None:
    """Refuse a file that would take too much to read.

    Args:
        data: the file, GLB or .gltf.
        name: of the file, for messages.
        what: it is meant to be, for messages.

    Raises:
        RigError: it is no glTF, needs other files, or is too large in some way.
    """
    if len(data) > LARGEST_FILE:
        raise RigError(f"{name}: a {what} may have {LARGEST_FILE >> 20} MiB, this one has more")
    text = _json_of(data)
    _judge_count(
        name, "values in its JSON", sum(text.count(c) for c in (b",", b"[", b"{")), MOST_VALUES
    )
    parts = split(data, name)
    root = Place(name, "", parts.json)
    for buffer in root.parts("buffers"):
        if buffer.has("uri") and not buffer.text("uri").startswith("data:"):
            raise buffer.error(
                "is a file of its own; save the rig as a GLB, which holds everything"
            )
    reader = AccessorReader(root, load_buffers(root, parts.binary, None))
    nodes = root.parts("nodes")
    ends = sum(not node.indices("children", len(nodes)) for node in nodes)
    joints = sum(len(skin.indices("joints", len(nodes))) for skin in root.parts("skins"))
    _judge_count(name, "nodes", len(nodes), MOST_NODES)
    _judge_count(name, "ends of branches", ends, MOST_ENDS)
    _judge_count(name, "joints", joints, MOST_JOINTS)
    _judge_arrays(name, root, reader)
    _judge_pictures(name, root, reader)


def _json_of(data: bytes) -> bytes:
    """Return the bytes that are parsed as JSON, whatever they are."""
    if data[:4] != MAGIC or len(data) < 20:
        return data
    size, kind = struct.unpack_from("<II", data, 12)
    return data[20 : 20 + size] if kind == JSON_CHUNK else b""


def _judge_count(name: str, what: str, count: int, most: int) -> None:
    if count > most:
        raise RigError(f"{name}: has {count} {what}; the studio takes rigs with at most {most}")


def _judge_arrays(name: str, root: Place, reader: AccessorReader) -> None:
    """Estimate what skins and meshes take."""
    needed = 0
    for skin in root.parts("skins"):
        needed += _size(reader, skin.reference("inverseBindMatrices", len(reader.accessors)))
    vertices = []
    for mesh in root.parts("meshes"):
        count = 0
        for primitive in mesh.parts("primitives"):
            attributes = primitive.part("attributes")
            for key in attributes.value:
                needed += _size(reader, attributes.reference(key, len(reader.accessors)))
            needed += _size(reader, primitive.reference("indices", len(reader.accessors)))
            place = attributes.reference("POSITION", len(reader.accessors))
            count += reader.count(reader.accessors[place]) if place >= 0 else 0
        vertices.append(count)
    shown = [node.reference("mesh", len(vertices)) for node in root.parts("nodes")]
    total = sum(vertices[mesh] for mesh in shown if mesh >= 0)
    _judge_count(name, "vertices", max(total, sum(vertices)), MOST_VERTICES)
    if len(shown) * total > MOST_WORK:
        raise RigError(
            f"{name}: has {total} vertices and {len(shown)} nodes, which are too many together; "
            "save it with a simpler mesh"
        )
    needed += VERTEX_BYTES * total
    if needed > MOST_BYTES:
        raise RigError(
            f"{name}: would take {needed >> 20} MiB to read; the studio takes rigs with at most "
            f"{MOST_BYTES >> 20} MiB"
        )


def _size(reader: AccessorReader, accessor: int) -> int:
    """Return the bytes that an accessor takes once it is read; none for number -1."""
    if accessor < 0:
        return 0
    place = reader.accessors[accessor]
    layout = reader.layout(place)
    return COPIES * 8 * reader.count(place) * layout.columns * layout.rows


def _judge_pictures(name: str, root: Place, reader: AccessorReader) -> None:
    """Read how large pictures say they are; those that cannot be read are left out later."""
    pixels = 0
    for place in root.parts("images"):
        view = place.reference("bufferView", len(reader.views))
        if view < 0 and not place.text("uri").startswith("data:"):
            continue  # a file of its own, which is not there: the rig comes without this colour
        data = resolve_uri(place, None) if view < 0 else reader.view_bytes(view)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                picture = Image.open(io.BytesIO(data), formats=FORMATS)
        except Image.DecompressionBombError:
            raise place.error(
                "is a picture of gigapixels, which the studio does not take"
            ) from None
        except Exception:  # broken pictures raise anything in Pillow; colours leave them out
            continue
        pixels += picture.width * picture.height
    if pixels > MOST_PIXELS:
        raise RigError(
            f"{name}: its pictures have {pixels / 1e6:.0f} megapixels; the studio takes rigs with "
            f"at most {MOST_PIXELS / 1e6:.0f}"
        )
