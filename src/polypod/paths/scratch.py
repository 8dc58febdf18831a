"""Memory that the path constructor works in, made once and passed to its kernels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.paths.curve import PATH_KNOTS

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

# Most points of a path in plan, before it is sampled at the knots.
PLAN_POINTS = 160
# Most corners of a path in plan.
WAYPOINTS = 24
# Obstacles about a path that are told apart; where there are more, all samples ask all.
NEAR = 48
# A step costs at most 14 + POTENTIAL, so that this many buckets hold a wavefront's front.
BUCKETS = 32


class OtherLegs(NamedTuple):
    """Segments of the other legs; world, m."""

    a: FloatArray  # [S, 3] one end
    b: FloatArray  # [S, 3] the other end
    radius: FloatArray  # [S]


class LiftScratch(NamedTuple):
    """One path on its way from the plan to three dimensions; N is PATH_KNOTS."""

    plan: FloatArray  # [PLAN_POINTS, 3] x, z, and the length so far; world, m
    station: FloatArray  # [N] m of plan length (never all zero: a step on the spot has some too)
    knot: FloatArray  # [N, 4] x, z, and their derivatives with respect to the station
    arc: FloatArray  # [N] m, the step-height arc
    ground: FloatArray  # [N] m, what the piece that ends at the knot must clear
    need: FloatArray  # [N] m, the requirement: neighbours' maximum of arc and ground
    extra: FloatArray  # [N] m, added to the requirement after a failed check
    height: FloatArray  # [N] m, of the curve over the hull of the requirement
    slope: FloatArray  # [N] its derivative with respect to the station
    hull: IntArray  # [N] knots on the hull
    near: IntArray  # [NEAR] obstacles about the path


class GridScratch(NamedTuple):
    """The obstacles' map and its wavefronts, one layer for each slice of elevation."""

    closed: BoolArray  # [n, n] feet may not pass: forbidden, or another leg
    level: FloatArray  # [slices] m: cells higher than this are gone around
    spread: IntArray  # [slices] 1 where the wavefront is there
    distance: IntArray  # [slices, n, n] cost from the start, -1 where not reached
    parent: IntArray  # [slices, n, n] the neighbour it was reached from, 0 to 7
    first: IntArray  # [BUCKETS] newest entry in each bucket, -1: none
    entry: IntArray  # [8 n n, 3] next entry in the bucket, row, column
    cells: IntArray  # [n n, 2] cells of a path, from the target back to the start
    waypoint: FloatArray  # [WAYPOINTS, 2] x, z; world, m


def lift_scratch() -> LiftScratch:
    """Return the memory for one path."""
    return LiftScratch(
        plan=np.zeros((PLAN_POINTS, 3)),
        station=np.zeros(PATH_KNOTS),
        knot=np.zeros((PATH_KNOTS, 4)),
        arc=np.zeros(PATH_KNOTS),
        ground=np.zeros(PATH_KNOTS),
        need=np.zeros(PATH_KNOTS),
        extra=np.zeros(PATH_KNOTS),
        height=np.zeros(PATH_KNOTS),
        slope=np.zeros(PATH_KNOTS),
        hull=np.zeros(PATH_KNOTS, np.int64),
        near=np.zeros(NEAR, np.int64),
    )


def grid_scratch(n: int, slices: int) -> GridScratch:
    """Return the memory for maps of up to n x n cells and up to `slices` wavefronts."""
    return GridScratch(
        closed=np.zeros((n, n), np.bool_),
        level=np.zeros(slices),
        spread=np.zeros(slices, np.int64),
        distance=np.zeros((slices, n, n), np.int64),
        parent=np.zeros((slices, n, n), np.int64),
        first=np.zeros(BUCKETS, np.int64),
        entry=np.zeros((8 * n * n, 3), np.int64),
        cells=np.zeros((n * n, 2), np.int64),
        waypoint=np.zeros((WAYPOINTS, 2)),
    )
