"""The least height of the body: upper convex hulls of slices of what lies beneath (P1 3.2, Fig 4b).

Several vertical slices along the body, several across it. Each is sampled from the surface, taken
together with the feet that stand in it, and closed by its upper convex hull.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from polypod.body.support import foot_on_its_way
from polypod.compute import kernel
from polypod.environment.table import surface
from polypod.morphology.types import FloatArray

SLICES = 3
SAMPLES = 11


def make_hull_scratch(feet: int) -> FloatArray:
    """Return working memory for one thread: [points, 2] of a slice, sorted along it."""
    return np.zeros((SAMPLES + feet, 2))


@kernel
def insert_sorted(points: Any, count: int, along: float, up: float) -> int:
    """Insert a point into `points[:count]`, kept sorted by `along`; return the new count."""
    i = count
    while i > 0 and points[i - 1, 0] > along:
        points[i, 0] = points[i - 1, 0]
        points[i, 1] = points[i - 1, 1]
        i -= 1
    points[i, 0] = along
    points[i, 1] = up
    return count + 1


@kernel
def hull_height(points: Any, count: int, along: float) -> float:
    """Return the height of the points' upper convex hull at `along`.

    Beyond the points the end's height holds. `points[:count]` is sorted and is overwritten by the
    hull (Andrew's monotone chain).
    """
    top = 0
    for i in range(count):
        x = points[i, 0]
        y = points[i, 1]
        if top > 0 and points[top - 1, 0] == x:
            # Of two points over one place the higher counts.
            y = max(y, points[top - 1, 1])
            top -= 1
        while top >= 2 and (
            (points[top - 1, 1] - points[top - 2, 1]) * (x - points[top - 2, 0])
            <= (y - points[top - 2, 1]) * (points[top - 1, 0] - points[top - 2, 0])
        ):
            top -= 1
        points[top, 0] = x
        points[top, 1] = y
        top += 1
    if along <= points[0, 0]:
        return float(points[0, 1])
    for i in range(1, top):
        if along <= points[i, 0]:
            span = points[i, 0] - points[i - 1, 0]
            share = (along - points[i - 1, 0]) / span
            return float(points[i - 1, 1] + share * (points[i, 1] - points[i - 1, 1]))
    return float(points[top - 1, 1])


@kernel
def least_height(
    c: int, state: Any, tables: Any, env: Any, slope_forward: float, ahead: float, points: Any
) -> float:
    """Return the least height of the body centre over what lies under the trunk, metres, world.

    The larger of P1's rule (the hull at the centre, plus the thickness) and of what keeps the
    belly, inclined by `slope_forward`, above each sample. `ahead` metres of ground in front of
    the trunk count too, so that the body has risen when a crate comes under it.
    """
    body = tables.body
    half_z = body.half_size[2]
    half_x = body.half_size[0]
    sine = math.sin(state.heading[c])
    cosine = math.cos(state.heading[c])
    feet = state.swinging.shape[1]
    least = -math.inf
    for i in range(SLICES):
        left = body.box_centre[0] + half_x * (2.0 * i / (SLICES - 1) - 1.0)
        count = 0
        for j in range(SAMPLES):
            forward = body.box_centre[2] - half_z + (2.0 * half_z + ahead) * j / (SAMPLES - 1)
            x = state.position[c, 0] + forward * sine + left * cosine
            z = state.position[c, 2] + forward * cosine - left * sine
            height, _ = surface(env, x, z)
            count = insert_sorted(points, count, forward, height)
            under = min(forward, body.box_centre[2] + half_z)
            least = max(least, height - slope_forward * under)
        for k in range(feet):
            place = foot_on_its_way(c, k, state)
            x = place.x - state.position[c, 0]
            z = place.z - state.position[c, 2]
            across = x * cosine - z * sine - left
            if abs(across) <= half_x / (SLICES - 1):
                count = insert_sorted(points, count, x * sine + z * cosine, place.y)
        least = max(least, hull_height(points, count, 0.0))
    return least + float(body.thickness)
