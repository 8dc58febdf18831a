"""Convex polygons in the plan, and rotations; nothing here is compiled."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

ROUND_SIDES = 24  # of a polygon around a circle
# How far such a polygon reaches beyond its circle, in radii, and how much further in than its own
# the sides of the polygon inside the circle lie.
ROUND_SLACK = 1.0 / math.cos(math.pi / ROUND_SIDES) - 1.0
ROUND_SAG = 1.0 - math.cos(math.pi / ROUND_SIDES)


def rotation_matrix(rotation: tuple[float, ...]) -> FloatArray:
    """Return the matrix [3, 3] of a unit quaternion x, y, z, w."""
    x, y, z, w = rotation
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def circle_around(radius: float) -> FloatArray:
    """Return the corners [ROUND_SIDES, 2] of the regular polygon around a circle at the origin."""
    angle = 2.0 * math.pi * (np.arange(ROUND_SIDES) + 0.5) / ROUND_SIDES
    return radius * (1.0 + ROUND_SLACK) * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def polygon_around(points: FloatArray) -> FloatArray:
    """Return the convex hull [V, 2] of plan points [N, 2], turning from +x toward +z.

    Corners nearer to the line of their neighbours than 1e-9 of the extent are left out.
    """
    ordered = points[np.lexsort((points[:, 1], points[:, 0]))]
    extent = float(np.max(np.ptp(points, axis=0))) if len(points) else 0.0
    if len(ordered) < 3 or extent == 0.0:
        return ordered

    def chain(sequence: FloatArray) -> list[FloatArray]:
        kept: list[FloatArray] = []
        for point in sequence:
            while len(kept) >= 2:
                first, second = kept[-1] - kept[-2], point - kept[-2]
                if first[0] * second[1] - first[1] * second[0] > 1e-9 * extent * extent:
                    break
                kept.pop()
            kept.append(point)
        return kept

    return np.array(chain(ordered)[:-1] + chain(ordered[::-1])[:-1])


def polygon_sides(corners: FloatArray) -> FloatArray:
    """Return for each corner [V, 2] the side to the next: outward normal x, z and its offset."""
    along = np.roll(corners, -1, axis=0) - corners
    normal = np.stack([along[:, 1], -along[:, 0]], axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return np.column_stack([normal, np.sum(normal * corners, axis=1)])
