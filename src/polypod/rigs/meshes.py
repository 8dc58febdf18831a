"""Triangles, skins and weights of the meshes (glTF 2.0, section 3.7)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from polypod.rigs.accessors import AccessorReader
from polypod.rigs.fields import Place

if TYPE_CHECKING:
    from polypod.rigs.colours import Paint

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Positions [V, 3], normals [V, 3] or None, joints [V, W] and weights [V, W] of a primitive.
Vertices: TypeAlias = tuple[FloatArray, FloatArray | None, IntArray, FloatArray]

TRIANGLES = 4


@dataclass(frozen=True, eq=False)
class Skin:
    """The joints that deform a mesh; n joints."""

    joints: IntArray  # [n] node indices
    inverse_bind: FloatArray  # [n, 4, 4] mesh space to joint space in the bind pose
    skeleton: int  # node index of the skeleton's root as the file states it, -1 where it does not


@dataclass(frozen=True, eq=False)
class Geometry:
    """One primitive of triangles in mesh space; V vertices, T triangles, W weights a vertex."""

    positions: FloatArray  # [V, 3]
    normals: FloatArray | None  # [V, 3] as the file has them; None: it has none
    triangles: IntArray  # [T, 3]
    joints: IntArray  # [V, W] places in the joint list of the skin that the node names
    weights: FloatArray  # [V, W] each row sums to one; W is 0 where nothing is skinned
    place: Place  # the primitive in the file


@dataclass(frozen=True, eq=False)
class MeshPart:
    """One primitive of triangles as one node shows it; V vertices, T triangles, W weights.

    Colours are as a screen shows them (sRGB), in [0, 1].
    """

    node: int  # the node that shows it
    skin: int  # index of the skin that deforms it, -1: it rides rigidly on its node
    positions: FloatArray  # [V, 3] mesh space
    normals: FloatArray | None  # [V, 3] mesh space, as the file has them; None: it has none
    triangles: IntArray  # [T, 3]
    joints: IntArray  # [V, W] places in the skin's joint list
    weights: FloatArray  # [V, W] each row sums to one; W is 0 where skin is -1
    colour: FloatArray  # [3] mean colour
    vertex_colour: FloatArray  # [V, 3]
    paint: Paint | None  # the picture that covers it


def read_skins(root: Place, reader: AccessorReader) -> tuple[Skin, ...]:
    """Return all skins.

    Raises:
        RigError: a joint that is no node, or matrices that are too few or not finite.
    """
    nodes = root.parts("nodes")
    skins = []
    for place in root.parts("skins"):
        joints = np.array(place.indices("joints", len(nodes)), np.int64)
        if len(joints) == 0:
            raise place.error("must name at least one node", "joints")
        inverse_bind = np.tile(np.eye(4), (len(joints), 1, 1))
        accessor = place.reference("inverseBindMatrices", len(reader.accessors))
        if accessor >= 0:
            found = reader.read(accessor)
            if found.shape[1:] != (4, 4) or len(found) < len(joints):
                raise place.error(f"must hold {len(joints)} 4x4 matrices", "inverseBindMatrices")
            inverse_bind = found[: len(joints)].astype(np.float64)
            _refuse_not_finite(place, inverse_bind, "inverseBindMatrices")
        skins.append(Skin(joints, inverse_bind, place.reference("skeleton", len(nodes))))
    return tuple(skins)


def read_geometry(root: Place, reader: AccessorReader) -> list[list[Geometry]]:
    """Return the primitives of triangles of each mesh.

    Raises:
        RigError: attributes of wrong shapes, not finite, or indices out of range.
    """
    vertices: dict[str, Vertices] = {}  # primitives of one mesh often share them
    return [
        [
            _read_primitive(place, reader, vertices)
            for place in mesh.parts("primitives")
            if place.integer("mode", TRIANGLES) == TRIANGLES
            and place.part("attributes").has("POSITION")
        ]
        for mesh in root.parts("meshes")
    ]


def place_geometry(
    root: Place, geometry: list[list[Geometry]], skins: tuple[Skin, ...]
) -> list[tuple[int, int, Geometry]]:
    """Return (node, skin, primitive) for everything that is shown.

    Raises:
        RigError: a vertex that names a joint which the node's skin does not have.
    """
    shown = []
    for node, place in enumerate(root.parts("nodes")):
        mesh = place.reference("mesh", len(geometry))
        skin = place.reference("skin", len(skins))
        for part in geometry[mesh] if mesh >= 0 else ():
            skinned = skin if part.joints.shape[1] else -1
            if skinned >= 0 and part.joints.size:
                most = int(part.joints.max())
                if most >= len(skins[skin].joints):
                    raise part.place.error(
                        f"names joint {most}, but skins[{skin}] has {len(skins[skin].joints)}",
                        "attributes.JOINTS_0",
                    )
            shown.append((node, skinned, part))
    return shown


def _read_primitive(
    place: Place, reader: AccessorReader, vertices: dict[str, Vertices]
) -> Geometry:
    attributes = place.part("attributes")
    key = repr(sorted(attributes.value.items(), key=str))
    if key not in vertices:
        positions = reader.read(attributes.integer("POSITION", below=len(reader.accessors)))
        if positions.shape[1:] != (3,):
            raise attributes.error("must have type VEC3", "POSITION")
        positions = positions.astype(np.float64)
        _refuse_not_finite(attributes, positions, "POSITION")
        normals = _read_normals(attributes, reader, len(positions))
        vertices[key] = (positions, normals, *_read_weights(attributes, reader, len(positions)))
    positions, normals, joints, weights = vertices[key]
    triangles = _read_triangles(place, reader, positions)
    return Geometry(positions, normals, triangles, joints, weights, place)


def _read_normals(
    attributes: Place, reader: AccessorReader, vertex_count: int
) -> FloatArray | None:
    """Return [V, 3], None where there are none that could be used: they are for looks alone."""
    accessor = attributes.reference("NORMAL", len(reader.accessors))
    if accessor < 0:
        return None
    normals = reader.read(accessor)
    usable = normals.shape == (vertex_count, 3) and normals.dtype == np.float64
    return normals if usable and np.isfinite(normals).all() else None


def _read_triangles(place: Place, reader: AccessorReader, positions: FloatArray) -> IntArray:
    accessor = place.reference("indices", len(reader.accessors))
    if accessor < 0:
        usable = len(positions) // 3 * 3
        return np.arange(usable, dtype=np.int64).reshape(-1, 3)
    indices = reader.read(accessor)
    if indices.ndim != 1 or indices.dtype != np.int64:
        raise place.error("must be whole numbers of type SCALAR", "indices")
    usable = len(indices) // 3 * 3
    if usable and not 0 <= int(indices.min()) <= int(indices.max()) < len(positions):
        raise place.error(f"must be below the {len(positions)} vertices", "indices")
    return indices[:usable].reshape(-1, 3)


def _read_weights(
    attributes: Place, reader: AccessorReader, vertex_count: int
) -> tuple[IntArray, FloatArray]:
    """Return joints [V, W] and weights [V, W] of all the sets, weights summing to one."""
    joint_sets: list[NDArray[Any]] = [np.zeros((vertex_count, 0), np.int64)]
    weight_sets: list[NDArray[Any]] = [np.zeros((vertex_count, 0))]
    number = 0
    while attributes.has(f"JOINTS_{number}") and attributes.has(f"WEIGHTS_{number}"):
        for name, kept in (("JOINTS", joint_sets), ("WEIGHTS", weight_sets)):
            key = f"{name}_{number}"
            values = reader.read(attributes.integer(key, below=len(reader.accessors)))
            if values.shape != (vertex_count, 4):
                raise attributes.error(f"must be {vertex_count} of type VEC4", key)
            _refuse_not_finite(attributes, values, key)
            kept.append(values)
        number += 1
    weights = np.maximum(np.concatenate(weight_sets, axis=1), 0.0)
    # An unused slot may hold anything: it must not count as a joint that is out of range.
    joints = np.where(weights > 0.0, np.concatenate(joint_sets, axis=1), 0).astype(np.int64)
    if weights.shape[1]:
        total = weights.sum(axis=1, keepdims=True)
        weights[total[:, 0] <= 0.0, 0] = 1.0  # as engines do: weightless follows its first joint
        weights /= np.where(total > 0.0, total, 1.0)
    if joints.size and int(joints.min()) < 0:
        raise attributes.error("must not be negative", "JOINTS_0")
    return joints, weights


def _refuse_not_finite(place: Place, values: NDArray[Any], key: str) -> None:
    if not np.isfinite(values).all():
        raise place.error("holds numbers that are not finite (NaN or infinity)", key)
