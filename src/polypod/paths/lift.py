"""From a path in plan to three dimensions: requirement, upper hull, knots (P1 Figure 10b)."""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.environment.table import (
    EnvironmentTable,
    ground_height,
    is_forbidden_at,
    surface,
    surface_at,
)
from polypod.footprints.settings import FootShape, PlanSettings, StepRequest, foot_shape
from polypod.math.vec3 import Vec3, distance, dot, length, load_vec3, store_vec3
from polypod.paths.curve import PATH_KNOTS, PathRow, seconds_ahead
from polypod.paths.hull import hull_curve, upper_hull
from polypod.paths.near import meets_near, obstacles_near
from polypod.paths.scratch import LiftScratch

LAST = PATH_KNOTS - 1
# A step on the spot still needs a length to lay its knots on, leg lengths.
SHORTEST = 0.05
# Latest point of the step's arc at which a path that starts in the air may begin, radians.
LATEST_START = 0.8 * math.pi
# Elevations are sampled along the path at most this far apart, leg lengths.
SAMPLE = 0.02
# Feet with larger half extents clear the ground with all of their shape, leg lengths.
BROAD = 0.03
# A path that starts moving turns from that direction to its own within this share of its length.
BLEND = 0.35


@kernel
def arc_start(env: EnvironmentTable, request: StepRequest, end_y: float) -> tuple[float, float]:
    """Return where on the step's arc the path begins (rad) and the arc's height (m).

    A foot that lifts off begins at 0. One that is in the air already (a replan) begins where the
    arc is as high over the ground as the foot is, rising or sinking as the foot does.
    """
    height = request.step_height
    if length(request.start_velocity) <= 0.0:
        return 0.0, height
    ground, _ = surface(env, request.start_world.x, request.start_world.z)
    above = request.start_world.y - min(ground, end_y)
    if above <= 0.0:
        return 0.0, height
    height = max(height, above)
    phase = math.asin(above / height)
    if request.start_velocity.y < 0.0:
        phase = min(math.pi - phase, LATEST_START)
        height = above / math.sin(phase)
    return phase, height


@kernel
def place_knots(
    lift: LiftScratch,
    points: int,
    start: Vec3,
    end: Vec3,
    shortest: float,
    phase: float,
    height: float,
) -> None:
    """Lay the knots along the plan, closer at the ends, and the step-height arc over them.

    `lift.plan[:points]` holds the path in plan with its lengths. The arc is half an ellipse over
    the line from start to end: feet leave and land steeply. Even a step on the spot has
    stations `shortest` m long.
    """
    total = lift.plan[points - 1, 2]
    start_cosine = math.cos(phase)
    base = start.y - height * math.sin(phase)
    longest = max(total, shortest)
    piece = 0
    for k in range(PATH_KNOTS):
        angle = phase + (math.pi - phase) * k / LAST
        share = (start_cosine - math.cos(angle)) / (start_cosine + 1.0)
        lift.station[k] = share * longest
        lift.arc[k] = base + (end.y - base) * share + height * math.sin(angle)
        at = share * total
        while piece < points - 2 and lift.plan[piece + 1, 2] < at:
            piece += 1
        span = lift.plan[piece + 1, 2] - lift.plan[piece, 2]
        lift.knot[k, 0] = lift.plan[piece, 0]
        lift.knot[k, 1] = lift.plan[piece, 1]
        lift.knot[k, 2] = 0.0
        lift.knot[k, 3] = 0.0
        if span > 0.0:
            u = (at - lift.plan[piece, 2]) / span
            # The direction is that of the chord over the neighbouring pieces: no kinks.
            before = max(piece - 1, 0) if u < 0.5 else piece
            after = min(piece + 1, points - 2) if u >= 0.5 else piece
            wide = lift.plan[after + 1, 2] - lift.plan[before, 2]
            for axis in range(2):
                step = lift.plan[piece + 1, axis] - lift.plan[piece, axis]
                lift.knot[k, axis] += step * u
                chord = lift.plan[after + 1, axis] - lift.plan[before, axis]
                lift.knot[k, 2 + axis] = chord / wide * (total / longest)
    lift.arc[0] = start.y
    lift.arc[LAST] = end.y


@kernel
def foot_top(
    env: EnvironmentTable, foot: FootShape, x: float, z: float, grow: float, ahead: float
) -> float:
    """Return the highest surface under a foot's shape grown by `grow` (m; negative shrinks it)."""
    top, _ = surface_at(env, x, z, ahead)
    half_x = max(foot.half_x + grow, 0.0)
    half_z = max(foot.half_z + grow, 0.0)
    if half_x == 0.0 and half_z == 0.0:
        return top
    for corner in range(4):
        a = half_x if corner < 2 else -half_x
        b = half_z if corner % 2 == 0 else -half_z
        at_x = x + a * foot.cosine + b * foot.sine
        at, _ = surface_at(env, at_x, z - a * foot.sine + b * foot.cosine, ahead)
        top = max(top, at)
    return top


@kernel
def require(
    env: EnvironmentTable, settings: PlanSettings, request: StepRequest, lift: LiftScratch
) -> bool:
    """Write what the path must clear; return False where it meets something forbidden.

    The foot's shape and the clearance come in over the first and last stretch: where the sole
    stands it touches the ground and fits between its neighbours. Obstacles that are too far away or
    lower than the step's arc are not asked.
    """
    leg = request.leg_length
    foot = foot_shape(request)
    full = foot.radius + settings.toe * leg
    barred = full + settings.forbidden_margin * leg
    clearance = settings.clearance * leg
    wide = 1.5 * full + settings.forbidden_margin * leg + request.foot_behind
    x0 = x1 = lift.knot[0, 0]
    z0 = z1 = lift.knot[0, 1]
    lowest = lift.arc[0]
    for k in range(1, PATH_KNOTS):
        x0 = min(x0, lift.knot[k, 0])
        x1 = max(x1, lift.knot[k, 0])
        z0 = min(z0, lift.knot[k, 1])
        z1 = max(z1, lift.knot[k, 1])
        lowest = min(lowest, lift.arc[k])
    count = obstacles_near(env, x0 - wide, z0 - wide, x1 + wide, z1 + wide, lowest, lift.near)
    listed = min(count, lift.near.shape[0])
    level = env.terrain_range[0] == env.terrain_range[1]
    # A long foot on uneven ground: what its sole passes over is not all that it must clear.
    broad = not level and request.clears_whole and foot.radius > BROAD * leg
    total = lift.station[LAST]
    stretch = 2.0 * full + clearance
    for k in range(1, PATH_KNOTS):
        span = lift.station[k] - lift.station[k - 1]
        samples = 1 if level and count == 0 else math.ceil(span / (SAMPLE * leg))
        arc = min(lift.arc[k - 1], lift.arc[k])
        ahead = 0.0
        if env.mover_count > 0:
            ahead = seconds_ahead(request, lift.station[k] / total)
        top = -1e300
        for j in range(samples):
            u = (j + 1.0) / samples
            at = lift.station[k - 1] + span * u
            share = min(min(at, total - at) / stretch, 1.0)
            x = lift.knot[k - 1, 0] + (lift.knot[k, 0] - lift.knot[k - 1, 0]) * u
            z = lift.knot[k - 1, 1] + (lift.knot[k, 1] - lift.knot[k - 1, 1]) * u
            met = 2
            if count == listed:
                met = meets_near(env, lift.near, count, x, z, wide, arc - clearance)
            at_x = x + foot.middle_x * share
            at_z = z + foot.middle_z * share
            if met == 2 and is_forbidden_at(env, at_x, at_z, barred * share, ahead):
                return False
            height = ground_height(env, x, z)
            if met > 0 or broad:
                top_there = foot_top(env, foot, at_x, at_z, full * share - foot.radius, ahead)
                height = max(height, top_there)
            top = max(top, height + clearance * share)
        lift.ground[k] = top
    lift.need[0] = lift.arc[0]
    lift.need[LAST] = lift.arc[LAST]
    for k in range(1, LAST):
        clear = max(lift.ground[k], lift.ground[k + 1])
        lift.need[k] = max(lift.arc[k], clear) + lift.extra[k]
    return True


@kernel
def write_knots(lift: LiftScratch, velocity: Vec3, blend: float, path: PathRow) -> None:
    """Write the path over the lifted knots, its tangents and its arc length.

    `blend` is the share of the path over which it turns from the velocity it starts with to its own
    direction; 0 where that is not asked.
    """
    for k in range(PATH_KNOTS):
        store_vec3(path.point[k], Vec3(lift.knot[k, 0], lift.height[k], lift.knot[k, 1]))
        along = Vec3(lift.knot[k, 2], lift.slope[k], lift.knot[k, 3])
        size = length(along)
        store_vec3(path.tangent[k], along * (1.0 / size) if size > 1e-9 else Vec3(0.0, 0.0, 0.0))
    speed = length(velocity)
    if blend > 0.0 and speed > 0.0:
        total = 0.0
        for k in range(1, PATH_KNOTS):
            total += distance(load_vec3(path.point[k - 1]), load_vec3(path.point[k]))
        turn = velocity * (1.0 / speed) - load_vec3(path.tangent[0])
        span = blend * total
        at = 0.0
        before = load_vec3(path.point[0])
        for k in range(PATH_KNOTS):
            point = load_vec3(path.point[k])
            at += distance(before, point)
            before = point
            rest = 1.0 - at / span
            if rest <= 0.0:
                break
            store_vec3(path.point[k], point + turn * (at * rest * rest * rest))
            bent = load_vec3(path.tangent[k]) + turn * (rest * rest * (4.0 * rest - 3.0))
            store_vec3(path.tangent[k], bent * (1.0 / max(length(bent), 1e-9)))
    finish_path(path)


@kernel
def finish_path(path: PathRow) -> None:
    """Turn unit tangents into derivatives with respect to progress; write lengths and count."""
    path.count[0] = PATH_KNOTS
    path.fraction[0] = 0.0
    at = 0.0
    for k in range(1, PATH_KNOTS):
        chord = distance(load_vec3(path.point[k - 1]), load_vec3(path.point[k]))
        # An arc that turns by t is longer than its chord by t t / 24, and t t is about 2 - 2 cos t.
        cosine = dot(load_vec3(path.tangent[k - 1]), load_vec3(path.tangent[k]))
        at += chord * (1.0 + (1.0 - cosine) / 12.0)
        path.fraction[k] = at
    path.length[0] = at
    for k in range(PATH_KNOTS):
        path.fraction[k] = path.fraction[k] / at if at > 0.0 else k / LAST
        store_vec3(path.tangent[k], load_vec3(path.tangent[k]) * at)
    path.fraction[LAST] = 1.0


@kernel
def lift_path(
    env: EnvironmentTable,
    settings: PlanSettings,
    request: StepRequest,
    lift: LiftScratch,
    blend: float,
    path: PathRow,
) -> bool:
    """Write the 3D path over the placed knots; return False where it meets something forbidden."""
    if not require(env, settings, request, lift):
        return False
    corners = upper_hull(lift.station, lift.need, PATH_KNOTS, lift.hull)
    hull_curve(lift.station, lift.need, lift.hull, corners, lift.height, lift.slope)
    write_knots(lift, request.start_velocity, blend, path)
    return True


@kernel
def straight_plan(lift: LiftScratch, start: Vec3, end: Vec3) -> int:
    """Write the straight line in plan and return how many points it has."""
    points = 0
    for point in (start, end):
        lift.plan[points, 0] = point.x
        lift.plan[points, 1] = point.z
        lift.plan[points, 2] = 0.0
        points += 1
    lift.plan[1, 2] = math.hypot(end.x - start.x, end.z - start.z)
    return points
