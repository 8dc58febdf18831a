"""Letting feet leave the ground: in their turn, late, or out of turn (P1 3.2, 3.3)."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.reach import effector_world
from polypod.compute import kernel
from polypod.controller.feet import plan_foot, preferred_footprint, rest_offset
from polypod.controller.steering import PlanPose
from polypod.controller.swing import FASTEST_CATCH_UP, begin_swing, wished_progress
from polypod.environment.table import surface
from polypod.gait.needle import lift_phase, next_foot_to_lift, swing_progress
from polypod.math.quat import load_quat
from polypod.math.vec3 import Vec3, distance, load_vec3, store_vec3

# A leg stretched to this share of its longest may step out of turn, if it has stood for so many
# cycles and the creature hurries so much because its legs hold it back.
OUT_OF_TURN_STRETCH = 0.985
OUT_OF_TURN_STOOD = 0.3
OUT_OF_TURN_HURRY = 0.02
# Standing feet closer than this to their rest place stay, leg lengths.
IN_PLACE = 0.05
# Speeds below this, in leg lengths a pendulum time, are standing.
STILL = 1e-3
# A foot that finds no place looks farther and farther, up to so many times.
WIDEST_SEARCH = 2.6


@kernel
def is_moving(c: int, state: Any, tables: Any) -> bool:
    """Return whether the body moves or turns over the ground."""
    still = STILL * tables.leg_length / tables.pendulum_time
    turning = abs(state.turn_rate[c]) * tables.leg_length
    return abs(state.speed[c]) > still or turning > still


@kernel
def off_place(c: int, k: int, state: Any, tables: Any, settings: Any) -> bool:
    """Return whether a foot stands too far from its rest place under a standing body."""
    offset = rest_offset(c, k, state.heading[c], state, tables, settings)
    # Against what it asked for: what it could not have then is no reason to step for ever.
    gap_x = state.position[c, 0] + offset.x - state.foot_preferred[c, k, 0]
    gap_z = state.position[c, 2] + offset.z - state.foot_preferred[c, k, 2]
    return math.hypot(gap_x, gap_z) > IN_PLACE * tables.legs.length[k]


@kernel
def any_off_place(c: int, state: Any, tables: Any, settings: Any) -> bool:
    """Return whether the creature wishes to step: it moves, or a foot is off its rest place."""
    if is_moving(c, state, tables):
        return True
    for k in range(state.swinging.shape[1]):
        if off_place(c, k, state, tables, settings):
            return True
    return False


@kernel
def seconds_to_touchdown(c: int, k: int, state: Any) -> float:
    """Return the seconds until a foot that lifts now shall land."""
    extent = state.swing_extent[c, k]
    gone = swing_progress(state.needle[c], state.swing_start[c, k], extent)
    seconds: float = (1.0 - max(gone, 0.0)) * extent / state.cycle_rate[c]
    return seconds


@kernel
def try_lift(
    c: int, k: int, dt: float, begun: float, seconds: float, pose: PlanPose, state: Any,
    command: Any, tables: Any, settings: Any, env: Any, plan_settings: Any, scratch: Any,
) -> bool:  # fmt: skip
    """Lift a foot if it finds a place and a way there in `seconds`; else note its wish."""
    radius = settings.search_radius * tables.legs.length[k]
    waited = state.waiting[c, k] * state.cycle_rate[c]
    radius *= min(1.0 + waited * settings.wider_search, WIDEST_SEARCH)
    preferred = preferred_footprint(c, k, pose, seconds, state, command, tables, settings)
    if plan_foot(
        c, k, dt, pose, preferred, seconds, Vec3(0.0, 0.0, 0.0), 0.0, radius,
        state, command, tables, settings, env, plan_settings, scratch,
    ):  # fmt: skip
        state.swinging[c, k] = True
        state.airborne[c, k] = 0.0
        begin_swing(c, k, begun, 0.0, state, scratch)
        state.waiting[c, k] = 0.0
        return True
    state.waiting[c, k] += dt
    height, _ = surface(env, preferred.x, preferred.z)
    store_vec3(state.wish[c, k], Vec3(preferred.x, height, preferred.z))
    return False


@kernel
def lift_feet(
    c: int, dt: float, turn: float, pose: PlanPose, state: Any, command: Any, tables: Any,
    settings: Any, env: Any, plan_settings: Any, scratch: Any,
) -> None:  # fmt: skip
    """Let the feet whose sector the needle has entered leave the ground, if they find a place.

    A foot may lift late, inside a window of its disk; never where that would leave fewer feet down
    than the gait's own minimum. One that finds no place holds its own and looks farther next time.
    `turn` is how far the needle turned in this step, cycles.
    """
    moving = is_moving(c, state, tables)
    # Feet that land in this step count as standing already, so that feet can change places.
    landing = turn
    for k in range(state.swinging.shape[1]):
        scratch.held[k] = not moving and not off_place(c, k, state, tables, settings)
        gone = swing_progress(state.needle[c], state.swing_start[c, k], state.swing_extent[c, k])
        if state.swinging[c, k] and gone < 0.0 and wished_progress(c, k, dt, state) < 1.0:
            landing = 0.0
    while True:
        k = next_foot_to_lift(
            state.needle[c], state.swing_start[c], state.swing_extent[c], state.swinging[c],
            state.stood[c], scratch.held, state.least_down[c], settings.late_lift, landing,
        )  # fmt: skip
        if k < 0:
            break
        scratch.held[k] = True
        try_lift(
            c, k, dt, lift_phase(state.needle[c], turn, state.swing_start[c, k]),
            seconds_to_touchdown(c, k, state), pose, state, command, tables, settings, env,
            plan_settings, scratch,
        )  # fmt: skip
    lift_out_of_turn(
        c, dt, pose, state, command, tables, settings, env, plan_settings, scratch
    )  # fmt: skip


@kernel
def lift_out_of_turn(
    c: int, dt: float, pose: PlanPose, state: Any, command: Any, tables: Any,
    settings: Any, env: Any, plan_settings: Any, scratch: Any,
) -> None:  # fmt: skip
    """Let the one foot that most holds the body back take a quick step outside of its sector.

    That is a foot whose leg is stretched to its end, on a body that its legs have slowed down: it
    missed its turn because it found no place then. Where too few feet are down it must wait.
    """
    if state.hurry[c] < OUT_OF_TURN_HURRY:
        return
    down = 0
    # No foot: not a literal, or all that is called with it would be compiled twice.
    count = state.swinging.shape[1]
    worst = count
    most = OUT_OF_TURN_STRETCH
    for k in range(count):
        if state.swinging[c, k]:
            continue
        down += 1
        if scratch.held[k] or state.stood[c, k] < OUT_OF_TURN_STOOD:
            continue
        foot_turn = load_quat(state.foot_rotation[c, k])
        effector = effector_world(k, tables, load_vec3(state.foot[c, k]), foot_turn)
        hip = load_vec3(state.joint_position[c, tables.legs.joint[k, 0]])
        stretch = distance(effector, hip) / tables.ik.longest[k]
        if stretch > most:
            most = stretch
            worst = k
    if worst == count or down <= state.least_down[c]:
        return
    seconds = state.swing_extent[c, worst] / (FASTEST_CATCH_UP * state.cycle_rate[c])
    try_lift(
        c, worst, dt, state.needle[c], seconds, pose, state, command, tables, settings, env,
        plan_settings, scratch,
    )  # fmt: skip
