"""Feet among obstacles that move: carried by what they stand on, out of the way of what comes."""

from __future__ import annotations

from typing import Any

from polypod.compute import kernel
from polypod.controller.steering import wrapped
from polypod.controller.swing import drift, foot_along, swing_time_left
from polypod.environment.movers import clear_of_movers, mover_depth
from polypod.environment.placing import own_point, ride, world_point
from polypod.environment.table import surface
from polypod.math.quat import from_heading, load_quat, rotate, store_quat
from polypod.math.vec3 import Vec3, load_vec3, store_vec3

# Ways and standing feet are looked at in so many moments ahead.
MOMENTS = 6
# A standing foot looks so far ahead: swings' durations.
FORESIGHT = 0.8
# Where it is looked at, leg lengths above the sole, and the room that it keeps.
ON_FOOT = 0.03
# What lies over it is looked for lower: plates are thin.
AT_FOOT = 1e-3
ROOM = 0.03
# A foot that pulls by so many leg lengths at a body that cannot move has been carried off.
CARRIED_OFF = 1e-4
# A footprint has gone that is so far from where it was foreseen, leg lengths.
GONE = 1e-3


@kernel
def carry_feet(c: int, dt: float, state: Any, env: Any) -> None:
    """Move the standing feet with what they stand on, and the body with them.

    They go round with what turns. What a swinging foot is to land on may not have come where it was
    foreseen: its target goes with it.
    """
    count = state.swinging.shape[1]
    body = load_vec3(state.position[c])
    carried = Vec3(0.0, 0.0, 0.0)
    turn = 0.0
    standing = 0
    for k in range(count):
        if state.swinging[c, k]:
            state.plan_clock[c, k] += dt
            if state.landing_support[c, k] >= 0 and not state.reaching[c, k]:
                last = state.path.count[c, k, 0] - 1
                end = load_vec3(state.path.point[c, k, last])
                store_vec3(state.foot_target[c, k], end + drift(c, k, 1.0, state, env))
            continue
        standing += 1
        support = state.foot_support[c, k]
        if support < 0:
            continue
        carried = carried + ride(env, support, body)
        turn += env.yaw_step[support]
        step = ride(env, support, load_vec3(state.foot[c, k]))
        store_vec3(state.foot[c, k], load_vec3(state.foot[c, k]) + step)
        store_vec3(state.foot_target[c, k], load_vec3(state.foot_target[c, k]) + step)
        store_vec3(state.foot_preferred[c, k], load_vec3(state.foot_preferred[c, k]) + step)
        if env.yaw_step[support] != 0.0:
            along = from_heading(env.yaw_step[support])
            store_quat(state.foot_rotation[c, k], along * load_quat(state.foot_rotation[c, k]))
    if standing > 0:
        carried = carried * (1.0 / standing)
        store_vec3(state.position[c], body + carried)
        state.lift[c, 0] += carried.y
        state.lift[c, 2] += carried.y
        if turn != 0.0:
            turn = turn / standing
            state.heading[c] = wrapped(state.heading[c] + turn)
            state.track_from[c] = wrapped(state.track_from[c] + turn)
            store_quat(state.rotation[c], from_heading(turn) * load_quat(state.rotation[c]))


@kernel
def way_blocked(c: int, k: int, state: Any, tables: Any, env: Any) -> bool:
    """Return whether something will move into a swinging foot's way, or away under its target."""
    now = state.swing_progress[c, k]
    left = swing_time_left(c, k, state)
    target = load_vec3(state.foot_target[c, k])
    height, _ = surface(env, target.x, target.z)
    if abs(height - target.y) > GONE * tables.legs.length[k] and state.landing_support[c, k] >= 0:
        return True
    for j in range(1, MOMENTS + 1):
        share = j / MOMENTS
        sole, _ = foot_along(c, k, now + (1.0 - now) * share, state, env)
        own = state.landing_support[c, k]
        if mover_depth(env, sole, left * share, own) > 0.0:
            return True
    return False


@kernel
def carried_along(env: Any, support: int, point_world: Vec3, ahead: float) -> Vec3:
    """Return where a point that goes with what a foot stands on will be; support -1: stays."""
    if support < 0:
        return point_world
    return world_point(env, support, own_point(env, support, point_world, 0.0), ahead)


@kernel
def is_threatened(c: int, k: int, state: Any, tables: Any, env: Any) -> bool:
    """Return whether something will soon run into a standing foot."""
    if state.cycle_rate[c] <= 0.0:
        horizon = 2.0 * tables.pendulum_time
    else:
        horizon = FORESIGHT * state.swing_extent[c, k] / state.cycle_rate[c]
    leg = tables.legs.length[k]
    half = max(tables.legs.foot_half_size[k, 0], tables.legs.foot_half_size[k, 1])
    support = state.foot_support[c, k]
    room = half + ROOM * leg
    over = load_vec3(state.foot[c, k]) + Vec3(0.0, ON_FOOT * leg, 0.0)
    # About the sole, and about the middle of a foot that reaches back from it.
    behind = Vec3(0.0, 0.0, -tables.legs.foot_behind[k])
    middle = over + rotate(load_quat(state.foot_rotation[c, k]), behind)
    for j in range(MOMENTS + 1):
        ahead = horizon * j / MOMENTS
        if mover_depth(env, carried_along(env, support, over, ahead), ahead, support) > -room:
            return True
        if behind.z == 0.0:
            continue
        if mover_depth(env, carried_along(env, support, middle, ahead), ahead, support) > -room:
            return True
    return False


@kernel
def is_carried_off(c: int, k: int, state: Any, tables: Any, env: Any) -> bool:
    """Return whether what a foot stands on takes it out of its leg's reach, and holds the body."""
    support = state.foot_support[c, k]
    if support < 0 or state.held[c] > 0.0:
        return False
    return bool(state.pull[c, k] > CARRIED_OFF * tables.legs.length[k])


@kernel
def foot_in_the_way(c: int, first: int, state: Any, tables: Any, env: Any) -> int:
    """Return the first standing foot from `first` on that must step away at once.

    As many as feet: none.
    """
    count = state.swinging.shape[1]
    if env.mover_count == 0:
        return int(count)
    for k in range(first, count):
        if state.swinging[c, k]:
            continue
        if is_threatened(c, k, state, tables, env) or is_carried_off(c, k, state, tables, env):
            return int(k)
    return int(count)


@kernel
def any_threatened(c: int, state: Any, tables: Any, env: Any) -> bool:
    """Return whether any foot must step away, or is on its way."""
    for k in range(state.swinging.shape[1]):
        if state.swinging[c, k] and not state.reaching[c, k]:
            return True
        if not state.swinging[c, k] and is_threatened(c, k, state, tables, env):
            return True
    return False


@kernel
def step_out(c: int, k: int, state: Any, tables: Any, env: Any) -> None:
    """Put a standing foot beside or on what has been put over it: it has no other way out."""
    over = load_vec3(state.foot[c, k]) + Vec3(0.0, AT_FOOT * tables.legs.length[k], 0.0)
    free = clear_of_movers(env, over, 0.0, state.foot_support[c, k])
    store_vec3(state.foot[c, k], load_vec3(state.foot[c, k]) + (free - over))
