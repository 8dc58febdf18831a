"""The body on the ground plane: where it goes next, and where it will be (P1 3.2).

`steer` is one pure step; `predict` is `steer` applied ahead, and is what every look ahead asks.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from polypod.compute import kernel
from polypod.environment.table import is_forbidden
from polypod.math.vec3 import Vec3

PREDICTION_STEPS = 8
# A waypoint counts as reached within this many leg lengths, so that a corner is cut, not circled.
WAYPOINT_RADIUS = 0.5
# Closer than this to the last waypoint the heading is kept: its direction is noise.
HEADING_RADIUS = 0.3
# What lies ahead is looked at so many leg lengths far, in so many places, along a fan of courses;
# a course costs by what blocks it (2 for all of it), by its angle and by how new it is, per rad.
LOOK = 2.5
LOOK_SAMPLES = 8
LOOK_SIDES = 6
LOOK_ANGLE = 0.22
DETOUR_COST = 0.35
CHANGE_COST = 0.15
# A body that its legs hold back slows down so many times as fast as it accelerates.
SLOWING = 3.0
# Where it gets at less than this share of its speed; less is made up for within a step.
HELD_BACK = 0.5
# Where it gets at less than this share of its speed it steps quicker, by so much more for each gait
# cycle's time spent so, up to a limit: quicker steps are shorter.
UNHURRIED = 0.93
HURRY = 1.2
MOST_HURRY = 0.5
# A usual gait cycle, leg pendulum times.
CYCLE = 2.5


class PlanPose(NamedTuple):
    """The body on the ground plane: where it is and how it moves."""

    x: float
    z: float
    heading: float  # rad about +Y from +Z toward +X
    turn_rate: float  # rad/s
    speed: float  # m/s along the direction of travel
    waypoint: float  # index of the waypoint being approached
    detour: float  # rad by which the heading asked for is left aside, to pass what is forbidden


@kernel
def wrapped(angle: float) -> float:
    """Return the angle in (-pi, pi]."""
    return math.atan2(math.sin(angle), math.cos(angle))


@kernel
def way_left(x: float, z: float, waypoint: int, c: int, command: Any) -> float:
    """Return the length of the way from a point over the waypoints from `waypoint` on, metres."""
    total = 0.0
    for i in range(waypoint, command.waypoint_count[c]):
        to_x = command.waypoints[c, i, 0]
        to_z = command.waypoints[c, i, 1]
        total += math.hypot(to_x - x, to_z - z)
        x = to_x
        z = to_z
    return total


@kernel
def acceleration_limit(c: int, speed: float, command: Any, tables: Any, settings: Any) -> float:
    """Return the greatest change of speed, m/s^2: a share of the speed in a gait cycle.

    A cycle is taken as what a walk's usually is, so that the limit does not depend on the gait.
    """
    slowest = 0.1 * tables.leg_length / tables.pendulum_time
    most = max(abs(speed), command.speed[c], slowest)
    return settings.acceleration * most / (CYCLE * tables.pendulum_time)


@kernel
def way_free(x: float, z: float, course: float, margin: float, reach: float, env: Any) -> float:
    """Return the share of a straight way of `reach` metres that no forbidden thing narrows."""
    for i in range(1, LOOK_SAMPLES + 1):
        along = reach * i / LOOK_SAMPLES
        if is_forbidden(env, x + math.sin(course) * along, z + math.cos(course) * along, margin):
            return (i - 1.0) / LOOK_SAMPLES
    return 1.0


@kernel
def detour(c: int, state: Any, command: Any, tables: Any, env: Any) -> float:
    """Return the angle from the heading asked for at which feet can pass what is forbidden, rad.

    Of a fan of courses the freest near to the wished one is taken, by a plain look at the way that
    the feet take, or the body of a sprawler, whose feet find their own ways beside it.
    """
    if env.forbidden_count == 0:
        return 0.0
    pose = plan_pose(c, state)
    course = command.heading[c]
    if command.waypoint_count[c] > 0:
        to_x = command.waypoints[c, state.waypoint[c], 0] - pose.x
        to_z = command.waypoints[c, state.waypoint[c], 1] - pose.z
        course = math.atan2(to_x, to_z) - command.travel[c]
    reach = LOOK * tables.leg_length
    best = 0.0
    least = math.inf
    for i in range(2 * LOOK_SIDES + 1):
        angle = LOOK_ANGLE * ((i + 1) // 2) * (1.0 if i % 2 == 1 else -1.0)
        direction = course + command.travel[c] + angle
        blocked = 1.0 - way_free(pose.x, pose.z, direction, tables.track, reach, env)
        change = abs(angle - state.detour[c])
        cost = 2.0 * blocked + DETOUR_COST * abs(angle) + CHANGE_COST * change
        if cost < least:
            least = cost
            best = angle
    return best


@kernel
def steer(pose: PlanPose, c: int, command: Any, tables: Any, settings: Any, dt: float) -> PlanPose:
    """Return the pose on the plane `dt` seconds later.

    The turn rate approaches what removes the error of heading, and the speed what was asked for,
    within bounds that scale with the animal; it stops at the last waypoint.
    """
    pendulum = tables.pendulum_time
    acceleration = acceleration_limit(c, pose.speed, command, tables, settings)
    travel = command.travel[c]
    heading_asked = command.heading[c]
    speed_asked = command.speed[c]
    waypoint = int(pose.waypoint)
    last = command.waypoint_count[c] - 1
    if last >= 0:
        to_x = command.waypoints[c, waypoint, 0] - pose.x
        to_z = command.waypoints[c, waypoint, 1] - pose.z
        if waypoint < last and math.hypot(to_x, to_z) < WAYPOINT_RADIUS * tables.leg_length:
            waypoint += 1
            to_x = command.waypoints[c, waypoint, 0] - pose.x
            to_z = command.waypoints[c, waypoint, 1] - pose.z
        heading_asked = pose.heading
        if waypoint < last or math.hypot(to_x, to_z) > HEADING_RADIUS * tables.leg_length:
            heading_asked = math.atan2(to_x, to_z) - travel
        ahead = math.sin(pose.heading + travel) * to_x + math.cos(pose.heading + travel) * to_z
        left = max(ahead, 0.0)
        if waypoint < last:
            left = way_left(pose.x, pose.z, waypoint, c, command)
        speed_asked = min(speed_asked, math.sqrt(acceleration * left), left / dt)
    error = wrapped(heading_asked + pose.detour - pose.heading)
    # Who must turn far turns first: full speed would circle round the place it is to go to.
    speed_asked *= min(1.0, max(0.1, 1.4 * math.cos(error)))
    response = settings.turn_response * pendulum
    limit = settings.turn_rate / pendulum
    rate_asked = min(limit, max(-limit, error / response))
    turn_rate = pose.turn_rate + (rate_asked - pose.turn_rate) * (
        1.0 - math.exp(-4.0 * dt / response)
    )
    change = acceleration * dt
    speed = pose.speed + min(change, max(-2.0 * change, speed_asked - pose.speed))
    heading = wrapped(pose.heading + turn_rate * dt)
    course = pose.heading + 0.5 * turn_rate * dt + travel
    advance = 0.5 * (pose.speed + speed) * dt
    return PlanPose(
        pose.x + math.sin(course) * advance,
        pose.z + math.cos(course) * advance,
        heading,
        turn_rate,
        speed,
        float(waypoint),
        pose.detour,
    )


@kernel
def plan_pose(c: int, state: Any) -> PlanPose:
    """Return the present pose of a creature on the plane."""
    return PlanPose(
        state.position[c, 0],
        state.position[c, 2],
        state.heading[c],
        state.turn_rate[c],
        state.speed[c],
        float(state.waypoint[c]),
        state.detour[c],
    )


@kernel
def store_pose(c: int, pose: PlanPose, state: Any) -> None:
    """Keep the pose at which steering wants the body at the end of the step."""
    state.steered[c, 0] = pose.x
    state.steered[c, 1] = pose.z
    state.steered[c, 2] = pose.heading
    state.steered[c, 3] = pose.turn_rate
    state.steered[c, 4] = pose.speed
    state.steered[c, 5] = pose.waypoint
    state.steered[c, 6] = pose.detour


@kernel
def load_pose(c: int, state: Any) -> PlanPose:
    """Return the pose that `store_pose` kept."""
    kept = state.steered[c]
    return PlanPose(kept[0], kept[1], kept[2], kept[3], kept[4], kept[5], kept[6])


@kernel
def predict(
    pose: PlanPose, seconds: float, c: int, command: Any, tables: Any, settings: Any
) -> PlanPose:
    """Return the pose on the plane `seconds` ahead, as `steer` will bring it about."""
    dt = seconds / PREDICTION_STEPS
    if dt < 1e-9:
        return pose
    for _ in range(PREDICTION_STEPS):
        pose = steer(pose, c, command, tables, settings, dt)
    return pose


@kernel
def note_pose(
    c: int, dt: float, pose: PlanPose, before: Vec3, state: Any, command: Any, tables: Any,
    settings: Any,
) -> None:  # fmt: skip
    """Keep what steering decided, and slow down where the legs did not let the body get there.

    `before` is where the body was. What looks ahead must know the speed that there really is, or
    feet are sent to where their body will not be.
    """
    course = pose.heading + command.travel[c]
    x = state.position[c, 0] - before.x
    z = state.position[c, 2] - before.z
    real = (math.sin(course) * x + math.cos(course) * z) / dt
    acceleration = acceleration_limit(c, pose.speed, command, tables, settings)
    # What the frame asked for: its mean speed, which steering brought about by a steady change.
    asked = 0.5 * (state.speed[c] + pose.speed)
    slower = 0.0
    if real < UNHURRIED * asked:
        state.hurry[c] = min(
            state.hurry[c] + HURRY * dt / (CYCLE * tables.pendulum_time), MOST_HURRY
        )
    if real < HELD_BACK * asked:
        slower = min(asked - real, SLOWING * acceleration * dt)
    state.turn_rate[c] = pose.turn_rate
    state.speed[c] = max(pose.speed - slower, 0.0)
    state.waypoint[c] = int(pose.waypoint)


@kernel
def feedback(c: int, state: Any, tables: Any, settings: Any) -> tuple[float, float]:
    """Return the velocity, world x and z, by which the body follows its feet (P1 3.2, Fig 7).

    The mean offset of the chosen footprints from the preferred ones, discarded while it is small
    for this morphology, made up at a share of it a gait cycle.
    """
    count = state.swinging.shape[1]
    x = 0.0
    z = 0.0
    for k in range(count):
        x += (state.foot_target[c, k, 0] - state.foot_preferred[c, k, 0]) / count
        z += (state.foot_target[c, k, 2] - state.foot_preferred[c, k, 2]) / count
    size = math.hypot(x, z)
    threshold = settings.feedback_threshold * tables.leg_length
    if size <= threshold:
        return 0.0, 0.0
    share = settings.feedback_share * state.cycle_rate[c] * (1.0 - threshold / size)
    return x * share, z * share


@kernel
def move_body(
    c: int, dt: float, state: Any, command: Any, tables: Any, settings: Any, env: Any
) -> PlanPose:
    """Return the pose on the plane at the end of the frame: steered, and refined by the feet."""
    state.detour[c] = detour(c, state, command, tables, env)
    pose = steer(plan_pose(c, state), c, command, tables, settings, dt)
    x, z = feedback(c, state, tables, settings)
    return PlanPose(
        pose.x + x * dt,
        pose.z + z * dt,
        pose.heading,
        pose.turn_rate,
        pose.speed,
        pose.waypoint,
        pose.detour,
    )
