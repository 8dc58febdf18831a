"""Where a creature's way leads: the next corner, or the waypoint itself."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from polypod.compute import kernel

# A waypoint counts as reached within this many leg lengths, so that a corner is cut, not circled.
WAYPOINT_RADIUS = 0.5
# A corner of the way there is a turn about something: it is cut less.
CORNER_RADIUS = 0.25


class Aim(NamedTuple):
    """Where the way leads from a place."""

    to_x: float  # m from there, world
    to_z: float
    waypoint: int  # being approached
    corner: int  # being approached, the number of corners where it is the waypoint itself
    corners: int
    stops: bool  # the way ends there


@kernel
def aim_at(x: float, z: float, waypoint: int, corner: int, c: int, state: Any, command: Any) -> Aim:
    """Return where the way leads from a place, the next corner or the waypoint itself."""
    ways = state.route
    corners = 0
    ends = False
    if ways.waypoint[c] == waypoint:
        corners = ways.corner_count[c]
        ends = ways.ends[c]
    corner = min(corner, corners - 1 if ends else corners)
    if corner < corners:
        to_x = ways.corner_place[c, corner, 0] - x
        to_z = ways.corner_place[c, corner, 1] - z
        return Aim(to_x, to_z, waypoint, corner, corners, ends and corner == corners - 1)
    to_x = command.waypoints[c, waypoint, 0] - x
    to_z = command.waypoints[c, waypoint, 1] - z
    return Aim(to_x, to_z, waypoint, corners, corners, waypoint == command.waypoint_count[c] - 1)


@kernel
def next_aim(
    x: float, z: float, waypoint: int, corner: int, c: int, state: Any, command: Any, tables: Any
) -> Aim:
    """Return where the way leads from a place; a waypoint or a corner that is reached is left."""
    aim = aim_at(x, z, waypoint, corner, c, state, command)
    away = math.hypot(aim.to_x, aim.to_z)
    if aim.stops:
        return aim
    if aim.corner < aim.corners:
        if away < CORNER_RADIUS * tables.leg_length:
            return aim_at(x, z, aim.waypoint, aim.corner + 1, c, state, command)
    elif away < WAYPOINT_RADIUS * tables.leg_length:
        return aim_at(x, z, aim.waypoint + 1, 0, c, state, command)
    return aim


@kernel
def way_left(x: float, z: float, aim: Aim, c: int, state: Any, command: Any) -> float:
    """Return the length of the way on from a point, over corners and waypoints, metres."""
    total = 0.0
    ways = state.route
    for i in range(aim.corner, aim.corners):
        to_x = ways.corner_place[c, i, 0]
        to_z = ways.corner_place[c, i, 1]
        total += math.hypot(to_x - x, to_z - z)
        x = to_x
        z = to_z
    if aim.corners > 0 and ways.ends[c]:
        return total
    for i in range(aim.waypoint, command.waypoint_count[c]):
        to_x = command.waypoints[c, i, 0]
        to_z = command.waypoints[c, i, 1]
        total += math.hypot(to_x - x, to_z - z)
        x = to_x
        z = to_z
    return total
