"""What a herd remembers of its ways, and the memory in which ways are looked for."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.environment.maps import LocalMap, make_local_map
from polypod.paths.scratch import BUCKETS, NEAR

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

# Cells a side of the map in which a way is looked for.
ROUTE_CELLS = 120
# Corners that are kept of a way; what lies beyond is looked for again on the way there.
ROUTE_CORNERS = 12
# Places that were not got past, of which the last are remembered.
BAD_PLACES = 8


class RouteState(NamedTuple):
    """The way to the waypoint that each creature approaches; world, metres and seconds."""

    corner_place: FloatArray  # [C, ROUTE_CORNERS, 2] x, z: corners that come before the waypoint
    corner_count: IntArray  # [C] 0: straight to the waypoint
    corner: IntArray  # [C] index of the corner being approached
    ends: BoolArray  # [C] no way leads to the waypoint: the last corner is as near as it gets
    waypoint: IntArray  # [C] whose way this is, -1: none
    goal: FloatArray  # [C, 2] x, z: where that waypoint was when the way was found
    clock: FloatArray  # [C] s since the way was looked for
    margin: FloatArray  # [C] what is kept from forbidden things on the way
    astray_from: FloatArray  # [C, 2] x, z: where the search for an end of a barrier began
    astray: FloatArray  # [C] m gone since then, 0: there is no such search
    looked_from: FloatArray  # [C, 2] x, z: where the way was last looked for
    bad_place: FloatArray  # [C, BAD_PLACES, 2] x, z: what a way led to and legs did not get past
    bad_count: IntArray  # [C] how many there were


def make_route_state(count: int) -> RouteState:
    """Return the ways of a herd: none yet."""
    return RouteState(
        corner_place=np.zeros((count, ROUTE_CORNERS, 2)),
        corner_count=np.zeros(count, np.int64),
        corner=np.zeros(count, np.int64),
        ends=np.zeros(count, np.bool_),
        waypoint=np.full(count, -1),
        goal=np.zeros((count, 2)),
        clock=np.zeros(count),
        margin=np.zeros(count),
        astray_from=np.zeros((count, 2)),
        astray=np.zeros(count),
        looked_from=np.zeros((count, 2)),
        bad_place=np.zeros((count, BAD_PLACES, 2)),
        bad_count=np.zeros(count, np.int64),
    )


class RouteScratch(NamedTuple):
    """One thread's map of where a body can be, and the wave that spreads in it; n cells a side."""

    window: LocalMap
    stand: BoolArray  # [n, n] a foot can stand there
    top: FloatArray  # [n, n] m: the highest that a trunk over the cell would meet
    wide_top: FloatArray  # [n, n] m: the highest within the way that the feet take
    near_forbidden: IntArray  # [n, n] 0: not; 1: feet have little room; 2: none
    limit: FloatArray  # [2] m: the highest step; the widest gap
    steps: IntArray  # [n + 2, n + 2] how far something forbidden is, in a chamfer's steps
    distance: IntArray  # [n, n] cost from the wave's start, -1 where it does not get
    parent: IntArray  # [n, n] the direction from which it came, 0 to 7
    level: FloatArray  # [n, n] m: height of the ground on which the body gets there
    gap: FloatArray  # [n, n] m gone since there was ground underfoot
    first: IntArray  # [BUCKETS] newest entry in each bucket, -1: none
    entry: IntArray  # [8 n n, 3] next entry in the bucket, row, column
    cells: IntArray  # [n n, 2] cells of a way, from its end back to the start
    near: IntArray  # [NEAR]


def make_route_scratch() -> RouteScratch:
    """Return the memory for one thread; the system provides it only once it is written to."""
    n = ROUTE_CELLS
    return RouteScratch(
        window=make_local_map(n),
        stand=np.zeros((n, n), np.bool_),
        top=np.zeros((n, n)),
        wide_top=np.zeros((n, n)),
        near_forbidden=np.zeros((n, n), np.int64),
        limit=np.zeros(2),
        steps=np.zeros((n + 2, n + 2), np.int64),
        distance=np.zeros((n, n), np.int64),
        parent=np.zeros((n, n), np.int64),
        level=np.zeros((n, n)),
        gap=np.zeros((n, n)),
        first=np.zeros(BUCKETS, np.int64),
        entry=np.zeros((8 * n * n, 3), np.int64),
        cells=np.zeros((n * n, 2), np.int64),
        near=np.zeros(NEAR, np.int64),
    )
