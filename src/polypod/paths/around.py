"""A smooth path in plan around what a slice blocks: waypoints, then a Hermite (P1 Figure 10a)."""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.math.hermite import hermite_weights
from polypod.math.vec3 import Vec3
from polypod.paths.grid import is_blocked, line_of_sight, trace_cells
from polypod.paths.scratch import PLAN_POINTS, WAYPOINTS, GridScratch, LiftScratch

# A piece that enters a blocked cell has its tangents halved this often, then is a straight line.
HALVINGS = 4


@kernel
def pick_waypoints(
    grid: GridScratch,
    highest: Any,
    place: Any,
    n: int,
    layer: int,
    count: int,
    start: Vec3,
    end: Vec3,
) -> int:
    """Keep of the `count` traced cells those between which no line of sight exists.

    Writes them in order into `grid.waypoint`, first the start and last the end themselves (world),
    and returns how many; 0: more than fit.
    """
    level = grid.level[layer]
    cell = place[2]
    end_u = (end.x - place[0]) / cell
    end_v = (end.z - place[1]) / cell
    u = (start.x - place[0]) / cell
    v = (start.z - place[1]) / cell
    grid.waypoint[0, 0] = start.x
    grid.waypoint[0, 1] = start.z
    points = 1
    at = count - 1
    while at > 0:
        # The furthest cell in sight; the next cell always is a neighbour that may be entered.
        chosen = at - 1
        for ahead in range(at - 1):
            to_u = end_u if ahead == 0 else grid.cells[ahead, 1] + 0.5
            to_v = end_v if ahead == 0 else grid.cells[ahead, 0] + 0.5
            if line_of_sight(grid.closed, highest, level, n, u, v, to_u, to_v):
                chosen = ahead
                break
        at = chosen
        if at == 0:
            break
        if points >= WAYPOINTS - 1:
            return 0
        u = grid.cells[at, 1] + 0.5
        v = grid.cells[at, 0] + 0.5
        grid.waypoint[points, 0] = place[0] + u * cell
        grid.waypoint[points, 1] = place[1] + v * cell
        points += 1
    grid.waypoint[points, 0] = end.x
    grid.waypoint[points, 1] = end.z
    return points + 1


@kernel
def waypoint_tangent(grid: GridScratch, points: int, k: int, axis: int, span: float) -> float:
    """Return the derivative at a waypoint for a piece `span` metres long: along its neighbours."""
    before = max(k - 1, 0)
    after = min(k + 1, points - 1)
    dx = grid.waypoint[after, 0] - grid.waypoint[before, 0]
    dz = grid.waypoint[after, 1] - grid.waypoint[before, 1]
    size = math.hypot(dx, dz)
    if size <= 0.0:
        return 0.0
    return (dx if axis == 0 else dz) * span / size


@kernel
def smooth_plan(
    grid: GridScratch, lift: LiftScratch, highest: Any, place: Any, n: int, layer: int, points: int
) -> int:
    """Write the 2D Hermite through the waypoints into `lift.plan` and return its number of points.

    Where a sampled piece enters a blocked cell its tangents are halved, down to the polyline.
    """
    samples = min((PLAN_POINTS - 1) // (points - 1), 16)
    level = grid.level[layer]
    cell = place[2]
    lift.plan[0, 0] = grid.waypoint[0, 0]
    lift.plan[0, 1] = grid.waypoint[0, 1]
    lift.plan[0, 2] = 0.0
    at = 0
    for piece in range(points - 1):
        x0 = grid.waypoint[piece, 0]
        z0 = grid.waypoint[piece, 1]
        x1 = grid.waypoint[piece + 1, 0]
        z1 = grid.waypoint[piece + 1, 1]
        span = math.hypot(x1 - x0, z1 - z0)
        scale = 1.0
        for halving in range(HALVINGS + 1):
            if halving == HALVINGS:
                scale = 0.0
            m0_x = waypoint_tangent(grid, points, piece, 0, span) * scale
            m0_z = waypoint_tangent(grid, points, piece, 1, span) * scale
            m1_x = waypoint_tangent(grid, points, piece + 1, 0, span) * scale
            m1_z = waypoint_tangent(grid, points, piece + 1, 1, span) * scale
            clear = True
            for j in range(1, samples + 1):
                a, b, c, d = hermite_weights(j / samples)
                x = x0 * a + m0_x * b + x1 * c + m1_x * d
                z = z0 * a + m0_z * b + z1 * c + m1_z * d
                column = min(max(math.floor((x - place[0]) / cell), 0), n - 1)
                row = min(max(math.floor((z - place[1]) / cell), 0), n - 1)
                first = piece == 0 and math.hypot(x - x0, z - z0) < cell
                if is_blocked(grid.closed, highest, level, row, column) and not first:
                    clear = False
                    break
                lift.plan[at + j, 0] = x
                lift.plan[at + j, 1] = z
                step = math.hypot(x - lift.plan[at + j - 1, 0], z - lift.plan[at + j - 1, 1])
                lift.plan[at + j, 2] = lift.plan[at + j - 1, 2] + step
            if clear or halving == HALVINGS:
                break
            scale *= 0.5
        if not clear:
            # The polyline itself: a blocked cell touched by a corner of a piece is left to checks.
            for j in range(1, samples + 1):
                lift.plan[at + j, 0] = x0 + (x1 - x0) * j / samples
                lift.plan[at + j, 1] = z0 + (z1 - z0) * j / samples
                lift.plan[at + j, 2] = lift.plan[at, 2] + span * j / samples
        at += samples
    return at + 1


@kernel
def plan_around(
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
    """Write the path in plan to a target in cell (row, column); return its points, 0: no way."""
    count = trace_cells(grid, layer, row, column)
    if count == 0:
        return 0
    points = pick_waypoints(grid, highest, place, n, layer, count, start, end)
    if points == 0:
        return 0
    return smooth_plan(grid, lift, highest, place, n, layer, points)
