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
    """Return the faces [T, 3] of each connected piece, in the order of their first faces."""
    label = np.arange(int(faces.max(initial=-1)) + 1)
    while True:
        # Each corner takes the least label of its faces, and then that one's own.
        least = label[faces].min(axis=1)
        lower = label.copy()
        np.minimum.at(lower, faces.ravel(), np.repeat(least, 3))
        lower = lower[lower]
        if np.array_equal(lower, label):
            break
        label = lower
    owner = label[faces[:, 0]]
    _, first = np.unique(owner, return_index=True)
    return [faces[owner == owner[i]] for i in np.sort(first)]


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
    rims = pieces(np.column_stack([edges, edges[:, 0]]))
    for number, rim in enumerate(rims):
        middle = len(points) + number
        lid = np.column_stack([rim[:, 1], rim[:, 0], np.full(len(rim), middle)])
        faces = np.concatenate([faces, lid])
    middles = [points[np.unique(rim)].mean(axis=0) for rim in rims]
    return np.concatenate([points, np.array(middles)]), faces
