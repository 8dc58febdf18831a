"""Convex shapes from points: polygons in the plan, planes in space; nothing here is compiled."""

from __future__ import annotations

import itertools
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


def hull_planes(points: FloatArray) -> FloatArray:
    """Return the planes [P, 4] (outward normal, offset) of the convex hull of points [N, 3].

    Every three points span a plane; those with all points on one side are the hull's. That is slow
    for many points and right for the few dozen of an obstacle. A flat or empty hull has no planes.
    """
    extent = float(np.max(np.ptp(points, axis=0))) if len(points) else 0.0
    triples = np.array(list(itertools.combinations(range(len(points)), 3)), dtype=np.int64)
    if len(points) < 4 or extent == 0.0:
        return np.zeros((0, 4))
    middle = points.mean(axis=0)
    scaled = (points - middle) / extent
    found: list[FloatArray] = []
    for part in np.array_split(triples, max(1, len(triples) // 4096)):
        a, b, c = scaled[part[:, 0]], scaled[part[:, 1]], scaled[part[:, 2]]
        normal = np.cross(b - a, c - a)
        size = np.linalg.norm(normal, axis=1)
        solid = size > 1e-9
        normal = normal[solid] / size[solid, None]
        height = normal @ scaled.T - np.sum(normal * a[solid], axis=1)[:, None]
        for sign in (1.0, -1.0):
            outer = np.all(sign * height <= 1e-9, axis=1) & np.any(sign * height < -1e-7, axis=1)
            facing = sign * normal[outer]
            found.append(np.column_stack([facing, np.max(facing @ scaled.T, axis=1)]))
    planes = np.concatenate(found)
    _, first = np.unique(np.round(planes, 6) + 0.0, axis=0, return_index=True)
    planes = planes[np.sort(first)]
    planes[:, 3] = planes[:, 3] * extent + planes[:, :3] @ middle
    return planes
