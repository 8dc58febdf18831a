"""The skinned mesh of a creature in any frame of a recording (glTF 2.0, section 3.7.3)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from polypod.report.arrays import FloatArray, matrices_of
from polypod.report.record import Recording

if TYPE_CHECKING:
    from polypod.morphology.types import Morphology
    from polypod.rigs.colours import Paint
    from polypod.rigs.gltf import MeshPart

IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Flesh:
    """One surface of a creature. V vertices, T triangles, W influences a vertex.

    A vertex is where its influences put it on average: influence `w` holds it at `place[:, w]`
    in the body frame at rest and carries it along with joint `row[:, w]` (-1: the body).
    """

    place: FloatArray  # [V, W, 3] body frame, m
    row: IntArray  # [V, W] rows of the joint table
    weight: FloatArray  # [V, W]
    triangles: IntArray  # [T, 3]
    colour: FloatArray  # [V, 3] sRGB
    normal: FloatArray | None  # [V, 3] unit, body frame at rest; None: the file has none
    paint: Paint | None  # the picture that covers it


def flesh_of(morphology: Morphology) -> list[Flesh]:
    """Return all surfaces of a creature, ready to be posed."""
    document = morphology.source.document
    row_of_node = {int(node): row for row, node in enumerate(morphology.joint_node)}
    return [
        _skinned(morphology, part, row_of_node)
        if part.skin >= 0
        else _carried(morphology, part, row_of_node)
        for part in document.mesh_parts()
    ]


def pose(flesh: Flesh, recording: Recording, frame: int) -> FloatArray:
    """Return the world positions [V, 3] of a surface's vertices in one frame, m."""
    # The body is one row more, so that -1 finds it.
    rotation = np.concatenate(
        [recording.joint_rotation[frame], recording.body_rotation[frame][None]]
    )
    position = np.concatenate(
        [recording.joint_position[frame], recording.body_position[frame][None]]
    )
    pivot = np.concatenate([recording.morphology.joint_rest, np.zeros((1, 3))])
    turn = matrices_of(rotation)
    shift = position - np.einsum("jab,jb->ja", turn, pivot)
    world = np.zeros(flesh.place[:, 0].shape)
    for influence in range(flesh.place.shape[1]):
        row = flesh.row[:, influence]
        moved = np.einsum("vab,vb->va", turn[row], flesh.place[:, influence]) + shift[row]
        world += flesh.weight[:, influence, None] * moved
    return world


def _skinned(morphology: Morphology, part: MeshPart, row_of_node: dict[int, int]) -> Flesh:
    """Return a part that joints deform: rest place = A W_j IBM_j v (module `Flesh`)."""
    source = morphology.source
    skin = source.document.skins()[part.skin]
    rows = np.array([row_of_node[int(node)] for node in skin.joints], np.int64)
    bind = source.body_from_file @ source.joint_rest_file[rows] @ skin.inverse_bind
    place = np.einsum("vwab,vb->vwa", bind[part.joints], _homogeneous(part.positions))
    normal = None
    if part.normals is not None:
        turn = _for_normals(bind[:, :3, :3])[part.joints]
        normal = _unit(np.einsum("vw,vwab,vb->va", part.weights, turn, part.normals))
    return Flesh(
        place=place[..., :3],
        row=rows[part.joints],
        weight=part.weights,
        triangles=part.triangles,
        colour=part.vertex_colour,
        normal=normal,
        paint=part.paint,
    )


def _carried(morphology: Morphology, part: MeshPart, row_of_node: dict[int, int]) -> Flesh:
    """Return a part that rides rigidly on its node's nearest joint, or on the body."""
    source = morphology.source
    document = source.document
    parents, node_world = document.node_parents(), document.node_world_matrices()
    node = part.node
    while node >= 0 and node not in row_of_node:
        node = int(parents[node])
    to_file = node_world[part.node]
    row = -1
    if node >= 0:
        # The way from the joint to the mesh is the node pose's; the joint itself is at rest.
        row = row_of_node[node]
        to_file = source.joint_rest_file[row] @ np.linalg.solve(node_world[node], to_file)
    count = len(part.positions)
    to_body = source.body_from_file @ to_file
    place = _homogeneous(part.positions) @ to_body.T
    normal = None
    if part.normals is not None:
        normal = _unit(part.normals @ _for_normals(to_body[None, :3, :3])[0].T)
    return Flesh(
        place=place[:, None, :3],
        row=np.full((count, 1), row, np.int64),
        weight=np.ones((count, 1)),
        triangles=part.triangles,
        colour=part.vertex_colour,
        normal=normal,
        paint=part.paint,
    )


def _for_normals(matrix: FloatArray) -> FloatArray:
    """Return [N, 3, 3] what turns normals where [N, 3, 3] turns places: its cofactors.

    They are the inverse's transpose times the determinant, and are there where that is 0.
    """
    rows = [np.cross(matrix[:, (i + 1) % 3], matrix[:, (i + 2) % 3]) for i in range(3)]
    return np.stack(rows, axis=1)


def _unit(vectors: FloatArray) -> FloatArray:
    size = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.where(size > 0.0, vectors / np.where(size > 0.0, size, 1.0), [0.0, 1.0, 0.0])


def _homogeneous(points: FloatArray) -> FloatArray:
    return np.concatenate([points, np.ones((len(points), 1))], axis=1)
