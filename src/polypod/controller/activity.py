"""What a creature is doing, noted at the end of each step."""

from __future__ import annotations

import math
from typing import Any

from polypod.activity import ARRIVED, BLOCKED, STANDING, WAITING, WALKING
from polypod.compute import kernel
from polypod.controller.lift import is_moving
from polypod.routes.aim import WAYPOINT_RADIUS, aim_at


@kernel
def note_activity(c: int, state: Any, command: Any, tables: Any) -> None:
    """Write what a creature is doing at the end of a step."""
    waits = command.speed[c] > 0.0
    walks = is_moving(c, state, tables)
    for k in range(state.swinging.shape[1]):
        if not state.reaching[c, k]:
            walks = walks or state.swinging[c, k]
            waits = waits or state.waiting[c, k] > 0.0
    state.activity[c] = STANDING
    if walks:
        state.activity[c] = WALKING
    elif command.waypoint_count[c] > 0:
        x = state.position[c, 0]
        z = state.position[c, 2]
        waypoint = state.waypoint[c]
        to_x = command.waypoints[c, waypoint, 0] - x
        to_z = command.waypoints[c, waypoint, 1] - z
        aim = aim_at(x, z, waypoint, state.route.corner[c], c, state, command)
        if aim.stops and math.hypot(to_x, to_z) <= WAYPOINT_RADIUS * tables.leg_length:
            state.activity[c] = ARRIVED
        elif aim.stops and aim.corner < aim.corners:
            state.activity[c] = BLOCKED
        elif waits:
            state.activity[c] = WAITING
    elif waits:
        state.activity[c] = WAITING
