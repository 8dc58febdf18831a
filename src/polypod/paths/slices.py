"""Slices of elevation: each is an obstacles' map, and one wavefront in it serves all candidates.

P1 section 5.2: "all calculated trajectories will go over all obstacles [...] that have an elevation
lower or equal to the slice's elevation" and around all others.
"""

from __future__ import annotations

from typing import Any

from polypod.compute import kernel
from polypod.math.vec3 import Vec3
from polypod.paths.around import plan_around
from polypod.paths.grid import highest_on_line, line_of_sight, spread_wavefront
from polypod.paths.lift import straight_plan
from polypod.paths.scratch import GridScratch, LiftScratch

OVER_ALL = 1e300  # the level of the slice that goes over everything


@kernel
def place_slices(
    grid: GridScratch,
    highest: Any,
    window_place: Any,
    n: int,
    places: Any,
    kept: int,
    start: Vec3,
    floor: float,
    limit: int,
    thinnest: float,
) -> int:
    """Write the levels of the slices, from above, and return how many there are.

    Layer 0 goes over everything. The others, at most `limit`, lie between the ground (`floor`, m)
    and the highest thing on the straight lines to the candidates, `thinnest` m or more apart; what
    is lower than one slice is always stepped over.
    """
    cell = window_place[2]
    u = (start.x - window_place[0]) / cell
    v = (start.z - window_place[1]) / cell
    top = floor
    for k in range(kept):
        to_u = (places[k, 0] - window_place[0]) / cell
        to_v = (places[k, 2] - window_place[1]) / cell
        top = max(top, highest_on_line(highest, n, u, v, to_u, to_v))
    limit = min(limit, grid.level.shape[0] - 1)
    grid.level[0] = OVER_ALL
    grid.spread[0] = 0
    thickness = max(thinnest, (top - floor) / (limit + 1.0))
    slices = 1
    while slices <= limit and floor + thickness * slices < top:
        slices += 1
    for layer in range(1, slices):
        grid.level[layer] = floor + thickness * (slices - layer)
        grid.spread[layer] = 0
    return slices


@kernel
def plan_top(highest: Any, place: Any, n: int, plan: Any, points: int) -> float:
    """Return the highest cell under a path in plan."""
    top = -OVER_ALL
    for k in range(points - 1):
        u = (plan[k, 0] - place[0]) / place[2]
        v = (plan[k, 1] - place[1]) / place[2]
        to_u = (plan[k + 1, 0] - place[0]) / place[2]
        to_v = (plan[k + 1, 1] - place[1]) / place[2]
        top = max(top, highest_on_line(highest, n, u, v, to_u, to_v))
    return top


@kernel
def plan_layer(
    grid: GridScratch,
    lift: LiftScratch,
    highest: Any,
    place: Any,
    n: int,
    layer: int,
    start: Vec3,
    end: Vec3,
    row: int,
    column: int,
) -> int:
    """Write the shortest path in plan to a place within a slice; return its points, 0: no way."""
    u = (start.x - place[0]) / place[2]
    v = (start.z - place[1]) / place[2]
    to_u = (end.x - place[0]) / place[2]
    to_v = (end.z - place[1]) / place[2]
    if line_of_sight(grid.closed, highest, grid.level[layer], n, u, v, to_u, to_v):
        return straight_plan(lift, start, end)
    if grid.spread[layer] == 0:
        spread_wavefront(grid, highest, n, layer, int(v), int(u))
    return plan_around(grid, lift, highest, place, n, layer, start, end, row, column)
