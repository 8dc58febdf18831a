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


def local_parts(place: Place) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return a node's translation [3], unit rotation [4] and scale [3].

    Of a `matrix`, shear is left out.

    Raises:
        RigError: something that is no finite number, or a rotation of length zero.
    """
    if place.has("matrix"):
        columns = place.numbers("matrix", tuple(np.eye(4).ravel()))
        parts = decompose(np.array(columns).reshape(1, 4, 4).transpose(0, 2, 1), np.ones(3))
        return parts[0][0], parts[1][0], parts[2][0]
    rotation = np.array(place.numbers("rotation", (0.0, 0.0, 0.0, 1.0)))
    size = float(np.abs(rotation).max())
    if size < 1e-30:
        raise place.error("has length zero", "rotation")
    rotation = rotation / size
    translation = np.array(place.numbers("translation", (0.0, 0.0, 0.0)))
    scale = np.array(place.numbers("scale", (1.0, 1.0, 1.0)))
    return translation, rotation / np.linalg.norm(rotation), scale


def local_matrix(place: Place) -> FloatArray:
    """Return [4, 4] a node's own matrix, from `matrix` or from its three parts.

    Raises:
        RigError: something that is no finite number, or a rotation of length zero.
    """
    if place.has("matrix"):
        columns = place.numbers("matrix", tuple(np.eye(4).ravel()))
        return np.array(columns, np.float64).reshape(4, 4).T.copy()
    return compose(*local_parts(place))


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


def decompose(
    matrices: FloatArray, scale_signs: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return translation [F, 3], unit rotation [F, 4] and scale [F, 3] of matrices [F, 4, 4].

    A mirroring matrix takes the signs of `scale_signs` [3] where they fit, else x is reversed.
    Shear, which no node can hold, is left out: the rotation is then the nearest one.
    """
    linear = matrices[:, :3, :3]
    mirrored = np.linalg.det(linear) < 0.0
    signs = np.where(scale_signs < 0.0, -1.0, 1.0)
    if bool((np.prod(signs) < 0.0) != mirrored[0]):
        signs = np.array([-1.0, 1.0, 1.0]) if mirrored[0] else np.ones(3)
    scale = np.linalg.norm(linear, axis=1) * signs
    with np.errstate(divide="ignore", invalid="ignore"):
        turn = linear / scale[:, None, :]
    turn = np.where(np.isfinite(turn), turn, np.eye(3))
    skew = np.abs(turn.transpose(0, 2, 1) @ turn - np.eye(3)).max()
    if skew > 1e-6:
        left, _, right = np.linalg.svd(turn)
        turn = left @ right
        scale = np.einsum("fij,fij->fj", turn, linear)
    return matrices[:, :3, 3].copy(), quaternions(turn), scale


def quaternions(turns: FloatArray) -> FloatArray:
    """Return unit quaternions [F, 4] of rotation matrices [F, 3, 3] (Shepperd's four cases)."""
    xx, yy, zz = turns[:, 0, 0], turns[:, 1, 1], turns[:, 2, 2]
    x = turns[:, 2, 1] - turns[:, 1, 2]
    y = turns[:, 0, 2] - turns[:, 2, 0]
    z = turns[:, 1, 0] - turns[:, 0, 1]
    xy = turns[:, 1, 0] + turns[:, 0, 1]
    xz = turns[:, 0, 2] + turns[:, 2, 0]
    yz = turns[:, 2, 1] + turns[:, 1, 2]
    cases = np.stack(
        [
            np.stack([1.0 + xx - yy - zz, xy, xz, x], axis=-1),
            np.stack([xy, 1.0 - xx + yy - zz, yz, y], axis=-1),
            np.stack([xz, yz, 1.0 - xx - yy + zz, z], axis=-1),
            np.stack([x, y, z, 1.0 + xx + yy + zz], axis=-1),
        ],
        axis=1,
    )
    sizes = np.linalg.norm(cases, axis=-1)
    largest = sizes.argmax(axis=1)
    rows = np.arange(len(turns))
    return np.asarray(cases[rows, largest] / sizes[rows, largest, None])
