"""What each foot does next (P1 3.2, Fig 5): stand, lift, swing along its path, land."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from polypod.body.reach import effector_world
from polypod.body.support import body_rotation, foot_on_its_way
from polypod.compute import kernel
from polypod.controller.ahead import body_height_at, hip_at, level_height
from polypod.controller.align import aligned_turn, ground_normal_under
from polypod.controller.steering import PlanPose, predict
from polypod.environment.table import shift_of, surface_at
from polypod.footprints.plan import plan_step
from polypod.footprints.settings import StepRequest, landing_time, placed_shape
from polypod.math.quat import rotate, store_quat
from polypod.math.vec3 import Vec3, length_plan, load_vec3, normalized, store_vec3

# A foot that found no place for so many cycles may cross the other legs.
CROWDED = 0.5
# Where no path is found, a lower one may pass under the leg's shortest reach: its sole then clears
# uneven ground, but not the whole foot.
STEP_SHARES = (1.0, 0.35)


class Errand(NamedTuple):
    """What a foot is sent to do."""

    preferred: Vec3  # world, m: where it would land on the plan
    seconds: float  # until touchdown
    velocity: Vec3  # with which it sets out, m per unit of progress
    launch: float  # its speed then over the mean speed
    radius: float  # m about the preferred place in which a footprint is looked for


@kernel
def place_body(c: int, k: int, state: Any, tables: Any) -> Vec3:
    """Return the rest place of a sole, spacing included; body frame, m."""
    stand = load_vec3(tables.legs.sole_stance[k])
    return Vec3(stand.x + state.spacing[c, k, 0], stand.y, stand.z + state.spacing[c, k, 1])


@kernel
def rest_offset(c: int, k: int, heading: float, state: Any, tables: Any, settings: Any) -> Vec3:
    """Return where a sole rests beside the body centre, world axes, m; only the plan counts.

    The body leans with the slope, and the rest places with it; upright legs take part of the lean
    back, so that the feet stay under the body.
    """
    turn = body_rotation(heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
    offset = rotate(turn, place_body(c, k, state, tables))
    if tables.legs.upright[k]:
        under = rotate(turn, Vec3(0.0, tables.legs.sole_stance[k, 1], 0.0))
        offset = offset - Vec3(under.x, 0.0, under.z) * settings.upright_lean
    return offset


@kernel
def gather_other_legs(c: int, k: int, state: Any, tables: Any, plan: Any) -> int:
    """Write the segments of the other legs near foot `k` to the scratch; return their number.

    Of each leg whose foot could be met, the last section before the sole counts, as it is now for
    a standing foot and as it will be for a swinging one.
    """
    count = 0
    legs = tables.legs
    for other in range(state.swinging.shape[1]):
        gap = load_vec3(legs.sole_stance[other]) - load_vec3(legs.sole_stance[k])
        if other == k or length_plan(gap) > legs.length[k] or count >= plan.other_a.shape[0]:
            continue
        sole = foot_on_its_way(c, other, state)
        if state.swinging[c, other]:
            sole = load_vec3(state.foot_target[c, other])
        knee = load_vec3(state.joint_position[c, legs.joint[other, legs.joint_count[other] - 1]])
        moved = sole - load_vec3(state.foot_reached[c, other])
        store_vec3(plan.other_a[count], sole)
        store_vec3(plan.other_b[count], knee + moved)
        plan.other_radius[count] = 0.5 * max(
            legs.foot_half_size[other, 0], legs.foot_half_size[other, 1]
        )
        count += 1
    return count


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
    middle = predict(pose, touchdown + 0.5 * stance, c, command, tables, settings)
    offset = rest_offset(c, k, middle.heading, state, tables, settings)
    return Vec3(middle.x + offset.x, state.foot[c, k, 1], middle.z + offset.z)


@kernel
def plan_foot(
    c: int, k: int, dt: float, pose: PlanPose, errand: Errand, state: Any, command: Any,
    tables: Any, settings: Any, env: Any, plan_settings: Any, scratch: Any,
) -> bool:  # fmt: skip
    """Plan a foot's way from where it is to the best place near the preferred one.

    The path and the hip's way are left in the scratch; the target and the touchdown orientation go
    to the state. Returns False where no valid pair of footprint and path was found; the state is
    then untouched.
    """
    legs = tables.legs
    preferred = errand.preferred
    touchdown = errand.seconds
    stance = stance_seconds(c, k, state)
    landing = predict(pose, touchdown, c, command, tables, settings)
    middle = predict(pose, touchdown + 0.5 * stance, c, command, tables, settings)
    leaving = predict(pose, touchdown + stance, c, command, tables, settings)
    start = load_vec3(state.foot[c, k])
    height, _ = surface_at(env, preferred.x, preferred.z, touchdown)
    place = Vec3(preferred.x, height, preferred.z)
    shape = placed_shape(
        legs.foot_half_size[k, 0], legs.foot_half_size[k, 1], legs.foot_behind[k], middle.heading
    )
    normal = ground_normal_under(env, shape, place, touchdown)
    turn = aligned_turn(c, k, place, normal, landing, middle, state, tables, settings, scratch)
    hip = hip_at(c, k, landing, state, tables)
    store_vec3(scratch.hip[0], hip_at(c, k, pose, state, tables))
    store_vec3(scratch.hip[1], hip)
    outward = Vec3(preferred.x - landing.x, 0.0, preferred.z - landing.z)
    others = gather_other_legs(c, k, state, tables, scratch.plan)
    if state.waiting[c, k] * state.cycle_rate[c] > CROWDED:
        others = 0
    found = False
    for attempt in range(len(STEP_SHARES)):
        request = StepRequest(
            start,
            errand.velocity,
            preferred,
            load_vec3(scratch.hip[0]),
            hip,
            hip_at(c, k, leaving, state, tables),
            effector_world(k, tables, Vec3(0.0, 0.0, 0.0), turn, 0.0),
            tables.ik.shortest[k],
            tables.ik.longest[k],
            tables.ik.comfortable[k],
            legs.length[k],
            command.step_height[c] * STEP_SHARES[attempt],
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
            int(settings.swing_profile),
            legs.foot_behind[k],
            attempt == 0,
        )
        found, _ = plan_step(env, plan_settings, scratch.plan, request, scratch.path)
        if found:
            break
    if not found:
        return False
    target = load_vec3(scratch.path.point[scratch.path.count[0] - 1])
    seconds = landing_time(request)
    normal = ground_normal_under(env, shape, target, seconds)
    turn = aligned_turn(c, k, target, normal, landing, middle, state, tables, settings, scratch)
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
