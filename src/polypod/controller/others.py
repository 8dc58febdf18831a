"""Where a creature's other legs are, and will be, while one of them steps."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.push import moved_by_push
from polypod.body.reach import effector_world, may_drag
from polypod.body.support import body_rotation, smooth_step
from polypod.compute import kernel
from polypod.controller.errand import Errand
from polypod.controller.parting import MANY, passes
from polypod.controller.rest import body_height_at, rest_ahead
from polypod.controller.steering import PlanPose, predict
from polypod.controller.swing import foot_along, swing_time_left
from polypod.environment.table import surface
from polypod.gait.needle import swing_progress
from polypod.gait.pattern import SAME_MOMENT
from polypod.math.intervals import wrap_phase
from polypod.math.quat import Quat, load_quat, store_quat
from polypod.math.vec3 import Vec3, length_plan, load_vec3, mix, store_vec3
from polypod.paths.apart import MOMENTS
from polypod.spine.frames import leg_frame_at

# Who shortens its strides by so much of what it may does not count on feet that have yet to lift.
CAREFUL = 0.25


@kernel
def hangs(c: int, k: int, state: Any) -> bool:
    """Return whether a foot in the air goes nowhere: it reaches out, or its leg holds it back."""
    return bool(state.reaching[c, k] or state.waiting[c, k] > 0.0)


@kernel
def foot_later(
    c: int, k: int, seconds: float, then: PlanPose, command: Any, state: Any, tables: Any,
    settings: Any, env: Any,
) -> Vec3:  # fmt: skip
    """Return where a foot will be some seconds from now, when the body is at a predicted pose.

    A standing foot stays until the needle enters its sector, and then goes to where it would rest
    at mid-stance, on level ground as high as where it is.
    """
    here = load_vec3(state.foot[c, k])
    if state.swinging[c, k]:
        if hangs(c, k, state):
            return here
        left = swing_time_left(c, k, state)
        if seconds >= left:
            return load_vec3(state.foot_target[c, k])
        now = state.swing_progress[c, k]
        sole, _ = foot_along(c, k, now + (1.0 - now) * seconds / max(left, 1e-9), state, env)
        return sole
    rate = state.cycle_rate[c]
    extent = state.swing_extent[c, k]
    if rate <= 0.0 or extent <= 0.0:
        return here
    if swing_progress(state.needle[c], state.swing_start[c, k], extent) >= 0.0:
        return here  # its turn has come, and it found no place yet
    wait = wrap_phase(state.swing_start[c, k] - state.needle[c]) / rate
    if seconds <= wait:
        return here
    share = min((seconds - wait) * rate / extent, 1.0)
    offset = rest_ahead(c, k, then, state, tables, settings)
    half = 0.5 * (1.0 - extent) / rate
    way = half * then.speed
    course = then.heading - then.aside.heading + command.travel[c]
    push_x, push_z = moved_by_push(then.aside, tables.recovery, half)
    x = then.x + offset.x + math.sin(course) * way + push_x
    z = then.z + offset.z + math.cos(course) * way + push_z
    height, _ = surface(env, x, z)
    rise = command.step_height[c] * 4.0 * share * (1.0 - share)
    return mix(here, Vec3(x, height, z), smooth_step(share)) + Vec3(0.0, rise, 0.0)


@kernel
def is_on_its_way(c: int, k: int, seconds: float, state: Any) -> bool:
    """Return whether a foot that stands now will be in the air some seconds from now."""
    rate = state.cycle_rate[c]
    extent = state.swing_extent[c, k]
    if rate <= 0.0 or swing_progress(state.needle[c], state.swing_start[c, k], extent) >= 0.0:
        return False
    gone = seconds * rate - wrap_phase(state.swing_start[c, k] - state.needle[c])
    # Who changes places with it just then is not: rounding shall not decide.
    return bool(SAME_MOMENT < gone < extent - SAME_MOMENT)


@kernel
def gather_other_legs(
    c: int, k: int, seconds: float, landing: PlanPose, state: Any, command: Any, tables: Any,
    settings: Any, env: Any, plan: Any,
) -> int:  # fmt: skip
    """Write the segments of the other legs near foot `k` to the scratch; return their number.

    Of each leg whose foot could be met, the last section before the sole counts: where it will be
    `seconds` from now, when foot `k` lands under the body at `landing`, or where it lands then. So
    a hind foot may land in the print that the fore foot of its side has just left; but not where
    the ground is such that the fore foot may find no place to go to. Of many legs one that is on
    its way by then is nowhere that a whole path could keep clear of: only where it comes near in
    time is judged, as of all of these legs, by `look_ahead`.
    """
    count = 0
    near = 0
    crowded = state.swinging.shape[1] > MANY
    legs = tables.legs
    for other in range(state.swinging.shape[1]):
        gap = load_vec3(legs.sole_stance[other]) - load_vec3(legs.sole_stance[k])
        if other == k or length_plan(gap) > legs.length[k] or near >= plan.ahead.leg.shape[0]:
            continue
        # In a run they do in mid-air, folded under the body: who kept clear of that would straddle.
        if may_drag(c, state) and passes(k, other, legs):
            continue
        plan.ahead.leg[near] = other
        near += 1
        sole = load_vec3(state.foot[c, other])
        if not state.swinging[c, other] and state.caution[c] < CAREFUL:
            if crowded and is_on_its_way(c, other, seconds, state):
                continue
            sole = foot_later(c, other, seconds, landing, command, state, tables, settings, env)
        elif state.swinging[c, other] and not hangs(c, other, state):
            sole = load_vec3(state.foot_target[c, other])
        knee = load_vec3(state.joint_position[c, legs.joint[other, legs.joint_count[other] - 1]])
        moved = sole - load_vec3(state.foot_reached[c, other])
        store_vec3(plan.other_a[count], sole)
        store_vec3(plan.other_b[count], knee + moved)
        plan.other_radius[count] = 0.25 * (
            legs.foot_half_size[other, 0] + legs.foot_half_size[other, 1]
        )
        count += 1
    plan.ahead.own[0] = k
    plan.ahead.others[0] = near
    return count


@kernel
def carry_leg(
    c: int, leg: int, moment: int, position: Vec3, turn: Quat, then: PlanPose, state: Any,
    tables: Any, ahead: Any,
) -> None:  # fmt: skip
    """Write the frame in which a leg will hang at a moment, with the body at a pose."""
    origin, turned = leg_frame_at(c, leg, position, turn, then, state, tables)
    store_vec3(ahead.position[moment, leg], origin)
    store_quat(ahead.rotation[moment, leg], turned)


@kernel
def look_ahead(
    c: int, dt: float, pose: PlanPose, errand: Errand, stance: float, state: Any, command: Any,
    tables: Any, settings: Any, env: Any, plan: Any,
) -> None:  # fmt: skip
    """Write where the body and the gathered legs will be at the moments of a step.

    `stance` is how long the foot will stand after it, s; `pose` is the body's at the end of this
    frame of `dt` seconds, at whose start the feet still are.
    """
    ahead = plan.ahead
    ahead.frame[4] = 0.0
    for moment in range(MOMENTS.shape[0]):
        share = MOMENTS[moment]
        seconds = min(share, 1.0) * errand.seconds + max(share - 1.0, 0.0) * stance
        then = predict(pose, max(seconds - dt, 0.0), c, state, command, tables, settings)
        place = Vec3(then.x, body_height_at(c, then.x, then.z, state), then.z)
        turn = body_rotation(then.heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
        carry_leg(c, ahead.own[0], moment, place, turn, then, state, tables, ahead)
        for other in range(ahead.others[0]):
            leg = ahead.leg[other]
            carry_leg(c, leg, moment, place, turn, then, state, tables, ahead)
            sole = foot_later(c, leg, seconds, then, command, state, tables, settings, env)
            turned = load_quat(state.foot_rotation[c, leg])
            store_vec3(ahead.sole[moment, other], sole)
            store_vec3(
                ahead.effector[moment, other], effector_world(leg, tables, sole, turned, 0.0)
            )
            ahead.posed[moment, other] = False
