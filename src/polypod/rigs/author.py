"""Writes a new GLB from a joint tree and skinned surfaces.

Every joint rests unrotated and unscaled, so that the node pose is the bind pose and an inverse bind
matrix is a shift. glTF 2.0, sections 3.6 (buffers and accessors) and 3.7.3 (skins).
"""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

GENERATOR = "Polypod"
FLOAT, UNSIGNED_BYTE, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5121, 5123, 5125
VERTEX_TARGET, INDEX_TARGET = 34962, 34963


class Joint(NamedTuple):
    """One node of the skeleton."""

    name: str
    parent: int  # row in the joint list, -1: a root of the scene; parents come first
    position: tuple[float, float, float]  # world at rest, m
    skinned: bool = True  # False: a plain node that marks a place, in no skin


class Material(NamedTuple):
    """How a surface reflects; its colour comes from the vertices."""

    name: str
    roughness: float
    metallic: float = 0.0


@dataclass(frozen=True)
class SkinnedSurface:
    """Triangles of one material. V vertices, T triangles, four influences a vertex."""

    positions: FloatArray  # [V, 3] world at rest, m
    normals: FloatArray  # [V, 3] unit
    colours: FloatArray  # [V, 4] linear red, green, blue and alpha in [0, 1]
    joints: IntArray  # [V, 4] rows in the joint list; 0 where the weight is 0
    weights: FloatArray  # [V, 4] sum 1
    triangles: IntArray  # [T, 3] counter-clockwise from outside
    material: int  # row in the material list


@dataclass
class _Buffer:
    """The binary chunk as it grows, with the views and accessors into it."""

    data: bytearray = field(default_factory=bytearray)
    views: list[dict[str, Any]] = field(default_factory=list)
    accessors: list[dict[str, Any]] = field(default_factory=list)

    def add(
        self,
        array: NDArray[Any],
        component: int,
        shape: str,
        target: int | None = None,
        normalized: bool = False,
        bounds: bool = False,
    ) -> int:
        """Append an array and return its accessor's index."""
        self.data.extend(b"\0" * (-len(self.data) % 4))
        raw = np.ascontiguousarray(array).tobytes()
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(raw)}
        if target is not None:
            view["target"] = target
        self.data.extend(raw)
        accessor: dict[str, Any] = {
            "bufferView": len(self.views),
            "componentType": component,
            "count": len(array),
            "type": shape,
        }
        if normalized:
            accessor["normalized"] = True
        if bounds:
            accessor["min"] = [float(low) for low in array.min(axis=0)]
            accessor["max"] = [float(high) for high in array.max(axis=0)]
        self.views.append(view)
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def author_glb(
    name: str,
    joints: Sequence[Joint],
    surfaces: Sequence[SkinnedSurface],
    materials: Sequence[Material],
) -> bytes:
    """Return a GLB with one skin and one mesh, a primitive for each surface.

    Args:
        name: the scene's name; the mesh's node is called `<name>Mesh`.
        joints: the skeleton, parents first, names unique.
        surfaces: triangles with their weights.
        materials: what the surfaces refer to.

    Returns:
        The file's bytes; the same input gives the same bytes.

    Raises:
        ValueError: a parent comes after its child, a name is repeated, a surface's weight is on a
            plain node, or weights do not sum to 1.
    """
    _check(joints, surfaces)
    buffer = _Buffer()
    rows = [row for row, joint in enumerate(joints) if joint.skinned]
    slot = np.zeros(len(joints), dtype=np.int64)  # joint row -> index in the skin's joint list
    slot[rows] = np.arange(len(rows))
    primitives = [_primitive(buffer, surface, slot) for surface in surfaces]
    inverse_bind = np.tile(np.eye(4, dtype=np.float32), (len(rows), 1, 1))
    # Matrices are stored column by column, so the shift lies in the last row of each array here.
    inverse_bind[:, 3, :3] = [[-x for x in joints[row].position] for row in rows]
    inverse_bind_accessor = buffer.add(inverse_bind, FLOAT, "MAT4")
    nodes = _nodes(joints)
    roots = [row for row, joint in enumerate(joints) if joint.parent < 0]
    skin: dict[str, Any] = {
        "name": f"{name}Skin",
        "inverseBindMatrices": inverse_bind_accessor,
        "joints": rows,
    }
    if len(roots) == 1:
        skin["skeleton"] = roots[0]
    nodes.append({"name": f"{name}Mesh", "mesh": 0, "skin": 0})
    document = {
        "asset": {"version": "2.0", "generator": GENERATOR},
        "scene": 0,
        "scenes": [{"name": name, "nodes": [*roots, len(joints)]}],
        "nodes": nodes,
        "meshes": [{"name": name, "primitives": primitives}],
        "skins": [skin],
        "materials": [_material(material) for material in materials],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data)}],
    }
    return _container(document, bytes(buffer.data))


def _check(joints: Sequence[Joint], surfaces: Sequence[SkinnedSurface]) -> None:
    """Raise ValueError where the input cannot be a valid file."""
    names = [joint.name for joint in joints]
    repeated = {name for name in names if names.count(name) > 1}
    if repeated:
        raise ValueError(f"joint names are repeated: {', '.join(sorted(repeated))}")
    for row, joint in enumerate(joints):
        if joint.parent >= row:
            raise ValueError(f"joint {joint.name} comes before its parent")
    plain = np.array([not joint.skinned for joint in joints])
    for surface in surfaces:
        if np.any(plain[surface.joints] & (surface.weights > 0)):
            raise ValueError("a surface has weight on a plain node")
        if np.any(np.abs(surface.weights.sum(axis=1) - 1.0) > 1e-6):
            raise ValueError("a surface's weights do not sum to 1")


def _primitive(buffer: _Buffer, surface: SkinnedSurface, slot: IntArray) -> dict[str, Any]:
    """Append one surface and return its glTF primitive."""
    weights = surface.weights.astype(np.float32)
    # The largest weight takes the rounding, so that the sum is 1 in single precision too.
    largest = np.arange(len(weights)), weights.argmax(axis=1)
    weights[largest] += np.float32(1.0) - weights.sum(axis=1, dtype=np.float32)
    slots = np.where(weights > 0, slot[surface.joints], 0)
    byte_joints = slots.max(initial=0) < 256
    short_indices = len(surface.positions) < 65536
    attributes = {
        "POSITION": buffer.add(
            surface.positions.astype(np.float32), FLOAT, "VEC3", VERTEX_TARGET, bounds=True
        ),
        "NORMAL": buffer.add(surface.normals.astype(np.float32), FLOAT, "VEC3", VERTEX_TARGET),
        "COLOR_0": buffer.add(
            np.round(np.clip(surface.colours, 0.0, 1.0) * 65535.0).astype(np.uint16),
            UNSIGNED_SHORT,
            "VEC4",
            VERTEX_TARGET,
            normalized=True,
        ),
        "JOINTS_0": buffer.add(
            slots.astype(np.uint8 if byte_joints else np.uint16),
            UNSIGNED_BYTE if byte_joints else UNSIGNED_SHORT,
            "VEC4",
            VERTEX_TARGET,
        ),
        "WEIGHTS_0": buffer.add(weights, FLOAT, "VEC4", VERTEX_TARGET),
    }
    indices = buffer.add(
        surface.triangles.reshape(-1).astype(np.uint16 if short_indices else np.uint32),
        UNSIGNED_SHORT if short_indices else UNSIGNED_INT,
        "SCALAR",
        INDEX_TARGET,
    )
    return {
        "attributes": attributes,
        "indices": indices,
        "material": surface.material,
        "mode": 4,
    }


def _nodes(joints: Sequence[Joint]) -> list[dict[str, Any]]:
    """Return the glTF nodes of the joint tree, in the joints' order."""
    nodes: list[dict[str, Any]] = []
    for row, joint in enumerate(joints):
        origin = joints[joint.parent].position if joint.parent >= 0 else (0.0, 0.0, 0.0)
        shift = [float(here - there) for here, there in zip(joint.position, origin, strict=True)]
        node: dict[str, Any] = {"name": joint.name, "translation": shift}
        children = [child for child, other in enumerate(joints) if other.parent == row]
        if children:
            node["children"] = children
        nodes.append(node)
    return nodes


def _material(material: Material) -> dict[str, Any]:
    """Return the glTF material."""
    return {
        "name": material.name,
        "pbrMetallicRoughness": {
            "metallicFactor": material.metallic,
            "roughnessFactor": material.roughness,
        },
    }


def _container(document: dict[str, Any], binary: bytes) -> bytes:
    """Return the GLB container of a document and its binary chunk."""
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    header = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary))
    return b"".join(
        (
            header,
            struct.pack("<I4s", len(text), b"JSON"),
            text,
            struct.pack("<I4s", len(binary), b"BIN\0"),
            binary,
        )
    )
