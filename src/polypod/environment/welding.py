"""Triangles become a surface: corners at one place are one corner; its pieces and its holes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

WELD = 1e-6  # of the extent: corners nearer to each other are one


def weld(triangles: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return corners [N, 3] and faces [T, 3] of triangles [T, 3 corners, x y z].

    Corners that lie in one place are one, as where a file gives each face its own; faces that have
    no area then are left out, and so is a face that is there twice.
    """
    points = triangles.reshape(-1, 3)
    step = WELD * float(np.ptp(points, axis=0).max())
    places = np.round((points - points.min(axis=0)) / step).astype(np.int64)
    _, first, index = np.unique(places, axis=0, return_index=True, return_inverse=True)
    faces = index.reshape(-1, 3)
    a, b, c = faces.T
    faces = faces[(a != b) & (b != c) & (c != a)]
    _, once = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return points[first], faces[np.sort(once)]


def pieces(faces: IntArray) -> list[IntArray]:
    """Return the faces [T, 3] of each piece, joined by edges, in the order of their first faces.

    Where only corners touch, as the legs of a table may touch its top, pieces stay apart.
    """
    edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, number = np.unique(edges, axis=0, return_inverse=True)
    return [faces[joined] for joined in _joined(number.reshape(-1, 3))]


def _joined(members: IntArray) -> list[IntArray]:
    """Return which rows of members [N, m] hang together by having members in common."""
    label = np.arange(int(members.max(initial=-1)) + 1)
    while True:
        # Each member takes the least label of its rows, and then that one's own.
        lower = label.copy()
        np.minimum.at(lower, members, label[members].min(axis=1, keepdims=True))
        lower = lower[lower]
        if np.array_equal(lower, label):
            break
        label = lower
    owner = label[members[:, 0]]
    _, first = np.unique(owner, return_index=True)
    return [np.flatnonzero(owner == owner[i]) for i in np.sort(first)]


def open_edges(faces: IntArray) -> IntArray:
    """Return the edges [E, 2] that bound an odd number of faces, along their one face."""
    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    _, first, count = np.unique(
        np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True
    )
    return edges[np.sort(first[count % 2 == 1])]


def close_holes(
    points: FloatArray, faces: IntArray, edges: IntArray
) -> tuple[FloatArray, IntArray]:
    """Return corners and faces with a lid on each hole: a fan about the middle of its rim.

    Holes whose rims touch have one lid in common.
    """
    rims = [edges[joined] for joined in _joined(edges)]
    for number, rim in enumerate(rims):
        middle = len(points) + number
        lid = np.column_stack([rim[:, 1], rim[:, 0], np.full(len(rim), middle)])
        faces = np.concatenate([faces, lid])
    middles = [points[np.unique(rim)].mean(axis=0) for rim in rims]
    return np.concatenate([points, np.array(middles)]), faces


def facing_out(points: FloatArray, faces: IntArray) -> IntArray:
    """Return the faces of a closed piece, each counter-clockwise seen from outside.

    Neighbours that a file winds differently are turned to agree, then all of them if the volume
    that they enclose is negative.
    """
    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    along = edges[:, 0] < edges[:, 1]
    _, number = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    number = number.reshape(-1)
    if np.any(np.bincount(number, np.where(along, 1, -1)) != 0):
        faces = _agreeing(faces, number.reshape(-1, 3), along.reshape(-1, 3))
    corner = points[faces] - points.mean(axis=0)
    volume = np.sum(corner[:, 0] * np.cross(corner[:, 1], corner[:, 2]))
    return faces[:, ::-1] if volume < 0.0 else faces


def _agreeing(faces: IntArray, number: IntArray, along: NDArray[np.bool_]) -> IntArray:
    """Return faces wound alike: from face to face over the edges [T, 3] that they have in common.

    `along` [T, 3] says which way a face goes along each edge; neighbours must go opposite ways.
    """
    sharing: dict[int, list[tuple[int, int]]] = {}
    for face, row in enumerate(number.tolist()):
        for side, edge in enumerate(row):
            sharing.setdefault(edge, []).append((face, side))
    flip = np.zeros(len(faces), np.int64)  # 1: as it is, -1: turned, 0: not met yet
    flip[0], waiting = 1, [0]
    while waiting:
        face = waiting.pop()
        for side, edge in enumerate(number[face].tolist()):
            for other, there in sharing[edge]:
                if flip[other] == 0:
                    same = along[face, side] == along[other, there]
                    flip[other] = -flip[face] if same else flip[face]
                    waiting.append(other)
    return np.where((flip < 0)[:, None], faces[:, ::-1], faces)
