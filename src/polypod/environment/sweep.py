"""Whether a sole can be carried along a straight line without touching anything.

The sole is a level disc. Like the maps, this grows obstacles in plan and not upwards, so that a
foot may stand on a crate and slide off its edge, but not graze its side.
"""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.environment.shapes import SPHERE
from polypod.environment.table import EnvironmentTable, bucket_line, first_met, ground_height
from polypod.math.vec3 import Vec3, mix

# Deeper than this counts as touching, in half sizes of the obstacle: standing on it does not.
TOUCH = 1e-6
SHORTEST_STRETCH = 1e-9  # of a segment: the walk over sample lines always gets on


@kernel
def segment_clear(env: EnvironmentTable, start_world: Vec3, end_world: Vec3, radius: float) -> bool:
    """Say whether a level disc of `radius` metres moves from start to end inside nothing.

    Nor does it pass over a forbidden obstacle. Exact for spheres and against faces; where two faces
    of a box or hull meet, the corner grows sharp and not round, so that the answer is on the safe
    side; cylinders count as prisms with 24 sides around them. The ground is tested at the disc's
    centre, exactly: a foot tilts with the ground. Touching is clear.
    """
    if not _above_ground(env, start_world, end_world):
        return False
    if env.bucket_shape[0] == 0:
        return True
    left = bucket_line(
        env.bucket_place, env.bucket_shape, min(start_world.x, end_world.x) - radius, 0
    )
    right = bucket_line(
        env.bucket_place, env.bucket_shape, max(start_world.x, end_world.x) + radius, 0
    )
    top = bucket_line(
        env.bucket_place, env.bucket_shape, min(start_world.z, end_world.z) - radius, 1
    )
    bottom = bucket_line(
        env.bucket_place, env.bucket_shape, max(start_world.z, end_world.z) + radius, 1
    )
    for row in range(top, bottom + 1):
        for column in range(left, right + 1):
            bucket = row * env.bucket_shape[1] + column
            for i in range(env.bucket_start[bucket], env.bucket_start[bucket + 1]):
                o = env.bucket_item[i]
                if first_met(env.bucket_range, o, row, column, top, left) and _touches(
                    env, o, start_world, end_world, radius
                ):
                    return False
    return True


@kernel
def _touches(
    env: EnvironmentTable, o: int, start_world: Vec3, end_world: Vec3, radius: float
) -> bool:
    """Say whether the moving disc enters obstacle `o`, or is over it where that is forbidden."""
    if env.kind[o] == SPHERE and not env.forbidden[o]:
        return _enters_sphere(env, o, start_world, end_world, radius)
    slack = TOUCH * max(env.half_size[o, 0], env.half_size[o, 1], env.half_size[o, 2])
    move = end_world - start_world
    first = 0.0
    last = 1.0
    count = env.footprint_count[o] if env.forbidden[o] else env.plane_count[o]
    for p in range(count):
        if env.forbidden[o]:
            normal = Vec3(env.footprint_side[o, p, 0], 0.0, env.footprint_side[o, p, 1])
            limit = env.footprint_side[o, p, 2]
        else:
            normal = Vec3(env.planes[o, p, 0], env.planes[o, p, 1], env.planes[o, p, 2])
            limit = env.planes[o, p, 3]
        limit += radius * math.hypot(normal.x, normal.z) - slack
        height = normal.x * start_world.x + normal.y * start_world.y + normal.z * start_world.z
        rise = normal.x * move.x + normal.y * move.y + normal.z * move.z
        if abs(rise) > 1e-300:
            crossing = (limit - height) / rise
            if rise > 0.0:
                last = min(last, crossing)
            else:
                first = max(first, crossing)
        elif height >= limit:
            return False
        if first >= last:
            return False
    return True


@kernel
def _enters_sphere(
    env: EnvironmentTable, o: int, start_world: Vec3, end_world: Vec3, radius: float
) -> bool:
    """Search the moment at which the disc's rim is deepest in the ball's level cut.

    That depth, the plan distance less the cut's radius, is convex along the way: the root of a
    concave function is concave.
    """
    ball = env.half_size[o, 0] * (1.0 - TOUCH)
    from_centre = start_world - Vec3(env.position[o, 0], env.position[o, 1], env.position[o, 2])
    move = end_world - start_world
    first = 0.0
    last = 1.0
    # While the disc is level with the ball.
    if abs(move.y) > 1e-300:
        one = (-ball - from_centre.y) / move.y
        other = (ball - from_centre.y) / move.y
        first = max(first, min(one, other))
        last = min(last, max(one, other))
    elif abs(from_centre.y) >= ball:
        return False
    if first >= last:
        return False
    for _ in range(60):
        early = first + (last - first) / 3.0
        late = last - (last - first) / 3.0
        gap_early = _gap_to_ball(from_centre + move * early, ball, radius)
        gap_late = _gap_to_ball(from_centre + move * late, ball, radius)
        if gap_early < 0.0 or gap_late < 0.0:
            return True
        if gap_early < gap_late:
            last = late
        else:
            first = early
    return False


@kernel
def _gap_to_ball(from_centre: Vec3, ball: float, radius: float) -> float:
    """Return the plan distance between a level disc and the ball's cut at its height."""
    cut = math.sqrt(max(ball * ball - from_centre.y * from_centre.y, 0.0))
    return math.hypot(from_centre.x, from_centre.z) - cut - radius


@kernel
def _above_ground(env: EnvironmentTable, start_world: Vec3, end_world: Vec3) -> bool:
    """Say whether a segment is nowhere below the terrain.

    Over each patch the ground along the line is a parabola, so that its three values in a stretch
    between sample lines give the least gap exactly.
    """
    cell = env.terrain_place[2]
    slack = 1e-9 * (cell + abs(start_world.y) + abs(end_world.y))
    if min(start_world.y, end_world.y) >= env.terrain_range[1] - slack:
        return True
    rows, columns = env.heights.shape
    u = (start_world.x - env.terrain_place[0]) / cell
    v = (start_world.z - env.terrain_place[1]) / cell
    move_u = (end_world.x - start_world.x) / cell
    move_v = (end_world.z - start_world.z) / cell
    now = 0.0
    gap = start_world.y - ground_height(env, start_world.x, start_world.z)
    if gap < -slack:
        return False
    while now < 1.0:
        then = min(_next_line(u, move_u, now, columns), _next_line(v, move_v, now, rows))
        then = max(then, now + SHORTEST_STRETCH)
        middle_world = mix(start_world, end_world, 0.5 * (now + then))
        then_world = mix(start_world, end_world, then)
        gap_middle = middle_world.y - ground_height(env, middle_world.x, middle_world.z)
        gap_then = then_world.y - ground_height(env, then_world.x, then_world.z)
        least = min(gap_middle, gap_then)
        # gap(s) = gap + b s + a s^2 for s from 0 to 1.
        a = 2.0 * (gap + gap_then - 2.0 * gap_middle)
        b = gap_then - gap - a
        if a > 0.0 and b < 0.0 and -b < 2.0 * a:
            least = min(least, gap - b * b / (4.0 * a))
        if least < -slack:
            return False
        gap = gap_then
        now = then
    return True


@kernel
def _next_line(place: float, move: float, now: float, count: int) -> float:
    """Return the time, up to 1, at which a coordinate in samples next crosses a sample line."""
    if abs(move) < 1e-300:
        return 1.0
    here = place + move * now
    # A hair ahead, so that rounding at a line does not find the same line again.
    hair = 1e-9 * (1.0 + abs(here))
    line = math.floor(here + hair) + 1.0 if move > 0.0 else math.ceil(here - hair) - 1.0
    if move > 0.0:
        line = max(line, 0.0)
        if line > count - 1.0:
            return 1.0
    else:
        line = min(line, count - 1.0)
        if line < 0.0:
            return 1.0
    return min(max((line - place) / move, now), 1.0)
