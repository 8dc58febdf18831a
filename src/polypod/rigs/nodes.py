"""The node tree: parents, local and world matrices (glTF 2.0, section 3.5)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from polypod.rigs.fields import Place

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def read_parents(places: list[Place]) -> IntArray:
    """Return [N] the parent of each node, -1 for roots.

    Raises:
        RigError: a node with two parents, or one that is its own ancestor.
    """
    parents = np.full(len(places), -1, np.int64)
    for index, place in enumerate(places):
        for child in place.indices("children", len(places)):
            if parents[child] >= 0:
                raise place.error(
                    f"holds node {child}, which is already a child of node {parents[child]}",
                    "children",
                )
            parents[child] = index
    in_a_tree = np.zeros(len(places), np.bool_)
    in_a_tree[parent_first_order(parents)] = True
    if not in_a_tree.all():
        stray = int(np.flatnonzero(~in_a_tree)[0])
        raise places[stray].error("is its own ancestor: the node tree has a cycle")
    return parents


def parent_first_order(parents: IntArray) -> list[int]:
    """Return the nodes reachable from roots, every parent before its children."""
    children: list[list[int]] = [[] for _ in parents]
    for index, parent in enumerate(parents):
        if parent >= 0:
            children[parent].append(index)
    order = [index for index, parent in enumerate(parents) if parent < 0]
    for index in order:
        order.extend(children[index])
    return order


def local_matrix(place: Place) -> FloatArray:
    """Return [4, 4] a node's own matrix, from `matrix` or from its three parts.

    Raises:
        RigError: something that is no finite number, or a rotation of length zero.
    """
    if place.has("matrix"):
        columns = place.numbers("matrix", tuple(np.eye(4).ravel()))
        return np.array(columns, np.float64).reshape(4, 4).T.copy()
    rotation = np.array(place.numbers("rotation", (0.0, 0.0, 0.0, 1.0)))
    size = float(np.abs(rotation).max())
    if size < 1e-30:
        raise place.error("has length zero", "rotation")
    translation = np.array(place.numbers("translation", (0.0, 0.0, 0.0)))
    scale = np.array(place.numbers("scale", (1.0, 1.0, 1.0)))
    rotation = rotation / size
    return compose(translation, rotation / np.linalg.norm(rotation), scale)


def rotation_matrices(rotation: FloatArray) -> FloatArray:
    """Return [..., 3, 3] the matrices of unit quaternions [..., 4]."""
    x, y, z, w = (rotation[..., i] for i in range(4))
    rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def compose(translation: FloatArray, rotation: FloatArray, scale: FloatArray) -> FloatArray:
    """Return [..., 4, 4] matrices that scale, then turn, then shift."""
    shape = np.broadcast_shapes(translation.shape[:-1], rotation.shape[:-1], scale.shape[:-1])
    matrices = np.zeros((*shape, 4, 4))
    matrices[..., :3, :3] = rotation_matrices(rotation) * scale[..., None, :]
    matrices[..., :3, 3] = translation
    matrices[..., 3, 3] = 1.0
    return matrices


def world_matrices(local: FloatArray, parents: IntArray) -> FloatArray:
    """Return [N, 4, 4] each node's matrix in world space from [N, 4, 4] local ones."""
    world = local.copy()
    with np.errstate(over="ignore", invalid="ignore"):
        for index in parent_first_order(parents):
            if parents[index] >= 0:
                world[index] = world[parents[index]] @ local[index]
    return world
