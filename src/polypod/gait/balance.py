"""Static balance: how far inside its standing feet the body's centre is, over a cycle.

Seen from the body, standing feet all travel backward at the walk's speed, so between two events of
the gait the support polygon keeps its shape and slides under the centre. The signed distance from
a point to the edge of a convex polygon is concave along any line, so its least over such an arc is
at one of the arc's ends: the least margin of a cycle is exact.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from polypod.gait.pattern import SAME_MOMENT, BoolArray, FloatArray, Gait, IntArray, wrapped

# Places of an arc, as Gauss and Legendre have it, for its mean.
NODES, WEIGHTS = np.polynomial.legendre.leggauss(4)


class Arcs(NamedTuple):
    """The arcs of a cycle between a gait's events, A of them."""

    start: FloatArray  # [A] phase at which each begins
    length: FloatArray  # [A] share of the cycle
    stands: BoolArray  # [A, K] feet that stand in each

    @property
    def feet_down(self) -> IntArray:
        """[A] how many feet stand."""
        return np.asarray(np.count_nonzero(self.stands, axis=1), dtype=np.int64)


class Margins(NamedTuple):
    """How far the body's centre is inside of its standing feet; NaN where none stands, m."""

    least: FloatArray  # [A] in each arc; outside negative
    mean: FloatArray  # [A]


def arcs_of(gait: Gait) -> Arcs:
    """Return the arcs between a gait's events, and who stands in each."""
    events = np.sort(np.concatenate([gait.swing_start, gait.touchdown]))
    length = np.append(events[1:], events[0] + 1.0) - events
    real = length > SAME_MOMENT
    start, length = events[real], length[real]
    middle = start + 0.5 * length
    stands = wrapped(middle[:, None] - gait.swing_start) >= gait.swing_extent
    return Arcs(start, length, stands)


def margins_of(gait: Gait, arcs: Arcs, rest_plan: FloatArray, stride: float) -> Margins:
    """Return how a gait supports the body's centre.

    Args:
        gait: the gait.
        arcs: its arcs.
        rest_plan: [K, 2] places of the feet at mid-stance, x and z from the body's centre, m.
        stride: m, how far the body moves in a cycle.
    """
    least = np.full(len(arcs.start), math.nan)
    mean = np.full(len(arcs.start), math.nan)
    duty = 1.0 - gait.swing_extent
    for arc, stands in enumerate(arcs.stands):
        if not stands.any():
            continue
        length = float(arcs.length[arc])
        since = wrapped(arcs.start[arc] + 0.5 * length - gait.touchdown)
        feet = rest_plan[stands]
        feet[:, 1] += stride * (0.5 * duty - since)[stands]
        # The centre slides forward over feet that stay: the ends, then the nodes of the mean.
        along = 0.5 * length * stride * np.concatenate([[-1.0, 1.0], NODES])
        margins = margins_along(feet, along)
        least[arc] = margins[:2].min()
        mean[arc] = 0.5 * float(WEIGHTS @ margins[2:])
    return Margins(least, mean)


def margins_along(feet: FloatArray, along: FloatArray) -> FloatArray:
    """Return distances [S] of the places (0, along) to the edge of the hull of feet [n, 2].

    Positive inside, negative outside; of one foot or of feet in a line: never positive.
    """
    places = np.stack([np.zeros_like(along), along], axis=1)
    corners = hull(feet)
    apart = np.linalg.norm(places[:, None] - corners, axis=2).min(axis=1)
    if len(corners) == 1:
        return -apart
    inside = np.full(len(places), math.inf)
    for a, b in pairwise([*corners, corners[0]]):
        side = b - a
        size = float(np.hypot(*side))
        offset = places - a
        # Corners go round counterclockwise: inside is to the left.
        left = (side[0] * offset[:, 1] - side[1] * offset[:, 0]) / size
        inside = np.minimum(inside, left)
        share = (offset @ side) / size**2
        beside = (share >= 0.0) & (share <= 1.0)
        apart = np.where(beside, np.minimum(apart, np.abs(left)), apart)
    return np.where((inside > 0.0) & (len(corners) > 2), apart, -apart)


def hull(points: FloatArray) -> FloatArray:
    """Return the corners [n, 2] of the convex hull of points, counterclockwise."""
    order = sorted({(float(x), float(z)) for x, z in points})
    if len(order) < 3:
        return np.array(order)
    halves = []
    for row in (order, order[::-1]):
        half: list[tuple[float, float]] = []
        for point in row:
            while len(half) > 1 and _turn(half[-2], half[-1], point) <= 0.0:
                half.pop()
            half.append(point)
        halves.append(half[:-1])
    return np.array(halves[0] + halves[1])


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    """Return twice the area of a triangle, positive where its corners go counterclockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
