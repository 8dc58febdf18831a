"""Balance steps: feet that can, step to where they catch a pushed body (P2 7, its future work).

Where a foot lands and how quickly it steps needs nothing of its own: both ask `predict`, which
knows of the push. What is decided here is which foot goes before its turn.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.body.push import Deflection, hold_back, is_thrown, load_deflection
from polypod.body.reach import pitched, shift_as_it_is, shift_in_frame
from polypod.body.support import body_rotation
from polypod.compute import kernel
from polypod.controller.lift import feet_needed
from polypod.controller.rest import body_height_at
from polypod.controller.steering import PlanPose, predict
from polypod.gait.needle import swing_progress
from polypod.math.intervals import wrap_phase
from polypod.math.quat import load_quat
from polypod.math.vec3 import Vec3, length, load_vec3
from polypod.spine.frames import leg_frame_at

# Standing legs are looked at in so many moments until their turn comes or the body is caught.
MOMENTS = 3
# A leg that will be too short or too long by so much, leg lengths, steps at once, if it has stood
# for so many cycles.
NEED = 0.02
STOOD = 0.15
# A body that is thrown looks so many leg lengths ahead for the end of its legs, in so many halvings
# of the way, by so many leg lengths closely; it stops there in about so many pendulum times.
FAR = 0.6
HALVINGS = 6
AT_END = 1e-3
BRACE = 0.25


@kernel
def room_aside(c: int, ahead_x: float, ahead_z: float, state: Any, tables: Any) -> float:
    """Return how far, m, its standing feet let a body go in a direction on the plane."""
    place = load_vec3(state.position[c])
    turn = load_quat(state.rotation[c])
    tolerance = AT_END * tables.leg_length
    least = 0.0
    most = FAR * tables.leg_length
    for halving in range(HALVINGS):
        # The whole of it first: most often there is room.
        way = most if halving == 0 else 0.5 * (least + most)
        there = place + Vec3(ahead_x * way, 0.0, ahead_z * way)
        fits = True
        for k in range(state.swinging.shape[1]):
            if state.swinging[c, k] or not fits:
                continue
            sole = load_vec3(state.foot[c, k])
            shift = shift_as_it_is(c, k, sole, state, tables, there, turn)
            fits = length(shift) <= tolerance
        if fits and halving == 0:
            return float(way)
        if fits:
            least = way
        else:
            most = way
    return float(least)


@kernel
def brace(c: int, dt: float, aside: Deflection, state: Any, tables: Any) -> Deflection:
    """Return where a push leads a body in a step, braked by legs that come to their end.

    It nears what they reach ever slower, and its velocity dies away meanwhile; once feet have
    stepped it goes on with what is left.
    """
    was = load_deflection(c, state)
    move_x = aside.x - was.x
    move_z = aside.z - was.z
    move = math.hypot(move_x, move_z)
    if move <= AT_END * AT_END * tables.leg_length:
        return aside
    room = room_aside(c, move_x / move, move_z / move, state, tables)
    most = room * (1.0 - math.exp(-dt / (BRACE * tables.pendulum_time)))
    share = max(1.0 - most / move, 0.0)
    return hold_back(was, aside, share * move_x, share * move_z, 1.0, 0.0, 0.0, dt, tables)


@kernel
def overreach(
    c: int, k: int, horizon: float, pose: PlanPose, state: Any, command: Any, tables: Any,
    settings: Any,
) -> float:  # fmt: skip
    """Return by how much, m, a standing leg will be too short or too long within some seconds."""
    sole = load_vec3(state.foot[c, k])
    most = 0.0
    for i in range(1, MOMENTS + 1):
        then = predict(pose, horizon * i / MOMENTS, c, state, command, tables, settings)
        place = Vec3(then.x, body_height_at(c, then.x, then.z, state), then.z)
        turn = body_rotation(then.heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
        place, turn = leg_frame_at(c, k, place, turn, then, state, tables)
        foot_turn = pitched(load_quat(state.foot_rotation[c, k]), state.foot_pitch[c, k, 0])
        bend = state.foot_bend[c, k, 0]
        shift = shift_in_frame(k, tables, sole, foot_turn, bend, place, turn)
        most = max(most, length(shift))
    return most


@kernel
def foot_to_catch_with(
    c: int, pose: PlanPose, state: Any, command: Any, tables: Any, settings: Any, scratch: Any
) -> int:
    """Return the standing foot that must step before its turn, for the body is pushed away from it.

    That is the one whose leg will be farthest beyond its reach before the gait has it step. As many
    as feet: none, also where too few feet are down: then what is in the air lands first.
    """
    count = state.swinging.shape[1]
    if not is_thrown(pose.aside, tables):
        return int(count)
    down = 0
    for k in range(count):
        if not state.swinging[c, k]:
            down += 1
    if down <= feet_needed(c, state) or state.cycle_rate[c] <= 0.0:
        return int(count)
    worst = count
    most = NEED * tables.leg_length
    for k in range(count):
        if state.swinging[c, k] or scratch.held[k] or state.stood[c, k] < STOOD:
            continue
        until = wrap_phase(state.swing_start[c, k] - state.needle[c]) / state.cycle_rate[c]
        horizon = min(until, 1.0 / tables.recovery)
        need = overreach(c, k, horizon, pose, state, command, tables, settings)
        if need > most:
            most = need
            worst = k
    return int(worst)


@kernel
def is_due(c: int, k: int, state: Any, settings: Any) -> bool:
    """Return whether the needle is where a foot may lift in its turn; of no foot it is not."""
    if k >= state.swinging.shape[1]:
        return False
    extent = state.swing_extent[c, k]
    gone = swing_progress(state.needle[c], state.swing_start[c, k], extent)
    return bool(0.0 <= gone < settings.late_lift)
