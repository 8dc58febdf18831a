"""Faces of many corners become triangles, concave ones too."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

FLAT = 1e-12  # of the square of a face's area: a turn the other way that is mere rounding


def triangulate(faces: FloatArray) -> IntArray:
    """Return the triangles of faces, as numbers of their corners.

    Args:
        faces: corners [F, n, x y z] of F faces of n corners each, about flat and not crossing
            themselves.

    Returns:
        [F, n - 2, 3] corners from 0 to n - 1.
    """
    count = faces.shape[1]
    fan = np.array([[0, i, i + 1] for i in range(1, count - 1)], dtype=np.int64)
    triangles = np.tile(fan, (len(faces), 1, 1))
    if count == 3:
        return triangles
    normal = np.cross(faces - faces[:, :1], np.roll(faces, -1, axis=1) - faces[:, :1]).sum(axis=1)
    before, after = faces - np.roll(faces, 1, axis=1), np.roll(faces, -1, axis=1) - faces
    turn = np.einsum("fni,fi->fn", np.cross(before, after), normal)
    concave = np.any(turn < -FLAT * np.sum(normal**2, axis=1, keepdims=True), axis=1)
    for face in np.flatnonzero(concave):
        # Seen along the axis nearest to its normal it is widest.
        axis = int(np.argmax(np.abs(normal[face])))
        seen = np.delete(faces[face], axis, axis=1)
        clockwise = (normal[face, axis] < 0.0) != (axis == 1)
        triangles[face] = _ears(seen * (-1.0, 1.0) if clockwise else seen)
    return triangles


def _ears(corners: FloatArray) -> IntArray:
    """Return triangles [n - 2, 3] of a polygon [n, 2] that turns left: it loses ear after ear."""
    left = list(range(len(corners)))
    triangles = []
    while len(left) > 3:
        # A face that crosses itself may have no ear: any corner will do.
        at = next((i for i in range(len(left)) if _is_ear(corners[left], i)), 0)
        triangles.append([left[at - 1], left[at], left[(at + 1) % len(left)]])
        del left[at]
    return np.array([*triangles, left], dtype=np.int64)


def _is_ear(corners: FloatArray, at: int) -> bool:
    """Say whether a corner of a polygon turns left and its triangle holds no other corner."""
    triangle = corners[[at - 1, at, (at + 1) % len(corners)]]
    along = np.roll(triangle, -1, axis=0) - triangle
    if along[0, 0] * along[1, 1] - along[0, 1] * along[1, 0] <= 0.0:
        return False
    off = corners[:, None] - triangle
    inside = np.all(along[:, 0] * off[..., 1] - along[:, 1] * off[..., 0] >= 0.0, axis=1)
    # A corner that only touches another, as where a hole is joined to the outline, hides nothing.
    touches = np.any(np.all(off == 0.0, axis=2), axis=1)
    return not bool(np.any(inside & ~touches))
