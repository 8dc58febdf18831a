"""What each foot does next (P1 3.2, Fig 5): stand, lift, swing along its path, land."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.reach import effector_world
from polypod.compute import kernel
from polypod.controller.align import aligned_turn, ground_normal_under
from polypod.controller.errand import Errand
from polypod.controller.others import gather_other_legs, look_ahead
from polypod.controller.rest import body_height_at, hip_at, level_height, rest_ahead
from polypod.controller.roll import rise_at_lift
from polypod.controller.steering import PlanPose, predict
from polypod.controller.stride import stance_centre, stance_seconds
from polypod.crowd.legs import add_company
from polypod.environment.placing import own_point
from polypod.environment.table import surface_at
from polypod.footprints.plan import plan_step
from polypod.footprints.scratch import TALLY_DIRECT, TALLY_PLACES
from polypod.footprints.settings import StepRequest, landing_time, placed_shape
from polypod.math.quat import store_quat
from polypod.math.vec3 import Vec3, distance, load_vec3, normalized, store_vec3

# A foot that found no place for so many cycles may cross the other legs.
CROWDED = 0.5
# Where no path is found, a lower one may pass under the leg's shortest reach: its sole then clears
# uneven ground, but not the whole foot. The last is for what moves: it is not asked whether the
# chords between its frames are free, for a foot goes less far in a frame where they are not.
STEP_SHARES = (1.0, 0.35, 1.0)
SAME_PLACE = 1e-6  # m


@kernel
def preferred_footprint(
    c: int, k: int, pose: PlanPose, touchdown: float,
    state: Any, command: Any, tables: Any, settings: Any,
) -> Vec3:  # fmt: skip
    """Return where a foot would land on the plan, `touchdown` seconds ahead (P1 3.2, Fig 4a).

    The rest place carried by the body as predicted for the middle of the coming stance: that is
    the pose at touchdown plus half of the stance's travel along the predicted arc; and as far ahead
    or behind as lets the leg reach both ends of that.
    """
    stance = stance_seconds(c, k, state)
    middle = predict(pose, touchdown + 0.5 * stance, c, state, command, tables, settings)
    offset = rest_ahead(c, k, middle, state, tables, settings)
    way = middle.speed * math.cos(command.travel[c]) * stance
    ahead = stance_centre(c, k, way, state, tables)
    x = middle.x + offset.x + math.sin(middle.heading) * ahead
    z = middle.z + offset.z + math.cos(middle.heading) * ahead
    return Vec3(x, state.foot[c, k, 1], z)


@kernel
def note_seen(k: int, found: bool, score: float, scratch: Any) -> None:
    """Keep the places that were just looked at for a foot, and the one that was chosen.

    That may be of an earlier round of the search, or of the direct swing, which looks at no other;
    it has the `score` of its pair then.
    """
    seen, plan = scratch.seen, scratch.plan
    count = 0 if found and plan.tally[TALLY_DIRECT] != 0 else plan.tally[TALLY_PLACES]
    chosen = load_vec3(scratch.path.point[scratch.path.count[0] - 1])
    for place in range(count):
        seen.score[k, place] = plan.found.score[place]
        store_vec3(seen.place[k, place], load_vec3(plan.found.place[place]))
        found = found and distance(load_vec3(plan.found.place[place]), chosen) > SAME_PLACE
    if found:
        count = min(count + 1, seen.score.shape[1])
        seen.score[k, count - 1] = score
        store_vec3(seen.place[k, count - 1], chosen)
    seen.count[k] = count


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
    landing = predict(pose, touchdown, c, state, command, tables, settings)
    middle = predict(pose, touchdown + 0.5 * stance, c, state, command, tables, settings)
    leaving = predict(pose, touchdown + stance, c, state, command, tables, settings)
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
    others = gather_other_legs(
        c, k, touchdown, landing, state, command, tables, settings, env, scratch.plan
    )
    look_ahead(c, dt, pose, errand, stance, state, command, tables, settings, env, scratch.plan)
    if state.waiting[c, k] * state.cycle_rate[c] > CROWDED:
        others = 0
    if state.crowded[c]:
        others = add_company(
            c, k, others, start, preferred, touchdown, errand.radius, state, tables, scratch
        )
    rise = rise_at_lift(c, k, state, command, tables)
    found = False
    attempts = len(STEP_SHARES) if env.mover_count > 0 else len(STEP_SHARES) - 1
    for attempt in range(attempts):
        request = StepRequest(
            start,
            errand.velocity,
            preferred,
            load_vec3(scratch.hip[0]),
            hip,
            hip_at(c, k, leaving, state, tables),
            effector_world(k, tables, Vec3(0.0, 0.0, 0.0), turn, 0.0),
            effector_world(k, tables, Vec3(0.0, 0.0, 0.0), turn, rise),
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
            dt if attempt < len(STEP_SHARES) - 1 else 0.0,
            errand.launch,
            level_height(c, preferred.x, preferred.z, state),
            stance,
            tables.level_weight,
            int(settings.swing_profile),
            legs.foot_behind[k],
            attempt == 0,
        )
        found, score = plan_step(env, plan_settings, scratch.plan, request, scratch.path)
        if scratch.seen.who[0] == c:
            note_seen(k, found, score, scratch)
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
        store_vec3(state.landing_own[c, k], own_point(env, support, target, seconds))
    store_vec3(state.foot_preferred[c, k], preferred)
    store_vec3(state.foot_target[c, k], target)
    store_quat(state.foot_rotation_target[c, k], turn)
    return True
