"""Lifting a foot, carrying it along its path, planning it anew when its world changed."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.reach import effector_world
from polypod.compute import kernel
from polypod.controller.feet import plan_foot, preferred_footprint, rest_offset
from polypod.controller.steering import PlanPose
from polypod.environment.table import surface
from polypod.gait.needle import (
    lift_phase,
    next_foot_to_lift,
    progress_since_lift,
    swing_progress,
)
from polypod.math.quat import Quat, load_quat, slerp
from polypod.math.vec3 import Vec3, distance, length_plan, load_vec3, store_vec3
from polypod.paths.curve import PROFILE_BELL, path_point, path_row, path_velocity
from polypod.paths.curve import swing_progress as progress_on_path

# A late or replanned swing may run at most so many times as fast as its disk says.
FASTEST_CATCH_UP = 2.0
# Nor is a swing shorter than this share of its sector.
SHORTEST_SWING = 0.15
# A leg stretched to this share of its longest may step out of turn, if it has stood for so many
# cycles and the creature hurries so much because its legs hold it back.
OUT_OF_TURN_STRETCH = 0.985
OUT_OF_TURN_STOOD = 0.3
OUT_OF_TURN_HURRY = 0.02
# Standing feet closer than this to their rest place stay, leg lengths.
IN_PLACE = 0.05
# Speeds below this, in leg lengths a pendulum time, are standing.
STILL = 1e-3
# A swing that has gone less than this since its plan is planned anew only for so much more.
SETTLED = 0.25
UNSETTLED = 3.0
# So does one whose leg could not follow its way for so many cycles.
HELD_UP = 0.2
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
    for k in range(state.swinging.shape[1]):
        scratch.held[k] = not moving and not off_place(c, k, state, tables, settings)
    while True:
        k = next_foot_to_lift(
            state.needle[c], state.swing_start[c], state.swing_extent[c], state.swinging[c],
            state.stood[c], scratch.held, state.least_down[c], settings.late_lift,
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
    worst = -1
    most = OUT_OF_TURN_STRETCH
    for k in range(state.swinging.shape[1]):
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
    if worst < 0 or down <= state.least_down[c]:
        return
    seconds = state.swing_extent[c, worst] / (FASTEST_CATCH_UP * state.cycle_rate[c])
    try_lift(
        c, worst, dt, state.needle[c], seconds, pose, state, command, tables, settings, env,
        plan_settings, scratch,
    )  # fmt: skip


@kernel
def begin_swing(c: int, k: int, begun: float, launch: float, state: Any, scratch: Any) -> None:
    """Put a foot on the path just planned, whose time begins at the needle's phase `begun`."""
    trial = scratch.path
    kept = path_row(state.path, c, k)
    kept.count[0] = trial.count[0]
    kept.length[0] = trial.length[0]
    for i in range(trial.count[0]):
        kept.fraction[i] = trial.fraction[i]
        for axis in range(3):
            kept.point[i, axis] = trial.point[i, axis]
            kept.tangent[i, axis] = trial.tangent[i, axis]
    for axis in range(3):
        state.foot_start[c, k, axis] = state.foot[c, k, axis]
    for axis in range(4):
        state.foot_rotation_start[c, k, axis] = state.foot_rotation[c, k, axis]
    state.lift_phase[c, k] = begun
    state.swing_progress[c, k] = 0.0
    state.path_launch[c, k] = launch


@kernel
def swing_pace(c: int, k: int, state: Any) -> float:
    """Return the progress a second that a foot's disk asks of its present swing."""
    start = state.swing_start[c, k]
    begun = swing_progress(state.lift_phase[c, k], start, state.swing_extent[c, k])
    # However late it was planned, it takes a fair part of a swing's time.
    span = max(1.0 - max(begun, 0.0), SHORTEST_SWING) * state.swing_extent[c, k]
    pace: float = state.cycle_rate[c] / span
    return pace


@kernel
def swing_time_left(c: int, k: int, state: Any) -> float:
    """Return the seconds until touchdown: by the disk, or at a late foot's fastest pace."""
    needle = state.needle[c]
    gone = swing_progress(needle, state.swing_start[c, k], state.swing_extent[c, k])
    left = 0.0
    if gone >= 0.0:
        left = (1.0 - gone) * state.swing_extent[c, k] / state.cycle_rate[c]
    late = (1.0 - state.swing_progress[c, k]) / (FASTEST_CATCH_UP * swing_pace(c, k, state))
    return float(max(left, late))


@kernel
def replan_feet(
    c: int, dt: float, pose: PlanPose, state: Any, command: Any, tables: Any, settings: Any,
    env: Any, plan_settings: Any, scratch: Any,
) -> None:  # fmt: skip
    """Plan swinging feet anew whose preferred place has moved, or whose body holds them back.

    Position and velocity are continuous at the join: the new path starts along the present
    velocity and is launched at the present speed.
    """
    for k in range(state.swinging.shape[1]):
        if not state.swinging[c, k] or state.swing_progress[c, k] > settings.replan_until:
            continue
        left = swing_time_left(c, k, state)
        preferred = preferred_footprint(c, k, pose, left, state, command, tables, settings)
        moved = length_plan(preferred - load_vec3(state.foot_preferred[c, k]))
        # Planned anew in every frame, a foot would for ever be at the slow start of its way.
        wanted = 1.0 if state.swing_progress[c, k] > SETTLED else UNSETTLED
        held_up = state.waiting[c, k] * state.cycle_rate[c] > HELD_UP
        if moved <= wanted * settings.replan_distance * tables.legs.length[k] and not held_up:
            continue
        row = path_row(state.path, c, k)
        along, rate = progress_on_path(
            PROFILE_BELL, state.swing_progress[c, k], state.path_launch[c, k]
        )
        # Per unit of the old swing; the new one takes the share that is left.
        share = 1.0 - state.swing_progress[c, k]
        velocity = path_velocity(row.point, row.tangent, row.fraction, row.count[0], along) * (
            rate * share
        )
        # The new path's length is not known yet: about what is left of the old one.
        launch = rate * share / max(1.0 - along, 0.1)
        speed = rate * share * row.length[0]
        radius = settings.search_radius * tables.legs.length[k]
        if plan_foot(
            c, k, dt, pose, preferred, left, velocity, launch, radius,
            state, command, tables, settings, env, plan_settings, scratch,
        ):  # fmt: skip
            launch = speed / max(scratch.path.length[0], 1e-12)
            begin_swing(c, k, state.needle[c], launch, state, scratch)
            state.waiting[c, k] = 0.0


@kernel
def wished_progress(c: int, k: int, dt: float, state: Any) -> float:
    """Return how far along its swing a foot should be by now, its catching up bounded."""
    wished = progress_since_lift(
        state.needle[c], state.lift_phase[c, k], state.swing_start[c, k], state.swing_extent[c, k]
    )
    now = state.swing_progress[c, k]
    most = now + FASTEST_CATCH_UP * swing_pace(c, k, state) * dt
    return float(min(1.0, max(now, min(wished, most))))


@kernel
def foot_along(c: int, k: int, progress: float, state: Any) -> tuple[Vec3, Quat]:
    """Return the sole and the foot's orientation at a share of the swing's time."""
    row = path_row(state.path, c, k)
    along, _ = progress_on_path(PROFILE_BELL, progress, state.path_launch[c, k])
    sole = path_point(row.point, row.tangent, row.fraction, row.count[0], along)
    turn = slerp(
        load_quat(state.foot_rotation_start[c, k]),
        load_quat(state.foot_rotation_target[c, k]),
        along,
    )
    return sole, turn


@kernel
def shift_spacing(c: int, dt: float, state: Any, command: Any, tables: Any, settings: Any) -> None:
    """Move each foot's rest place to the wished one at a set rate (P1 Fig 6)."""
    for k in range(state.swinging.shape[1]):
        most = settings.spacing_rate * tables.legs.length[k] * dt
        for axis in range(2):
            gap = command.spacing[c, k, axis] - state.spacing[c, k, axis]
            state.spacing[c, k, axis] += min(most, max(-most, gap))
