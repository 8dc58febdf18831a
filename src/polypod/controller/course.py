"""On which course, and how fast, a body passes what is forbidden and who is in its way."""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.controller.steering import plan_pose
from polypod.crowd.avoid import FORESIGHT, PATIENCE, threat
from polypod.environment.table import is_forbidden, surface
from polypod.routes.aim import aim_at
from polypod.routes.passable import SQUEEZE, highest_step

# What lies ahead is looked at so many leg lengths far, in so many places, along a fan of courses;
# a course costs by what blocks it (2 for all of it), by its angle and by how new it is, per rad.
LOOK = 2.5
LOOK_SAMPLES = 8
LOOK_SIDES = 6
LOOK_ANGLE = 0.22
DETOUR_COST = 0.35
CHANGE_COST = 0.15
# Where other creatures are in the way, it also costs how soon it meets them, and to go slower.
THREAT_COST = 2.0
PACE_COST = 1.0
PACE_CHANGE_COST = 0.3
PACES = 3
# Then the fan is wider, to get by who stands close; and a turn to the right costs so much more: of
# two whose ways cross one then goes before and the other behind, where else both would turn along.
COMPANY_SIDES = 10
RIGHT_COST = 1.5


@kernel
def way_free(x: float, z: float, course: float, margin: float, reach: float, env: Any) -> float:
    """Return the share of a straight way of `reach` metres that no forbidden thing narrows."""
    for i in range(1, LOOK_SAMPLES + 1):
        along = reach * i / LOOK_SAMPLES
        if is_forbidden(env, x + math.sin(course) * along, z + math.cos(course) * along, margin):
            return (i - 1.0) / LOOK_SAMPLES
    return 1.0


@kernel
def way_low(
    x: float, z: float, course: float, half: float, level: float, climb: float, reach: float,
    env: Any,
) -> float:  # fmt: skip
    """Return the share of a straight way of `reach` m on which nothing is too high to step onto.

    From ground of height `level`, up by at most `climb` m at each sample; the way is looked at
    along both of its sides, `half` m from the middle.
    """
    share = 1.0
    for side in range(2):
        out = half if side == 0 else -half
        from_x = x + math.cos(course) * out
        from_z = z - math.sin(course) * out
        below = level
        for i in range(1, LOOK_SAMPLES + 1):
            along = reach * i / LOOK_SAMPLES
            place_x = from_x + math.sin(course) * along
            height, _ = surface(env, place_x, from_z + math.cos(course) * along)
            if height > below + climb:
                share = min(share, (i - 1.0) / LOOK_SAMPLES)
                break
            below = height
    return share


@kernel
def price_paces(
    c: int, near: int, direction: float, cost: float, least: float, room: float,
    state: Any, command: Any, tables: Any, scratch: Any,
) -> tuple[float, float]:  # fmt: skip
    """Return what a course costs at its best pace among others, and that pace: 1, 1/2 or 0.

    `cost` is what the course costs alone, and `least` what others do; dearer ones are not looked at
    closely. `room` is the share of the room for feet that is kept from others.
    """
    horizon = FORESIGHT * tables.pendulum_time
    cheapest = math.inf
    pace = 1.0
    for slower in range(PACES):
        share = 1.0 - slower / (PACES - 1.0)
        whole = cost + PACE_COST * (1.0 - share) + PACE_CHANGE_COST * abs(share - state.pace[c])
        if whole < min(least, cheapest):
            speed = command.speed[c] * share
            x = math.sin(direction) * speed
            z = math.cos(direction) * speed
            whole += THREAT_COST * threat(state.member[c], near, x, z, room, horizon, scratch)
        if whole < cheapest:
            cheapest = whole
            pace = share
    return cheapest, pace


@kernel
def choose_course(
    c: int, near: int, state: Any, command: Any, tables: Any, settings: Any, env: Any, scratch: Any
) -> tuple[float, float]:
    """Return the angle from the heading asked for, rad, and the share of the speed, to go on at.

    Of a fan of courses the freest near to the wished one is taken, by a plain look at the way that
    the feet take, or the body of a sprawler, whose feet find their own ways beside it; and at what
    the `near` creatures listed in the scratch will do. Who steps aside for others does not step
    against a wall.
    """
    if env.forbidden_count == 0 and near == 0:
        return 0.0, 1.0
    pose = plan_pose(c, state)
    course = command.heading[c]
    margin = tables.track
    reach = LOOK * tables.leg_length
    if command.waypoint_count[c] > 0:
        aim = aim_at(pose.x, pose.z, state.waypoint[c], state.route.corner[c], c, state, command)
        course = math.atan2(aim.to_x, aim.to_z) - command.travel[c]
        margin = state.route.margin[c]
        # What lies behind the place where it turns is not in its way.
        reach = min(reach, math.hypot(aim.to_x, aim.to_z))
    patience = 1.0 + state.yielded[c] / (PATIENCE * tables.pendulum_time)
    room = settings.personal_space / patience
    level = state.plane_height[c]
    climb = highest_step(tables)
    best = 0.0
    pace = 1.0
    least = math.inf
    sides = COMPANY_SIDES if near > 0 else LOOK_SIDES
    for i in range(2 * sides + 1):
        aside = LOOK_ANGLE * ((i + 1) // 2) * (1.0 if i % 2 == 1 else -1.0)
        angle = state.shy[c] + aside
        direction = course + command.travel[c] + angle
        free = way_free(pose.x, pose.z, direction, margin, reach, env)
        if near > 0 and least < math.inf:
            half = SQUEEZE * tables.track
            low = way_low(pose.x, pose.z, direction, half, level, climb, reach, env)
            free = min(free, low)
        blocked = 1.0 - free
        change = abs(angle - state.detour[c])
        turn = abs(aside)
        if near > 0 and aside < 0.0:
            turn *= RIGHT_COST
        cost = 2.0 * blocked + DETOUR_COST * turn + CHANGE_COST * change
        whole, share = cost, 1.0
        if near > 0:
            whole, share = price_paces(
                c, near, direction, cost, least, room, state, command, tables, scratch
            )
        if whole < least:
            least = whole
            best = angle
            pace = share
        if least <= 0.0:
            break
    return best, pace
