"""Rotations and runs of frames on whole arrays, for figures and pictures."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


def conjugate_all(rotation: FloatArray) -> FloatArray:
    """Return the inverse rotations; quaternions x, y, z, w on the last axis."""
    inverse: FloatArray = rotation * np.array([-1.0, -1.0, -1.0, 1.0])
    return inverse


def multiply_all(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the rotations by `b`, then by `a`; shapes broadcast."""
    ax, ay, az, aw = np.moveaxis(a, -1, 0)
    bx, by, bz, bw = np.moveaxis(b, -1, 0)
    return np.stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ],
        axis=-1,
    )


def rotate_all(rotation: FloatArray, vector: FloatArray) -> FloatArray:
    """Return the vectors [..., 3] turned by the rotations [..., 4]; shapes broadcast."""
    axis, scalar = rotation[..., :3], rotation[..., 3:]
    twice = 2.0 * np.cross(axis, vector)
    turned: FloatArray = vector + scalar * twice + np.cross(axis, twice)
    return turned


def matrices_of(rotation: FloatArray) -> FloatArray:
    """Return the rotation matrices [..., 3, 3] of quaternions [..., 4]."""
    columns = [rotate_all(rotation, axis) for axis in np.eye(3)]
    return np.stack(columns, axis=-1)


def angles_of(rotation: FloatArray) -> FloatArray:
    """Return the angles of the rotations, radians in [0, pi]."""
    sine = np.linalg.norm(rotation[..., :3], axis=-1)
    angle: FloatArray = 2.0 * np.arctan2(sine, np.abs(rotation[..., 3]))
    return angle


def runs_of(mask: BoolArray) -> list[tuple[int, int]]:
    """Return the (first, beyond-last) frames of each run of True in `mask` [F]."""
    edges = np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8))
    starts, stops = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    return [(int(start), int(stop)) for start, stop in zip(starts, stops, strict=True)]


def widest(points: FloatArray) -> float:
    """Return the largest distance between any two of the points [N, 3]."""
    # Float drift in millions of pairs is not worth the memory: distinct points are few in a stance.
    distinct = np.unique(points, axis=0)
    most = 0.0
    for point in distinct:
        most = max(most, float(np.linalg.norm(distinct - point, axis=1).max()))
    return most
