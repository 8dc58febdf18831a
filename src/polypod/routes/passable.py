"""Where a body can be: the map of what a creature can step over, onto, through and between.

Cells are about a sixth of a leg: less than what decides, a gap or a trench. A body that comes to a
cell on ground of some height finds ground there within a step of it; or none (water, a trench, a
steep face, a drop), over which its legs reach for a while; or something too high. The same place
can be a corridor between walls for who walks below and a trench for who comes along their tops: so
a way has a height, and what is passable is asked on the way.

What legs can do was measured: how high boxes and how wide trenches and gaps walks get over, for ten
creatures (leg lengths: up .35 to 1.2, down .35 to .6, trenches .4 to 1.2).
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.environment.maps import DIAGONAL, STEP, fill_maps
from polypod.footprints.settings import PlanSettings
from polypod.routes.state import BAD_PLACES, ROUTE_CELLS, RouteScratch

CELL = 0.16  # leg lengths
# Most that a step rises or sinks, leg lengths; sprawling legs fold and reach farther.
CLIMB_UPRIGHT = 0.4
CLIMB_SPRAWLING = 0.5
# Most that is stepped over, in stance travels, and at most so many leg lengths.
REACH_UPRIGHT = 1.8
REACH_SPRAWLING = 1.3
LONGEST_REACH = 0.9
# Where feet squeeze between forbidden or high things this part of their track must be free.
SQUEEZE = 0.75
SQUEEZE_HIGH = 0.5
ROOMY, NARROW, SHUT = 0, 1, 2
BAD_RADIUS = 0.5  # about places that were not got past, leg lengths


@kernel
def is_standable(window: Any, i: int, j: int, tolerance: float, steepest: float) -> bool:
    """Return whether a foot can stand in a cell: even, neither too steep nor wet nor forbidden."""
    if window.forbidden[i, j] or window.wet[i, j]:
        return False
    if window.highest[i, j] - window.lowest[i, j] > tolerance:
        return False
    n = window.size[0]
    left = max(j - 1, 0)
    right = min(j + 1, n - 1)
    before = max(i - 1, 0)
    after = min(i + 1, n - 1)
    cell = window.place[2]
    across = (window.highest[i, right] - window.highest[i, left]) / ((right - left) * cell)
    along = (window.highest[after, j] - window.highest[before, j]) / ((after - before) * cell)
    return bool(across * across + along * along <= steepest * steepest)


@kernel
def fill_tops(route: RouteScratch, top: Any, n: int, half_width: float) -> None:
    """Write to `top` the highest thing within a half width, m, of each cell's middle."""
    window = route.window
    # Of what is touched half is free, on average.
    cells = max(half_width / window.place[2] - 0.5, 0.0)
    around = int(cells)
    for i in range(n):
        for j in range(n):
            highest = window.highest[i, j]
            for row in range(max(i - around, 0), min(i + around + 1, n)):
                for column in range(max(j - around, 0), min(j + around + 1, n)):
                    if (row - i) * (row - i) + (column - j) * (column - j) <= cells * cells:
                        highest = max(highest, window.highest[row, column])
            top[i, j] = highest


@kernel
def fill_near_forbidden(route: RouteScratch, n: int, track: float) -> None:
    """Write where something forbidden is near, by two sweeps of a chamfer.

    `track` is half the width of the way that the feet take, m.
    """
    steps = route.steps
    far = 2 * DIAGONAL * n
    found = False
    for i in range(n + 2):
        for j in range(n + 2):
            steps[i, j] = far
    for i in range(n):
        for j in range(n):
            route.near_forbidden[i, j] = ROOMY
            if route.window.forbidden[i, j]:
                steps[i + 1, j + 1] = 0
                found = True
    if not found:
        return
    for i in range(1, n + 1):
        for j in range(1, n + 1):
            above = min(steps[i - 1, j - 1], steps[i - 1, j + 1]) + DIAGONAL
            beside = min(steps[i - 1, j], steps[i, j - 1]) + STEP
            steps[i, j] = min(steps[i, j], min(above, beside))
    a_metre = STEP / route.window.place[2]
    room = track * a_metre - 0.5 * STEP
    squeeze = SQUEEZE * track * a_metre - 0.5 * STEP
    for back_i in range(n):
        i = n - back_i
        for back_j in range(n):
            j = n - back_j
            below = min(steps[i + 1, j - 1], steps[i + 1, j + 1]) + DIAGONAL
            beside = min(steps[i + 1, j], steps[i, j + 1]) + STEP
            steps[i, j] = min(steps[i, j], min(below, beside))
            if steps[i, j] <= max(squeeze, 0.0):
                route.near_forbidden[i - 1, j - 1] = SHUT
            elif steps[i, j] <= room:
                route.near_forbidden[i - 1, j - 1] = NARROW


@kernel
def shut_bad_places(route: RouteScratch, n: int, c: int, ways: Any, radius: float) -> None:
    """Close the cells within a radius, m, of places that a creature did not get past."""
    place = route.window.place
    cells = radius / place[2]
    for k in range(min(ways.bad_count[c], BAD_PLACES)):
        u = (ways.bad_place[c, k, 0] - place[0]) / place[2] - 0.5
        v = (ways.bad_place[c, k, 1] - place[1]) / place[2] - 0.5
        for i in range(max(int(v - cells), 0), min(int(v + cells) + 2, n)):
            for j in range(max(int(u - cells), 0), min(int(u + cells) + 2, n)):
                if (i - v) * (i - v) + (j - u) * (j - u) <= cells * cells:
                    route.near_forbidden[i, j] = SHUT


@kernel
def highest_step(tables: Any) -> float:
    """Return the most that a creature steps up or down, m."""
    return float((CLIMB_UPRIGHT if tables.upright else CLIMB_SPRAWLING) * tables.leg_length)


@kernel
def fill_passable(
    c: int, env: Any, route: RouteScratch, state: Any, tables: Any, settings: PlanSettings
) -> None:
    """Fill the map around a creature."""
    n = ROUTE_CELLS
    leg = tables.leg_length
    cell = CELL * leg
    # Cells that do not shift with the creature: else places as near would change in turns.
    x = math.floor(state.position[c, 0] / cell + 0.5) * cell
    z = math.floor(state.position[c, 2] / cell + 0.5) * cell
    fill_maps(env, route.window, x, z, cell, n, 0.0, 0.0, 0.0, 0.0)
    tolerance = settings.uneven * leg + settings.slope * 1.5 * cell
    for i in range(n):
        for j in range(n):
            route.stand[i, j] = is_standable(route.window, i, j, tolerance, settings.slope)
    trunk = min(tables.body.half_size[0], tables.body.half_size[2])
    fill_tops(route, route.top, n, max(trunk, SQUEEZE_HIGH * tables.track))
    fill_tops(route, route.wide_top, n, max(trunk, tables.track))
    fill_near_forbidden(route, n, tables.track)
    shut_bad_places(route, n, c, state.route, BAD_RADIUS * leg)
    travel = (REACH_UPRIGHT if tables.upright else REACH_SPRAWLING) * tables.stance_travel
    route.limit[0] = highest_step(tables)
    # A cell that the edge of a gap crosses is no ground: there is one on either side.
    route.limit[1] = min(travel, LONGEST_REACH * leg) + cell


@kernel
def room_at(route: RouteScratch, row: int, column: int, level: float) -> int:
    """Return how much room there is over a cell, for who comes on ground of height `level`, m."""
    high = level + route.limit[0]
    if route.top[row, column] > high:
        return SHUT
    if route.wide_top[row, column] > high:
        return max(NARROW, route.near_forbidden[row, column])
    return route.near_forbidden[row, column]


@kernel
def enter(
    route: RouteScratch, row: int, column: int, level: float, gap: float, step: float
) -> tuple[bool, float, float]:
    """Return whether a body can go on into a cell, and on what level and after what gap it is then.

    It comes on ground of height `level`, m, which ended `gap` m ago, and goes `step` m.
    """
    if room_at(route, row, column, level) == SHUT:
        return False, level, gap
    height = route.window.highest[row, column]
    if route.stand[row, column] and abs(height - level) <= route.limit[0]:
        return True, height, 0.0
    return gap + step <= route.limit[1], level, gap + step


@kernel
def sees(route: RouteScratch, u0: float, v0: float, u1: float, v1: float, level: float) -> bool:
    """Return whether a body gets straight from one place to another; cells, u along columns.

    It starts on ground of height `level`. Every cell that the way touches counts; through a narrow
    place it must begin or end in one, so that ways keep to the middle of wide ones.
    """
    n = route.window.size[0]
    column = min(max(math.floor(u0), 0), n - 1)
    row = min(max(math.floor(v0), 0), n - 1)
    last_column = min(max(math.floor(u1), 0), n - 1)
    last_row = min(max(math.floor(v1), 0), n - 1)
    squeezes = room_at(route, row, column, level) != ROOMY
    step_column = 1 if u1 > u0 else -1
    step_row = 1 if v1 > v0 else -1
    size_u = abs(u1 - u0)
    size_v = abs(v1 - v0)
    next_u = (column + 1 - u0 if step_column > 0 else u0 - column) / size_u if size_u > 0.0 else 2.0
    next_v = (row + 1 - v0 if step_row > 0 else v0 - row) / size_v if size_v > 0.0 else 2.0
    steps = abs(last_column - column) + abs(last_row - row)
    # Metres of the way for each cell that it touches.
    length = math.hypot(size_u, size_v) * route.window.place[2] / max(steps, 1)
    gap = 0.0
    narrow = False
    for _ in range(steps):
        if row == last_row or (column != last_column and next_u < next_v):
            column += step_column
            next_u += 1.0 / size_u
        else:
            row += step_row
            next_v += 1.0 / size_v
        free, level, gap = enter(route, row, column, level, gap, length)
        if not free:
            return False
        if room_at(route, row, column, level) != ROOMY:
            narrow = True
    ends_narrow = room_at(route, row, column, level) != ROOMY
    return gap == 0.0 and (not narrow or squeezes or ends_narrow)
