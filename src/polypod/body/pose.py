"""The body's height and tilt as they are wished for, before the legs' reach is asked (P1 3.2)."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.beat import ease, heave_ahead
from polypod.body.hull import least_height
from polypod.body.push import moved_by_push
from polypod.body.reach import effector_world
from polypod.body.smoothing import follow
from polypod.body.support import FeetPlane, body_rotation
from polypod.compute import kernel
from polypod.controller.rest import hip_offset, rest_ahead
from polypod.controller.roll import rise_at_lift
from polypod.controller.steering import PlanPose, moved_to, predict
from polypod.controller.stride import stance_centre
from polypod.controller.swing import swing_time_left
from polypod.environment.table import surface
from polypod.math.intervals import wrap_phase
from polypod.math.quat import Quat, load_quat
from polypod.math.vec3 import Vec3, load_vec3

# How far the body sinks, preferred heights: for legs that lag, which looks worse than waiting for
# them; and for legs that else find no place.
SHALLOW = 0.15
DEEP = 0.35
# Legs that were too short for the preferred height keep the body down for so many cycles, it rises
# again within about so many, and this far down at most, preferred heights.
STAY_DOWN = 1.2
RISE = 3.0
STEADY_DEPTH = 0.06
# Who stands rises within so many cycles.
STANDING_RISE = 0.4
# What `follow` lags behind a steady climb by, shares of its time.
LAG = 0.75
# So far ahead legs are looked at that will stretch, shares of half a cycle, and how often. A foot
# is taken to stand longer than its disk says by a share of that: it may find no place at once.
SOON = 0.6
SOON_SAMPLES = 2
LATE = 0.1


@kernel
def highest_over(
    c: int, k: int, place: Vec3, foot_turn: Quat, bend: float, pose: PlanPose, turn: Quat,
    state: Any, tables: Any,
) -> float:  # fmt: skip
    """Return the greatest height of the body at which a leg reaches a place for its sole.

    `turn` is the body's rotation at the pose, `bend` how far the foot's heel is up there, rad.
    """
    ankle = effector_world(k, tables, place, foot_turn, bend)
    hip = hip_offset(c, k, turn, pose, state, tables)
    reach = 0.5 * (tables.ik.comfortable[k] + tables.ik.longest[k])
    dx = pose.x + hip.x - ankle.x
    dz = pose.z + hip.z - ankle.z
    flat = min(dx * dx + dz * dz, 0.9 * reach * reach)
    return ankle.y + math.sqrt(reach * reach - flat) - hip.y


@kernel
def highest(
    c: int, base: float, pose: PlanPose, turn: Quat, state: Any, command: Any, tables: Any
) -> float:
    """Return how high above `base` the body may be, metres, so that all legs reach their places.

    That is where feet stand; where those about to land will be met by a body that has moved on
    until then; and where those would go that found no place, which lets the body sink farther.
    """
    course = pose.heading - pose.aside.heading + command.travel[c]
    shallow = math.inf
    deep = math.inf
    for k in range(state.swinging.shape[1]):
        place = load_vec3(state.foot_target[c, k])
        foot_turn = load_quat(state.foot_rotation_target[c, k])
        if state.swinging[c, k]:
            left = swing_time_left(c, k, state)
            way = pose.speed * left
            push_x, push_z = moved_by_push(pose.aside, tables.recovery, left)
            x = math.sin(course) * way + push_x
            place = place - Vec3(x, 0.0, math.cos(course) * way + push_z)
        elif state.waiting[c, k] > 0.0:
            wish = load_vec3(state.wish[c, k])
            over = highest_over(c, k, wish, foot_turn, 0.0, pose, turn, state, tables)
            deep = min(deep, over - base)
        bend = 0.0 if state.swinging[c, k] else state.foot_bend[c, k, 0]
        over = highest_over(c, k, place, foot_turn, bend, pose, turn, state, tables)
        shallow = min(shallow, over - base)
    height = command.body_height[c]
    return min(max(shallow, -SHALLOW * height), max(deep, -DEEP * height))


@kernel
def rise_along(pose: PlanPose, x: float, z: float, plane: FeetPlane) -> float:
    """Return by how much the feet's plane rises from a pose to another place, metres."""
    dx = x - pose.x
    dz = z - pose.z
    sine = math.sin(pose.heading)
    cosine = math.cos(pose.heading)
    forward = dx * sine + dz * cosine
    left = dx * cosine - dz * sine
    return plane.slope_forward * forward + plane.slope_left * left


@kernel
def highest_soon(
    c: int, base: float, pose: PlanPose, there: PlanPose, turn: Quat, plane: FeetPlane,
    state: Any, command: Any, tables: Any,
) -> float:  # fmt: skip
    """Return how high above `base` the body may be so that standing legs reach while they stand.

    Looked at as far ahead as the filter lags: the body has sunk when a leg stretches, and is not
    pulled down by it. `there` is the pose half a cycle ahead.
    """
    most = math.inf
    for i in range(1, SOON_SAMPLES + 1):
        share = SOON * i / SOON_SAMPLES
        x = pose.x + (there.x - pose.x) * share
        z = pose.z + (there.z - pose.z) * share
        later = moved_to(pose, x, z)
        rise = rise_along(pose, x, z, plane) + heave_ahead(c, 0.5 * share, state)
        for k in range(state.swinging.shape[1]):
            until = wrap_phase(state.swing_start[c, k] - state.needle[c])
            until += LATE * (1.0 - state.swing_extent[c, k])
            if state.swinging[c, k] or until < 0.5 * share:
                continue
            place = load_vec3(state.foot[c, k])
            foot_turn = load_quat(state.foot_rotation[c, k])
            # Where its leg is stretched, its heel has risen.
            bend = rise_at_lift(c, k, state, command, tables)
            over = highest_over(c, k, place, foot_turn, bend, later, turn, state, tables)
            most = min(most, over - base - rise)
    return max(most, -SHALLOW * command.body_height[c])


@kernel
def highest_ahead(
    c: int, base: float, pose: PlanPose, there: PlanPose, turn: Quat, plane: FeetPlane,
    state: Any, command: Any, tables: Any, settings: Any, env: Any,
) -> float:  # fmt: skip
    """Return how high above `base` the body may be so that its legs reach down at their next steps.

    Each foot is taken to land half a cycle from now, half a stance ahead of its rest place under
    the body as predicted: at the edge of a step down the body has sunk when its feet get there.
    """
    cycle = 1.0 / state.cycle_rate[c]
    rise = rise_along(pose, there.x, there.z, plane) + heave_ahead(c, 0.5, state)
    course = there.heading - there.aside.heading + command.travel[c]
    most = math.inf
    for k in range(state.swinging.shape[1]):
        stance = cycle * (1.0 - state.goal_extent[c, k])
        way = there.speed * stance
        centre = stance_centre(c, k, way * math.cos(command.travel[c]), state, tables)
        half = 0.5 * way
        push_x, push_z = moved_by_push(there.aside, tables.recovery, 0.5 * stance)
        offset = rest_ahead(c, k, there, state, tables, settings)
        x = there.x + offset.x + math.sin(course) * half + math.sin(there.heading) * centre + push_x
        z = there.z + offset.z + math.cos(course) * half + math.cos(there.heading) * centre + push_z
        y, _ = surface(env, x, z)
        foot_turn = load_quat(state.foot_rotation_target[c, k])
        over = highest_over(c, k, Vec3(x, y, z), foot_turn, 0.0, there, turn, state, tables)
        most = min(most, over - base - rise)
    return max(most, -DEEP * command.body_height[c])


@kernel
def update_tilt(
    c: int, dt: float, plane: FeetPlane, state: Any, tables: Any, settings: Any
) -> None:
    """Let pitch and roll follow the slopes of the feet's plane."""
    state.plane_height[c] = plane.height
    state.slope[c, 0] = plane.slope_forward
    state.slope[c, 1] = plane.slope_left
    share = settings.tilt_share * tables.tilt_scale
    seconds = settings.tilt_smoothing * cycle_seconds(c, state, tables)
    follow(state.tilt[c, 0], plane.slope_forward * share, seconds, dt)
    follow(state.tilt[c, 1], plane.slope_left * share, seconds, dt)


@kernel
def cycle_seconds(c: int, state: Any, tables: Any) -> float:
    """Return the seconds of a gait cycle, or those of a slow step for who stands."""
    slowest = 4.0 * tables.pendulum_time
    if state.cycle_rate[c] <= 0.0:
        return float(slowest)
    return float(min(slowest, 1.0 / state.cycle_rate[c]))


@kernel
def keep_down(c: int, cycles: float, most: float, state: Any, command: Any) -> None:
    """Note how far below its preferred height, at most, a body stays for the sake of its legs.

    A leg is at its end once in a stance. Who rose in between would bob by the reach of its legs,
    against its gait. What is deeper than a steady walk needs passes as quickly as it came.
    """
    state.room[c, 1] += cycles
    needed = max(most, -STEADY_DEPTH * command.body_height[c] * ease(c, state))
    if needed <= state.room[c, 0]:
        state.room[c, 0] = needed
        state.room[c, 1] = 0.0
    elif state.cycle_rate[c] <= 0.0:
        state.room[c, 0] *= math.exp(-cycles / STANDING_RISE)
    elif state.room[c, 1] > STAY_DOWN:
        state.room[c, 0] *= math.exp(-cycles / RISE)


@kernel
def wished_height(
    c: int, dt: float, pose: PlanPose, plane: FeetPlane, turn: Quat,
    state: Any, command: Any, tables: Any, settings: Any, env: Any, scratch: Any,
) -> float:  # fmt: skip
    """Return the height of the body centre, world, before the legs' reach is asked exactly.

    The preferred height above the feet's plane; at least what the hulls under the trunk ask; at
    most what the legs comfortably reach. The difference to the preferred height is smoothed, so
    that it comes and goes with continuous acceleration. The gait's own heave comes on top of it,
    and leaves its room where legs are at their end.
    """
    cycle = cycle_seconds(c, state, tables)
    seconds = settings.height_smoothing * cycle
    base = plane.height + command.body_height[c] - state.sink[c]
    base -= rise_along(pose, state.position[c, 0], state.position[c, 2], plane)
    ahead = abs(state.speed[c]) * seconds
    least = least_height(c, state, tables, env, state.tilt[c, 0, 0], ahead, scratch.hull)
    most = highest(c, base + state.heave[c], pose, turn, state, command, tables)
    if state.cycle_rate[c] > 0.0:
        level = body_rotation(pose.heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
        there = predict(pose, 0.5 / state.cycle_rate[c], c, state, command, tables, settings)
        soon = highest_soon(c, base, pose, there, level, plane, state, command, tables)
        landing = highest_ahead(
            c, base, pose, there, level, plane, state, command, tables, settings, env
        )
        most = min(most, soon, landing)
    keep_down(c, dt / cycle, most, state, command)
    extra = min(max(state.room[c, 0], least - base), most)
    # On a steady climb the filter would lag by three of its time constants.
    share = settings.tilt_share * tables.tilt_scale
    slope = state.tilt[c, 0, 0] / share if share > 0.0 else plane.slope_forward
    lead = LAG * seconds * slope * state.speed[c] * math.cos(command.travel[c])
    return follow(state.lift[c], base + extra + lead, seconds, dt) + state.heave[c]
