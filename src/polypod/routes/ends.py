"""Where a way leads: to its goal, or the best that there is instead."""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.routes.passable import ROOMY, room_at
from polypod.routes.state import RouteScratch

# Along a barrier that goes on beyond the map it goes on to the same side, for so many leg lengths,
# until it comes nearer to its goal by this.
FARTHEST_ASTRAY = 100.0
NEARER = 1.0
ONWARD = 1.05
# Of places as near to a goal that is not reached, that to which the way is shorter.
NEAREST_WAY = 0.05


@kernel
def is_place(route: RouteScratch, i: int, j: int, level: float, within: float) -> bool:
    """Return whether a body has room to stand over a cell, on ground `within` m of a level."""
    height = route.window.highest[i, j]
    return bool(
        route.stand[i, j]
        and room_at(route, i, j, height) == ROOMY
        and abs(height - level) <= within
    )


@kernel
def nearest_place(
    route: RouteScratch, row: int, column: int, around: int, level: float, within: float
) -> tuple[int, int]:
    """Return the cell nearest to one where a body can stand, at most `around` cells off; or -1."""
    n = route.window.size[0]
    best = 2 * n * n
    best_row = -1
    best_column = -1
    for i in range(max(row - around, 0), min(row + around + 1, n)):
        for j in range(max(column - around, 0), min(column + around + 1, n)):
            away = (i - row) * (i - row) + (j - column) * (j - column)
            if away < best and is_place(route, i, j, level, within):
                best = away
                best_row = i
                best_column = j
    return best_row, best_column


@kernel
def reaches_border(route: RouteScratch) -> bool:
    """Return whether the wave has come to the map's border."""
    n = route.window.size[0]
    for i in range(n):
        if (
            route.distance[i, 0] >= 0
            or route.distance[i, n - 1] >= 0
            or route.distance[0, i] >= 0
            or route.distance[n - 1, i] >= 0
        ):
            return True
    return False


@kernel
def best_end(
    c: int, route: RouteScratch, goal_u: float, goal_v: float, leaves: bool, ways: Any
) -> tuple[int, int]:
    """Return the reached cell that is best to go to for a goal that is not reached; cells.

    Where the way `leaves` the map, that is the cell at the border from which it is shortest, on the
    side to which it went before; else the cell nearest to the goal.
    """
    n = route.window.size[0]
    cell = route.window.place[2]
    from_u = (ways.astray_from[c, 0] - route.window.place[0]) / cell
    from_v = (ways.astray_from[c, 1] - route.window.place[1]) / cell
    least = math.inf
    row = -1
    column = -1
    for i in range(n):
        border = i == 0 or i == n - 1
        for j in range(n):
            if route.distance[i, j] < 0 or route.gap[i, j] > 0.0:
                continue
            if leaves and not (border or j == 0 or j == n - 1):
                continue
            if not leaves and room_at(route, i, j, route.level[i, j]) != ROOMY:
                continue
            cost = math.hypot(j + 0.5 - goal_u, i + 0.5 - goal_v)
            cost += (1.0 if leaves else NEAREST_WAY) * 0.1 * route.distance[i, j]
            if leaves and ways.astray[c] > 0.0:
                cost -= ONWARD * math.hypot(j + 0.5 - from_u, i + 0.5 - from_v)
            if cost < least:
                least = cost
                row = i
                column = j
    return row, column


@kernel
def note_astray(c: int, x: float, z: float, goal: Any, leg: float, ways: Any) -> bool:
    """Note how far a creature has gone along a barrier; return whether it may go on so."""
    before = math.hypot(ways.astray_from[c, 0] - goal[0], ways.astray_from[c, 1] - goal[1])
    nearer = math.hypot(x - goal[0], z - goal[1]) < before - NEARER * leg
    if ways.astray[c] <= 0.0 or nearer:
        ways.astray[c] = 0.0
        ways.astray_from[c, 0] = x
        ways.astray_from[c, 1] = z
        return True
    ways.astray[c] += math.hypot(x - ways.looked_from[c, 0], z - ways.looked_from[c, 1])
    return bool(ways.astray[c] < FARTHEST_ASTRAY * leg)
