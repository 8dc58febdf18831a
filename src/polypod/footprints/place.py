"""How good a place is for a foot, judged by the true shapes (P1 section 5.1)."""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.environment.movers import mover_depth
from polypod.environment.table import (
    EnvironmentTable,
    is_forbidden_at,
    is_wet,
    surface_at,
)
from polypod.footprints.settings import (
    FootShape,
    PlanSettings,
    StepRequest,
    foot_shape,
    landing_time,
)
from polypod.math.vec3 import Vec3, distance
from polypod.paths.apart import LegsAhead, place_factor
from polypod.paths.check import leg_gap
from polypod.paths.near import obstacles_near
from polypod.paths.scratch import OtherLegs

REJECTED = -1.0
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
def even_score(
    env: EnvironmentTable,
    foot: FootShape,
    toe: float,
    steepest: float,
    tolerance: float,
    x: float,
    y: float,
    z: float,
    ahead: float,
) -> float:
    """Return 1 for a plane under the foot's shape down to 0 at the tolerance; REJECTED beyond.

    Four points on the shape's outline give the plane; four more, further out, tell what part of the
    surroundings continues it: beside an edge or a wall the score falls to half.
    """
    sine = foot.sine
    cosine = foot.cosine
    half_x = foot.half_x + toe
    half_z = foot.half_z + toe
    east, _ = surface_at(env, x + half_x * cosine, z - half_x * sine, ahead)
    west, _ = surface_at(env, x - half_x * cosine, z + half_x * sine, ahead)
    north, _ = surface_at(env, x + half_z * sine, z + half_z * cosine, ahead)
    south, _ = surface_at(env, x - half_z * sine, z - half_z * cosine, ahead)
    slope_x = (east - west) / (2.0 * half_x)
    slope_z = (north - south) / (2.0 * half_z)
    if slope_x * slope_x + slope_z * slope_z > steepest * steepest:
        return REJECTED
    rough = max(abs(east + west - 2.0 * y), abs(north + south - 2.0 * y)) * 0.5
    for corner in range(4):
        a = half_x if corner < 2 else -half_x
        b = half_z if corner % 2 == 0 else -half_z
        height, _ = surface_at(env, x + a * cosine + b * sine, z - a * sine + b * cosine, ahead)
        rough = max(rough, abs(height - y - slope_x * a - slope_z * b))
    return REJECTED if rough > tolerance else 1.0 - rough / tolerance


@kernel
def edge_score(
    env: EnvironmentTable,
    foot: FootShape,
    out: float,
    steepest: float,
    drop: float,
    x: float,
    y: float,
    z: float,
    ahead: float,
) -> float:
    """Return the share of a ring about the foot that continues its surface without edge or wall."""
    ring_x = foot.half_x + out
    ring_z = foot.half_z + out
    good = 0.0
    for k in range(4):
        # Opposite points: on any slope their mean is the height between them.
        a = ring_x * (1.0 if k == 0 else (0.7 if k != 2 else 0.0))
        b = ring_z * (1.0 if k == 2 else (0.7 if k == 1 else (-0.7 if k == 3 else 0.0)))
        dx = a * foot.cosine + b * foot.sine
        dz = -a * foot.sine + b * foot.cosine
        there, _ = surface_at(env, x + dx, z + dz, ahead)
        opposite, _ = surface_at(env, x - dx, z - dz, ahead)
        steep = max(abs(there - y), abs(opposite - y)) > steepest * math.hypot(dx, dz)
        if abs(there + opposite - 2.0 * y) <= drop and not steep:
            good += 0.25
    return good


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
    """Return whether the middle or a corner of the foot's shape lies in water."""
    if env.water.shape[0] == 0:
        return False
    for corner in range(5):
        a = foot.half_x * (0.0 if corner == 4 else (1.0 if corner < 2 else -1.0))
        b = foot.half_z * (0.0 if corner == 4 else (1.0 if corner % 2 == 0 else -1.0))
        at_x = x + a * foot.cosine + b * foot.sine
        if is_wet(env, at_x, z - a * foot.sine + b * foot.cosine):
            return True
    return False


@kernel
def leg_factor(
    settings: PlanSettings,
    request: StepRequest,
    legs: OtherLegs,
    legs_ahead: LegsAhead,
    place: Vec3,
) -> float:
    """Return 1, less where legs come near or cross, or REJECTED where another is in the place."""
    leg = request.leg_length
    foot = max(request.foot_half_x, request.foot_half_z)
    for s in range(request.other_foot_count):
        clear = legs.radius[s] + foot + settings.leg_gap * leg
        gap = leg_gap(legs, s, place.x, place.z)
        if gap < clear:
            at_start = leg_gap(legs, s, request.start_world.x, request.start_world.z)
            if gap < 0.999 * at_start:
                return REJECTED
    # Its own side of the body: no further across than the preferred place is out.
    side = request.side
    away = place - request.body_position
    out = away.x * side.x + away.z * side.z
    wanted = (request.preferred_world.x - request.body_position.x) * side.x + (
        request.preferred_world.z - request.body_position.z
    ) * side.z
    factor = place_factor(legs_ahead, request, place)
    return factor * settings.crossing if out < min(0.0, wanted) else factor


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
    leaving = distance(effector, request.hip_end_of_stance)
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
    drift = Vec3(0.0, 0.0, 0.0)
    if support >= 0:
        drift = Vec3(env.velocity[support, 0], env.velocity[support, 1], env.velocity[support, 2])
    leg = request.leg_length
    over = place + Vec3(0.0, ON_FOOT * leg, 0.0)
    radius = max(request.foot_half_x, request.foot_half_z) + settings.forbidden_margin * leg
    for k in range(1, STAND_SAMPLES + 1):
        later = request.stance_seconds * SAFE_STANCE * k / STAND_SAMPLES
        if mover_depth(env, over + drift * later, ahead + later, support) > -radius:
            return True
    return False


@kernel
def judge_place(
    env: EnvironmentTable,
    settings: PlanSettings,
    request: StepRequest,
    legs: OtherLegs,
    legs_ahead: LegsAhead,
    near: Any,
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
        near: scratch for a list of obstacles.
        x: world x, m.
        z: world z, m.
    """
    ahead = landing_time(request)
    y, support = surface_at(env, x, z, ahead)
    reach = reach_score(settings, request, Vec3(x, y, z))
    foot = foot_shape(request)
    if reach < 0.0 or is_foot_wet(env, foot, x, z):
        return REJECTED, y
    leg = request.leg_length
    margin = foot.radius + settings.forbidden_margin * leg
    if is_forbidden_at(env, x, z, margin, ahead):
        return REJECTED, y
    if env.mover_count > 0 and is_run_over(env, request, settings, support, Vec3(x, y, z), ahead):
        return REJECTED, y
    even = edge = leave = 1.0
    flat = env.terrain_range[0] == env.terrain_range[1]
    wide = 1.5 * (foot.radius + max(settings.edge, settings.toe) * leg)
    if not flat or obstacles_near(env, x - wide, z - wide, x + wide, z + wide, LOWEST, near) > 0:
        tolerance = settings.uneven * leg + settings.uneven_foot * foot.radius
        even = even_score(env, foot, settings.toe * leg, settings.slope, tolerance, x, y, z, ahead)
        if even < 0.0:
            return REJECTED, y
        edge = edge_score(
            env, foot, settings.edge * leg, settings.slope, settings.drop * leg, x, y, z, ahead
        )
    course_x = request.hip_end_of_stance.x - request.hip_touchdown.x
    course_z = request.hip_end_of_stance.z - request.hip_touchdown.z
    step = math.hypot(course_x, course_z)
    high = y + TOO_HIGH * request.reach_max
    if step > SHORTEST_COURSE * leg and (
        env.terrain_range[1] > high
        or obstacles_near(env, x - step, z - step, x + step, z + step, high, near) > 0
    ):
        heading = math.atan2(course_x, course_z)
        leave = exit_score(env, margin, x, z, high, heading, step, ahead)
    factor = leg_factor(settings, request, legs, legs_ahead, Vec3(x, y, z))
    if factor < 0.0:
        return REJECTED, y
    away = math.hypot(x - request.preferred_world.x, z - request.preferred_world.z)
    near = max(1.0 - away / max(request.search_radius, 1e-300), 0.0)
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
        + settings.weight_distance * near
        + settings.weight_even * even
        + settings.weight_edge * edge
        + settings.weight_reach * reach
        + settings.weight_escape * leave
    )
    return factor * score / whole, y
