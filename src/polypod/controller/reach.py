"""A leg out of the gait: its foot goes where a higher controller sends it (P1 7)."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.reach import shift_as_it_is
from polypod.compute import kernel
from polypod.controller.rest import rest_offset
from polypod.controller.roll import begin_roll
from polypod.math.quat import load_quat
from polypod.math.vec3 import Vec3, length, load_vec3, store_vec3

# A reaching foot makes up its way in about so many leg pendulum times, and moves at most at so many
# leg lengths in one.
REACH_TIME = 1.0
FASTEST_REACH = 1.5


@kernel
def note_reaching(c: int, state: Any, command: Any, tables: Any, settings: Any) -> None:
    """Take legs out of the gait as asked, and let one that was put back swing to its place.

    To the body a reaching foot counts as standing at its rest place: it neither lifts nor tilts it.
    """
    for k in range(state.swinging.shape[1]):
        if not command.reaching[c, k]:
            state.reaching[c, k] = False
            continue
        if not state.reaching[c, k]:
            state.reaching[c, k] = True
            state.swinging[c, k] = True
            state.airborne[c, k] = 0.0
        offset = rest_offset(c, k, state.heading[c], state, tables, settings)
        x = state.position[c, 0] + offset.x
        z = state.position[c, 2] + offset.z
        place = Vec3(x, state.plane_height[c], z)
        store_vec3(state.foot_start[c, k], place)
        store_vec3(state.foot_target[c, k], place)
        store_vec3(state.foot_preferred[c, k], place)
        # What a put back leg begins with: a swing at its start, that wants a way.
        state.swing_progress[c, k] = 0.0
        begin_roll(c, k, 1.0 / tables.pendulum_time, state)
        state.path_launch[c, k] = 0.0
        state.waiting[c, k] = math.inf
        state.landing_support[c, k] = -1


@kernel
def reach_feet(c: int, dt: float, state: Any, command: Any, tables: Any) -> None:
    """Move the reaching feet toward their places, as far as their legs reach from the body."""
    position = load_vec3(state.position[c])
    turn = load_quat(state.rotation[c])
    share = 1.0 - math.exp(-4.0 * dt / (REACH_TIME * tables.pendulum_time))
    for k in range(state.swinging.shape[1]):
        if not state.reaching[c, k]:
            continue
        foot = load_vec3(state.foot[c, k])
        step = (load_vec3(command.reach_place[c, k]) - foot) * share
        most = FASTEST_REACH * tables.legs.length[k] / tables.pendulum_time * dt
        foot = foot + step * (min(length(step), most) / max(length(step), 1e-12))
        foot = foot + shift_as_it_is(c, k, foot, state, tables, position, turn)
        store_vec3(state.foot[c, k], foot)
