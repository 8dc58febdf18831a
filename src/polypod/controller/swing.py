"""Carrying a foot along its path, and planning it anew when its world changed."""

from __future__ import annotations

from typing import Any

from polypod.body.push import is_thrown, load_deflection
from polypod.compute import kernel
from polypod.controller.errand import Errand
from polypod.environment.placing import world_point
from polypod.gait.needle import progress_since_lift, swing_progress
from polypod.math.quat import Quat, load_quat, slerp
from polypod.math.vec3 import Vec3, length_plan, load_vec3, store_vec3
from polypod.paths.curve import path_point, path_row, path_velocity
from polypod.paths.curve import swing_progress as progress_on_path

# A late or replanned swing may run at most so many times as fast as its disk says.
FASTEST_CATCH_UP = 2.0
# Nor is a swing shorter than this share of its sector.
SHORTEST_SWING = 0.15
# A swing that has gone less than this since its plan is planned anew only for so much more.
SETTLED = 0.25
UNSETTLED = 3.0
# One whose leg could not follow its way for so many cycles plans anew.
HELD_UP = 0.2


@kernel
def begin_swing(
    c: int, k: int, begun: float, launch: float, state: Any, settings: Any, scratch: Any
) -> None:
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
    over = state.swing_begun[c, k]
    state.swing_begun[c, k] = over + (1.0 - over) * state.swing_progress[c, k]
    state.swing_progress[c, k] = 0.0
    state.path_launch[c, k] = launch
    state.path_profile[c, k] = int(settings.swing_profile)


@kernel
def along_path(c: int, k: int, progress: float, state: Any) -> tuple[float, float]:
    """Return how far along its path a foot is at a share of its swing's time, and the rate."""
    return progress_on_path(state.path_profile[c, k], progress, state.path_launch[c, k])


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
    begun = swing_progress(
        state.lift_phase[c, k], state.swing_start[c, k], state.swing_extent[c, k]
    )
    if gone >= 0.0 and begun >= 0.0:
        left = (1.0 - gone) * state.swing_extent[c, k] / state.cycle_rate[c]
    late = (1.0 - state.swing_progress[c, k]) / (FASTEST_CATCH_UP * swing_pace(c, k, state))
    return float(max(left, late))


@kernel
def is_held_up(c: int, k: int, state: Any) -> bool:
    """Return whether a swinging foot's leg could not follow its way for a while."""
    return bool(state.waiting[c, k] * state.cycle_rate[c] > HELD_UP)


@kernel
def wishes_new_plan(
    c: int, k: int, preferred: Vec3, state: Any, tables: Any, settings: Any
) -> bool:
    """Return whether a swinging foot's preferred place has moved so far that it shall follow."""
    moved = length_plan(preferred - load_vec3(state.foot_preferred[c, k]))
    # Planned anew in every frame, a foot would for ever be at the slow start of its way.
    # A thrown body is braked otherwise than foreseen, in every frame.
    thrown = is_thrown(load_deflection(c, state), tables)
    settled = state.swing_progress[c, k] > SETTLED and not thrown
    wanted = 1.0 if settled else UNSETTLED
    return moved > wanted * settings.replan_distance * tables.legs.length[k]


@kernel
def way_on(c: int, k: int, preferred: Vec3, left: float, radius: float, state: Any) -> Errand:
    """Return what a swinging foot is to do from here on, in the `left` seconds of its swing.

    Position and velocity are continuous at the join: the new path starts along the present
    velocity and is launched at the present speed.
    """
    row = path_row(state.path, c, k)
    along, rate = along_path(c, k, state.swing_progress[c, k], state)
    # Per unit of the old swing; the new one takes the share that is left.
    share = 1.0 - state.swing_progress[c, k]
    velocity = path_velocity(row.point, row.tangent, row.fraction, row.count[0], along) * (
        rate * share
    )
    # The new path's length is not known yet: about what is left of the old one.
    launch = rate * share / max(1.0 - along, 0.1)
    return Errand(preferred, left, velocity, launch, radius)


@kernel
def take_new_way(
    c: int, k: int, launch: float, counted: Vec3, state: Any, settings: Any, scratch: Any
) -> None:
    """Put a swinging foot on the path just planned, at the speed that it has.

    `launch` is what the path was planned with, by the length that was left of the old one, and
    `counted` where the foot counted as being for the body (`body.support.foot_on_its_way`): it goes
    on from there, or the body would bob by a foot that is planned anew in mid-air.
    """
    row = path_row(state.path, c, k)
    along, _ = along_path(c, k, state.swing_progress[c, k], state)
    speed = launch * max(1.0 - along, 0.1) * row.length[0]
    launch = speed / max(scratch.path.length[0], 1e-12)
    begin_swing(c, k, state.needle[c], launch, state, settings, scratch)
    store_vec3(state.foot_start[c, k], counted)
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
def drift(c: int, k: int, along: float, state: Any, env: Any) -> Vec3:
    """Return how far a foot is to be from its path, m, for what it lands on is not as foreseen.

    The path ends where that was foreseen to be at touchdown. What it has moved otherwise counts in
    proportion to the way, and what it will still move where the foot lands early or late, last.
    """
    support = state.landing_support[c, k]
    if support < 0:
        return Vec3(0.0, 0.0, 0.0)
    left = max(state.plan_seconds[c, k] - state.plan_clock[c, k], 0.0)
    last = state.path.count[c, k, 0] - 1
    own = load_vec3(state.landing_own[c, k])
    foreseen = world_point(env, support, own, left)
    surprise = foreseen - load_vec3(state.path.point[c, k, last])
    late = along * along * along * along
    return surprise * along - (foreseen - world_point(env, support, own, 0.0)) * (late * late)


@kernel
def foot_along(c: int, k: int, progress: float, state: Any, env: Any) -> tuple[Vec3, Quat]:
    """Return the sole and the foot's orientation at a share of the swing's time."""
    row = path_row(state.path, c, k)
    along, _ = along_path(c, k, progress, state)
    sole = path_point(row.point, row.tangent, row.fraction, row.count[0], along)
    if env.mover_count > 0:
        sole = sole + drift(c, k, along, state, env)
    turn = slerp(
        load_quat(state.foot_rotation_start[c, k]),
        load_quat(state.foot_rotation_target[c, k]),
        along,
    )
    return sole, turn
