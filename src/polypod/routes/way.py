"""A creature's way to its waypoint, looked for anew now and then: corners that steering follows.

A way goes to the waypoint where that is in the map and reached. Where it is not reached, but may be
by a way that leaves the map, the way leads to the map's border; and where there is no way at all,
to the place nearest to it, where the creature stops.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.footprints.place import LOWEST
from polypod.footprints.settings import PlanSettings
from polypod.paths.near import obstacles_near
from polypod.routes.ends import best_end, nearest_place, note_astray, reaches_border
from polypod.routes.passable import CELL, ROOMY, SQUEEZE, enter, fill_passable, room_at, sees
from polypod.routes.state import ROUTE_CELLS, ROUTE_CORNERS, RouteScratch
from polypod.routes.wave import spread, trace

# Leg pendulum times after which a way is looked for again, and before which it never is.
LOOK_AGAIN = 5.0
SOONEST = 1.0
# A waypoint that moved by so many leg lengths is another one; one so near is reached.
MOVED = 0.5
# Who has gone less, leg lengths, where nothing moves and no way led on, need not look again.
STILL = 0.1
# A creature that stands where nobody fits looks for a free place within so many cells.
OUT_OF_THE_WAY = 10
# So many cells beyond one out of sight are looked at for the next corner: the widest gap and more.
BEYOND = 8


@kernel
def write_corners(
    c: int, route: RouteScratch, count: int, u: float, v: float, to_u: float, to_v: float,
    level: float, track: float, ways: Any,
) -> None:  # fmt: skip
    """Add to the way those of the `count` traced cells between which there is no line of sight.

    From (u, v) on ground of height `level`, to the place (to_u, to_v) in the last of them, which is
    left out: it is where the way leads. Where it squeezes, less of the `track` is kept free.
    """
    place = route.window.place
    at = count - 1
    corners = ways.corner_count[c]
    while at > 0 and corners < ROUTE_CORNERS:
        chosen = at - 1
        ahead = at - 2
        unseen = 0
        while ahead >= 0 and unseen < BEYOND:
            look_u = to_u if ahead == 0 else route.cells[ahead, 1] + 0.5
            look_v = to_v if ahead == 0 else route.cells[ahead, 0] + 0.5
            unseen += 1
            if sees(route, u, v, look_u, look_v, level):
                chosen = ahead
                unseen = 0
            ahead -= 1
        at = chosen
        row = route.cells[at, 0]
        column = route.cells[at, 1]
        if at == 0:
            break
        u = column + 0.5
        v = row + 0.5
        level = route.level[row, column]
        ways.corner_place[c, corners, 0] = place[0] + u * place[2]
        ways.corner_place[c, corners, 1] = place[1] + v * place[2]
        corners += 1
    ways.corner_count[c] = corners
    for k in range(count):
        row = route.cells[k, 0]
        column = route.cells[k, 1]
        if room_at(route, row, column, route.level[row, column]) != ROOMY:
            ways.margin[c] = SQUEEZE * track


@kernel
def add_corner(c: int, route: RouteScratch, row: int, column: int, ways: Any) -> None:
    """Add a cell's middle to the way, if there is room."""
    corners = ways.corner_count[c]
    if corners < ROUTE_CORNERS:
        place = route.window.place
        ways.corner_place[c, corners, 0] = place[0] + (column + 0.5) * place[2]
        ways.corner_place[c, corners, 1] = place[1] + (row + 0.5) * place[2]
        ways.corner_count[c] = corners + 1


@kernel
def find_way(c: int, goal: Any, state: Any, tables: Any, route: RouteScratch) -> None:
    """Write a creature's way to a place [x, z] over the map that `fill_passable` has filled."""
    ways = state.route
    n = route.window.size[0]
    place = route.window.place
    leg = tables.leg_length
    x = state.position[c, 0]
    z = state.position[c, 2]
    u = (x - place[0]) / place[2]
    v = (z - place[1]) / place[2]
    # The goal, or where the straight way to it leaves the map.
    share = min(1.0, (0.5 * n - 1.5) / max(abs(goal[0] - x), abs(goal[1] - z), 1e-9) * place[2])
    inside = share >= 1.0
    to_u = u + (goal[0] - x) / place[2] * share
    to_v = v + (goal[1] - z) / place[2] * share
    level = state.plane_height[c]
    row = int(v)
    column = int(u)
    free, _, _ = enter(route, row, column, level, 0.0, 0.0)
    if free and sees(route, u, v, to_u, to_v, level):
        ways.astray[c] = 0.0
        return
    if not free:
        row, column = nearest_place(route, row, column, OUT_OF_THE_WAY, level, route.limit[0])
        if row < 0:
            return
        level = route.window.highest[row, column]
        add_corner(c, route, row, column, ways)
        u = column + 0.5
        v = row + 0.5
    goal_row = int(to_v)
    goal_column = int(to_u)
    goal_u = (goal[0] - place[0]) / place[2]
    goal_v = (goal[1] - place[1]) / place[2]
    ground = route.window.highest[goal_row, goal_column]
    fits, _, _ = enter(route, goal_row, goal_column, ground, 0.0, math.inf)
    exact = inside and fits
    to_row = goal_row
    to_column = goal_column
    if not fits:
        to_row, to_column = nearest_place(route, goal_row, goal_column, n, 0.0, math.inf)
    spread(route, row, column, level, to_row, to_column)
    if to_row >= 0 and route.distance[to_row, to_column] >= 0:
        if inside and not exact:
            # The goal lies where nobody fits: as near to it as there is a way.
            spread(route, row, column, level, -1, -1)
            to_row, to_column = best_end(c, route, goal_u, goal_v, False, ways)
            ways.ends[c] = True
    else:
        exact = False
        leaves = note_astray(c, x, z, goal, leg, ways)
        if leaves and inside and to_row >= 0:
            # Only what is not walled in can be reached from outside of the map.
            ground = route.window.highest[to_row, to_column]
            spread(route, to_row, to_column, ground, -1, -1)
            leaves = reaches_border(route)
            spread(route, row, column, level, -1, -1)
        leaves = leaves and reaches_border(route)
        to_row, to_column = best_end(c, route, goal_u, goal_v, leaves, ways)
        ways.ends[c] = not leaves
        ways.astray[c] = max(ways.astray[c], 1e-9 * leg) if leaves else 0.0
    if to_row < 0:
        # Nothing but squeezes around: it stays where it is.
        to_row = row
        to_column = column
    if not exact:
        to_u = to_column + 0.5
        to_v = to_row + 0.5
    count = trace(route, to_row, to_column)
    write_corners(c, route, count, u, v, to_u, to_v, level, tables.track, ways)
    if not exact:
        add_corner(c, route, to_row, to_column, ways)


@kernel
def keep_way(
    c: int, dt: float, state: Any, command: Any, tables: Any, env: Any,
    plan_settings: PlanSettings, route: RouteScratch,
) -> None:  # fmt: skip
    """Look for a creature's way anew where that is due: another goal, all corners passed, or time.

    Never sooner than after a leg's pendulum time, so that a goal that moves costs no more.
    """
    ways = state.route
    waypoint = state.waypoint[c]
    goal = command.waypoints[c, waypoint]
    leg = tables.leg_length
    x = state.position[c, 0]
    z = state.position[c, 2]
    ways.clock[c] += dt
    late = ways.clock[c] / tables.pendulum_time
    moved = math.hypot(goal[0] - ways.goal[c, 0], goal[1] - ways.goal[c, 1]) > MOVED * leg
    anew = moved or ways.waypoint[c] != waypoint
    passed = 0 < ways.corner_count[c] <= ways.corner[c] and not ways.ends[c]
    first = ways.waypoint[c] < 0
    if not first and late < (SOONEST if anew or passed else LOOK_AGAIN):
        return
    away = math.hypot(goal[0] - x, goal[1] - z)
    gone = math.hypot(x - ways.looked_from[c, 0], z - ways.looked_from[c, 1])
    arrived = ways.corner_count[c] == 0 and away < MOVED * leg
    waits = ways.ends[c] and gone < STILL * leg and env.mover_count == 0
    if not anew and (arrived or waits):
        return
    # Creatures that set out together do not all look again in the same frame.
    ways.clock[c] = 0.25 * LOOK_AGAIN * tables.pendulum_time * ((c * 0.618033988749895) % 1.0)
    ways.waypoint[c] = waypoint
    ways.corner_count[c] = 0
    ways.corner[c] = 0
    ways.ends[c] = False
    ways.margin[c] = tables.track
    if anew:
        ways.astray[c] = 0.0
    for axis in range(2):
        ways.goal[c, axis] = goal[axis]
    half = 0.5 * ROUTE_CELLS * CELL * leg
    beside = tables.track + leg
    x1 = min(max(goal[0], x - half), x + half)
    z1 = min(max(goal[1], z - half), z + half)
    flat = env.terrain_range[0] == env.terrain_range[1] and env.water.shape[0] == 0
    bad = ways.bad_count[c] > 0
    if bad or not flat or obstacles_near(
        env, min(x, x1) - beside, min(z, z1) - beside, max(x, x1) + beside, max(z, z1) + beside,
        LOWEST, route.near,
    ) > 0:  # fmt: skip
        fill_passable(c, env, route, state, tables, plan_settings)
        find_way(c, goal, state, tables, route)
    ways.looked_from[c, 0] = x
    ways.looked_from[c, 1] = z


@kernel
def keep_ways(
    first: int, last: int, dt: float, state: Any, command: Any, tables: Any, settings: Any,
    env: Any, plan_settings: PlanSettings, scratch: Any,
) -> None:  # fmt: skip
    """Keep the ways of those creatures that follow waypoints."""
    for c in range(first, last):
        if command.waypoint_count[c] > 0:
            keep_way(c, dt, state, command, tables, env, plan_settings, scratch.route)
