"""How good a place is for a foot, judged by the true shapes (P1 section 5.1)."""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.environment.movers import mover_depth
from polypod.environment.placing import own_point, world_point
from polypod.environment.table import (
    EnvironmentTable,
    is_forbidden_at,
    surface_at,
)
from polypod.footprints.bearing import is_borne
from polypod.footprints.evenness import edge_score, even_score, lay_tread
from polypod.footprints.legs import REJECTED, leg_factor
from polypod.footprints.relief import is_tread_wet
from polypod.footprints.scratch import GroundScratch
from polypod.footprints.settings import (
    FootShape,
    PlanSettings,
    StepRequest,
    Tread,
    foot_shape,
    landing_time,
)
from polypod.math.vec3 import Vec3, distance
from polypod.paths.apart import LegsAhead
from polypod.paths.near import obstacles_near
from polypod.paths.scratch import OtherLegs

# Directions in which the next step may leave a place: angle from the course, and how good that is.
EXITS = 5
EXIT_ANGLE = 0.7  # radians between two of them
EXIT_SAMPLES = 5
# What a leg cannot get over, shares of its longest reach above the place.
TOO_HIGH = 0.7
# Shorter stances have no course, leg lengths.
SHORTEST_COURSE = 0.05
LOWEST = -1e300
# A place is safe where nothing comes within this share of the stance, looked at so often, at a
# point so many leg lengths above the sole.
SAFE_STANCE = 0.6
STAND_SAMPLES = 4
ON_FOOT = 0.03


@kernel
def exit_score(
    env: EnvironmentTable,
    margin: float,
    x: float,
    z: float,
    high: float,
    heading: float,
    step: float,
    ahead: float,
) -> float:
    """Return how well the next step can leave the place: 1 ahead, less to the sides, 0 not at all.

    Pockets between forbidden or very high things (above `high`, m) trap legs. `heading` is the
    course and `step` the length of the coming stance (rad, m); `margin` (m) is kept from what is
    forbidden.
    """
    best = 0.0
    for k in range(EXITS):
        # 0, +, -, 2+, 2-: mirrored pairs, so that no side is favoured.
        turn = EXIT_ANGLE * ((k + 1) // 2) * (1.0 if k % 2 == 1 else -1.0)
        worth = 1.0 - 0.3 * ((k + 1) // 2)
        if worth <= best:
            break
        sine = math.sin(heading + turn)
        cosine = math.cos(heading + turn)
        free = True
        for j in range(1, EXIT_SAMPLES + 1):
            along = step * j / EXIT_SAMPLES
            to_x = x + sine * along
            to_z = z + cosine * along
            height, _ = surface_at(env, to_x, to_z, ahead)
            if height > high or is_forbidden_at(env, to_x, to_z, margin, ahead):
                free = False
                break
        if free:
            best = worth
    return best


@kernel
def is_foot_wet(env: EnvironmentTable, foot: FootShape, x: float, z: float) -> bool:
    """Return whether any of the foot's shape lies in water."""
    tread = Tread(
        x, 0.0, z, foot.half_x, foot.half_z, foot.sine, foot.cosine, 0.0, 0.0, 0.0, 0.0, 0.0
    )
    return is_tread_wet(env, tread)


@kernel
def reach_score(settings: PlanSettings, request: StepRequest, place: Vec3) -> float:
    """Return 1 for comfortable reach at touchdown and at the end of stance, 0 at its edge.

    REJECTED where the leg does not reach the place at touchdown. One that it would have to leave
    early is still a place: the body waits for its feet.
    """
    effector = place + request.effector_offset_touchdown
    landing = distance(effector, request.hip_touchdown)
    if landing > request.reach_max or landing < request.reach_min:
        return REJECTED
    leaving = distance(place + request.effector_offset_end_of_stance, request.hip_end_of_stance)
    if leaving > request.reach_max or leaving < request.reach_min:
        return 0.0
    stretch = max(landing, leaving) - request.reach_comfort_max
    if stretch <= 0.0:
        return 1.0
    return 1.0 - stretch / max(request.reach_max - request.reach_comfort_max, stretch)


@kernel
def is_run_over(
    env: EnvironmentTable,
    request: StepRequest,
    settings: PlanSettings,
    support: int,
    place: Vec3,
    ahead: float,
) -> bool:
    """Return whether something moves into a place soon after a foot has landed there.

    `support` is what the foot will stand on, and be carried by.
    """
    leg = request.leg_length
    over = place + Vec3(0.0, ON_FOOT * leg, 0.0)
    radius = max(request.foot_half_x, request.foot_half_z) + settings.forbidden_margin * leg
    own = over
    if support >= 0:
        own = own_point(env, support, over, ahead)
    for k in range(1, STAND_SAMPLES + 1):
        later = request.stance_seconds * SAFE_STANCE * k / STAND_SAMPLES
        there = over
        if support >= 0:
            there = world_point(env, support, own, ahead + later)
        if mover_depth(env, there, ahead + later, support) > -radius:
            return True
    return False


@kernel
def judge_place(
    env: EnvironmentTable,
    settings: PlanSettings,
    request: StepRequest,
    legs: OtherLegs,
    legs_ahead: LegsAhead,
    ground: GroundScratch,
    x: float,
    z: float,
) -> tuple[float, float]:
    """Return a place's score in [0, 1] (REJECTED: it cannot be stood on) and its exact height (m).

    Args:
        env: the world.
        settings: margins and weights.
        request: the step.
        legs: the other legs, of which `request.other_foot_count` segments count.
        legs_ahead: all of them as they will be.
        ground: scratch.
        x: world x, m.
        z: world z, m.
    """
    ahead = landing_time(request)
    y, support = surface_at(env, x, z, ahead)
    reach = reach_score(settings, request, Vec3(x, y, z))
    foot = foot_shape(request)
    # The middle of the foot's shape, which is not always where its sole is.
    at_x = x + foot.middle_x
    at_z = z + foot.middle_z
    if reach < 0.0 or is_foot_wet(env, foot, at_x, at_z):
        return REJECTED, y
    leg = request.leg_length
    margin = foot.radius + settings.forbidden_margin * leg
    if is_forbidden_at(env, at_x, at_z, margin, ahead):
        return REJECTED, y
    if env.mover_count > 0 and is_run_over(env, request, settings, support, Vec3(x, y, z), ahead):
        return REJECTED, y
    even = edge = leave = 1.0
    flat = env.terrain_range[0] == env.terrain_range[1]
    wide = 1.5 * (foot.radius + max(settings.edge, settings.toe) * leg)
    count = obstacles_near(
        env, at_x - wide, at_z - wide, at_x + wide, at_z + wide, LOWEST, ground.near
    )
    if not flat or count > 0:
        middle, _ = surface_at(env, at_x, at_z, ahead)
        tread, rough = lay_tread(env, settings, foot, leg, Vec3(at_x, middle, at_z), ahead)
        even = even_score(env, tread, rough, settings.slope)
        if even < 0.0 or not is_borne(env, tread, count, ground):
            return REJECTED, y
        edge = edge_score(
            env, foot, settings.edge * leg, settings.slope, settings.drop * leg, at_x, middle,
            at_z, ahead,
        )  # fmt: skip
    course_x = request.hip_end_of_stance.x - request.hip_touchdown.x
    course_z = request.hip_end_of_stance.z - request.hip_touchdown.z
    step = math.hypot(course_x, course_z)
    high = y + TOO_HIGH * request.reach_max
    if step > SHORTEST_COURSE * leg and (
        env.terrain_range[1] > high
        or obstacles_near(env, x - step, z - step, x + step, z + step, high, ground.near) > 0
    ):
        heading = math.atan2(course_x, course_z)
        leave = exit_score(env, margin, x, z, high, heading, step, ahead)
    factor = leg_factor(settings, request, legs, legs_ahead, Vec3(x, y, z))
    if factor < 0.0:
        return REJECTED, y
    away = math.hypot(x - request.preferred_world.x, z - request.preferred_world.z)
    close = max(1.0 - away / max(request.search_radius, 1e-300), 0.0)
    level = max(1.0 - abs(y - request.level_height) / (settings.rise * leg), 0.0)
    whole = (
        request.level_weight
        + settings.weight_distance
        + settings.weight_even
        + settings.weight_edge
        + settings.weight_reach
        + settings.weight_escape
    )
    score = (
        request.level_weight * level
        + settings.weight_distance * close
        + settings.weight_even * even
        + settings.weight_edge * edge
        + settings.weight_reach * reach
        + settings.weight_escape * leave
    )
    return factor * score / whole, y
