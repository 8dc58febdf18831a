"""What each foot does next (P1 3.2, Fig 5): stand, lift, swing along its path, land."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.reach import effector_world
from polypod.body.support import body_rotation
from polypod.compute import kernel
from polypod.controller.errand import Errand
from polypod.controller.others import gather_other_legs, look_ahead
from polypod.controller.rest import body_height_at, level_height, rest_offset
from polypod.controller.steering import PlanPose, predict
from polypod.crowd.legs import add_company
from polypod.environment.table import shift_of, surface_at, surface_normal, surface_normal_at
from polypod.footprints.plan import plan_step
from polypod.footprints.settings import StepRequest, landing_time
from polypod.ik.foot import foot_rotation
from polypod.math.quat import rotate, store_quat
from polypod.math.vec3 import Vec3, load_vec3, normalized, store_vec3

# A foot that found no place for so many cycles may cross the other legs.
CROWDED = 0.5
# Where no path is found, a lower one may pass under the leg's shortest reach.
STEP_SHARES = (1.0, 0.35)


@kernel
def hip_at(c: int, k: int, pose: PlanPose, state: Any, tables: Any) -> Vec3:
    """Return a hip's place, world, when the body is at a predicted pose."""
    turn = body_rotation(pose.heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
    centre = Vec3(pose.x, body_height_at(c, pose.x, pose.z, state), pose.z)
    return centre + rotate(turn, load_vec3(tables.legs.point_rest[k, 0]))


@kernel
def stance_seconds(c: int, k: int, state: Any) -> float:
    """Return how long a foot will stand once it has landed; 0 where nobody walks."""
    if state.cycle_rate[c] <= 0.0:
        return 0.0
    return float((1.0 - state.goal_extent[c, k]) / state.cycle_rate[c])


@kernel
def preferred_footprint(
    c: int, k: int, pose: PlanPose, touchdown: float,
    state: Any, command: Any, tables: Any, settings: Any,
) -> Vec3:  # fmt: skip
    """Return where a foot would land on the plan, `touchdown` seconds ahead (P1 3.2, Fig 4a).

    The rest place carried by the body as predicted for the middle of the coming stance: that is
    the pose at touchdown plus half of the stance's travel along the predicted arc.
    """
    stance = stance_seconds(c, k, state)
    middle = predict(pose, touchdown + 0.5 * stance, c, state, command, tables, settings)
    offset = rest_offset(c, k, middle.heading, state, tables, settings)
    return Vec3(middle.x + offset.x, state.foot[c, k, 1], middle.z + offset.z)


@kernel
def plan_foot(
    c: int, k: int, dt: float, pose: PlanPose, errand: Errand, state: Any, command: Any,
    tables: Any, settings: Any, env: Any, plan_settings: Any, scratch: Any,
) -> bool:  # fmt: skip
    """Plan a foot's way from where it is to the best place near the preferred one.

    The path is left in the scratch; the target and the touchdown orientation go to the state.
    Returns False where no valid pair of footprint and path was found; the state is then untouched.
    """
    legs = tables.legs
    preferred = errand.preferred
    touchdown = errand.seconds
    stance = stance_seconds(c, k, state)
    landing = predict(pose, touchdown, c, state, command, tables, settings)
    middle = predict(pose, touchdown + 0.5 * stance, c, state, command, tables, settings)
    leaving = predict(pose, touchdown + stance, c, state, command, tables, settings)
    start = load_vec3(state.foot[c, k])
    turn = foot_rotation(
        middle.heading,
        surface_normal(env, preferred.x, preferred.z),
        settings.foot_align,
        settings.foot_tilt,
    )
    hip = hip_at(c, k, landing, state, tables)
    outward = Vec3(preferred.x - landing.x, 0.0, preferred.z - landing.z)
    others = gather_other_legs(c, k, state, tables, scratch.plan)
    look_ahead(c, dt, pose, errand, stance, state, command, tables, settings, env, scratch.plan)
    if state.waiting[c, k] * state.cycle_rate[c] > CROWDED:
        others = 0
    if state.crowded[c]:
        others = add_company(
            c, k, others, start, preferred, touchdown, errand.radius, state, tables, scratch
        )
    found = False
    for share in STEP_SHARES:
        request = StepRequest(
            start,
            errand.velocity,
            preferred,
            hip_at(c, k, pose, state, tables),
            hip,
            hip_at(c, k, leaving, state, tables),
            effector_world(k, tables, Vec3(0.0, 0.0, 0.0), turn),
            tables.ik.shortest[k],
            tables.ik.longest[k],
            tables.ik.comfortable[k],
            legs.length[k],
            command.step_height[c] * share,
            legs.foot_half_size[k, 0],
            legs.foot_half_size[k, 1],
            middle.heading,
            Vec3(landing.x, body_height_at(c, landing.x, landing.z, state), landing.z),
            normalized(outward, Vec3(0.0, 0.0, 0.0)),
            touchdown,
            math.inf,
            errand.radius,
            others,
            dt,
            errand.launch,
            level_height(c, preferred.x, preferred.z, state),
            stance,
            tables.level_weight,
        )
        found, _ = plan_step(env, plan_settings, scratch.plan, request, scratch.path)
        if found:
            break
    if not found:
        return False
    target = load_vec3(scratch.path.point[scratch.path.count[0] - 1])
    seconds = landing_time(request)
    turn = foot_rotation(
        middle.heading,
        surface_normal_at(env, target.x, target.z, seconds),
        settings.foot_align,
        settings.foot_tilt,
    )
    _, support = surface_at(env, target.x, target.z, seconds)
    state.landing_support[c, k] = support
    state.plan_clock[c, k] = 0.0
    state.plan_seconds[c, k] = seconds
    if support >= 0:
        store_vec3(state.plan_shift[c, k], shift_of(env, support, seconds))
    store_vec3(state.foot_preferred[c, k], preferred)
    store_vec3(state.foot_target[c, k], target)
    store_quat(state.foot_rotation_target[c, k], turn)
    return True
