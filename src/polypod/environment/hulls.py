"""The convex hull of points in space: grown corner by corner, the farthest first.

So it can stop early: a hull of few corners that is nearly that of many.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# In extents of the points: what is nearer to a face lies on it; what is flatter is no solid.
ON_FACE = 1e-9
FLAT = 1e-7


def hull_triangles(points: FloatArray, most: int = 0, within: float = ON_FACE) -> IntArray:
    """Return the triangles [T, 3 points] of the convex hull of points [N, 3], seen from outside.

    Args:
        points: any number of them.
        most: corners that the hull may have; 0: as many as it takes.
        within: how far points may stay outside, in extents.

    Returns:
        Counter-clockwise from outside; none where all points lie about in one plane.
    """
    extent = float(np.max(np.ptp(points, axis=0))) if len(points) else 0.0
    if len(points) < 4 or not extent > 0.0:
        return np.zeros((0, 3), np.int64)
    scaled = (points - points.mean(axis=0)) / extent
    faces = _first_four(scaled)
    corners = 4
    while len(faces) and (most == 0 or corners < most):
        height = _heights(scaled, faces)
        farthest = int(np.argmax(height.max(axis=1)))
        if not height[farthest].max() > within:
            break
        point = _outermost(scaled, height[farthest])
        faces = _with_corner(faces, height[:, point] > within, point)
        corners = len(np.unique(faces))
    return faces


def hull_planes(points: FloatArray) -> FloatArray:
    """Return the planes [P, 4] (outward normal, offset) of the convex hull of points [N, 3].

    A flat or empty hull has none.
    """
    faces = hull_triangles(points)
    if not len(faces):
        return np.zeros((0, 4))
    extent, middle = float(np.max(np.ptp(points, axis=0))), points.mean(axis=0)
    scaled = (points - middle) / extent
    normal = _normals(scaled, faces)
    planes = np.column_stack([normal, np.max(normal @ scaled[np.unique(faces)].T, axis=1)])
    _, first = np.unique(np.round(planes, 6) + 0.0, axis=0, return_index=True)
    planes = planes[np.sort(first)]
    planes[:, 3] = planes[:, 3] * extent + planes[:, :3] @ middle
    return planes


def _outermost(scaled: FloatArray, height: FloatArray) -> int:
    """Return the point of greatest height; of several, the farthest out: surely a corner."""
    highest = np.flatnonzero(height >= height.max() - ON_FACE)
    return int(highest[np.argmax(np.sum(scaled[highest] ** 2, axis=1))])


def _first_four(scaled: FloatArray) -> IntArray:
    """Return the faces [4, 3] of a tetrahedron of corners, or none."""
    a = int(np.lexsort(scaled.T[::-1])[0])
    b = _outermost(scaled, np.linalg.norm(scaled - scaled[a], axis=1))
    along = (scaled[b] - scaled[a]) / np.linalg.norm(scaled[b] - scaled[a])
    aside = np.linalg.norm(np.cross(scaled - scaled[a], along), axis=1)
    c = _outermost(scaled, aside)
    normal = np.cross(scaled[b] - scaled[a], scaled[c] - scaled[a])
    if not aside[c] > FLAT:
        return np.zeros((0, 3), np.int64)
    height = (scaled - scaled[a]) @ (normal / np.linalg.norm(normal))
    d = _outermost(scaled, np.abs(height))
    if not abs(height[d]) > FLAT:
        return np.zeros((0, 3), np.int64)
    if height[d] > 0.0:
        b, c = c, b
    return np.array([[a, b, c], [a, c, d], [c, b, d], [b, a, d]], dtype=np.int64)


def _normals(scaled: FloatArray, faces: IntArray) -> FloatArray:
    a, b, c = (scaled[faces[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    unit: FloatArray = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    return unit


def _heights(scaled: FloatArray, faces: IntArray) -> FloatArray:
    """Return how far [T, N] each point is outside each face."""
    normal = _normals(scaled, faces)
    offset = np.sum(normal * scaled[faces[:, 0]], axis=1)
    height: FloatArray = normal @ scaled.T - offset[:, None]
    return height


def _with_corner(faces: IntArray, seen: NDArray[np.bool_], point: int) -> IntArray:
    """Return the faces with those that a point sees replaced by a cone to it."""
    lost = faces[seen]
    edges = np.concatenate([lost[:, [0, 1]], lost[:, [1, 2]], lost[:, [2, 0]]])
    inner = {(int(i), int(j)) for i, j in edges}
    rim = [(i, j, point) for i, j in sorted(inner) if (j, i) not in inner]
    return np.concatenate([faces[~seen], np.array(rim, dtype=np.int64)])
