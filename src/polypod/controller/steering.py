"""The body on the ground plane: where it goes next, and where it will be (P1 3.2).

`steer` is one pure step; `predict` is `steer` applied ahead, and is what every look ahead asks.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from polypod.body.push import (
    NO_DEFLECTION,
    Deflection,
    hold_back,
    load_deflection,
    recover,
    store_deflection,
)
from polypod.compute import kernel
from polypod.controller.turning import turn_rule
from polypod.gait.tempo import GRAVITY
from polypod.math.vec3 import Vec3, load_vec3
from polypod.routes.aim import next_aim, way_left
from polypod.spine.leading import kept_yaw

PREDICTION_STEPS = 8
# Closer than this to the last waypoint the heading is kept: its direction is noise.
HEADING_RADIUS = 0.3
# Who is so near to the last place of its path is there, leg lengths, or to where its way ends
# before that; who stands starts again only for so much. Feet that cannot stand where they would
# push the body away for ever.
STOPPED = 1e-4
STOPPED_BEFORE = 2e-3
START_AGAIN = 0.1
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
    corner: float  # index of the corner on the way there that is being approached
    detour: float  # rad by which the heading asked for is left aside, to pass what is forbidden
    pace: float  # share of the speed asked for that others leave it
    aside: Deflection  # by what a push the body is off its path; x, z, heading include it
    gone: float  # m along its way since now, of a pose ahead


@kernel
def moved_to(pose: PlanPose, x: float, z: float) -> PlanPose:
    """Return the same pose at another place."""
    return PlanPose(
        x, z, pose.heading, pose.turn_rate, pose.speed, pose.waypoint, pose.corner, pose.detour,
        pose.pace, pose.aside, pose.gone,
    )  # fmt: skip


@kernel
def unpushed(pose: PlanPose) -> PlanPose:
    """Return the pose as if no push had led the body there."""
    return PlanPose(
        pose.x, pose.z, pose.heading, pose.turn_rate, pose.speed, pose.waypoint, pose.corner,
        pose.detour, pose.pace, NO_DEFLECTION, pose.gone,
    )  # fmt: skip


@kernel
def wrapped(angle: float) -> float:
    """Return the angle in (-pi, pi]."""
    return math.atan2(math.sin(angle), math.cos(angle))


@kernel
def acceleration_limit(c: int, speed: float, command: Any, tables: Any, settings: Any) -> float:
    """Return the greatest change of speed, m/s^2: a share of the speed in a gait cycle.

    A cycle is taken as what a walk's usually is, so that the limit does not depend on the gait.
    """
    slowest = 0.1 * tables.leg_length / tables.pendulum_time
    most = max(abs(speed), command.speed[c], slowest)
    share: float = settings.acceleration * most / (CYCLE * tables.pendulum_time)
    return min(share, settings.hardest_acceleration * GRAVITY)


@kernel
def steer(
    pose: PlanPose, c: int, state: Any, command: Any, tables: Any, settings: Any, dt: float,
    propulsion: float,
) -> PlanPose:  # fmt: skip
    """Return the pose on the plane `dt` seconds later.

    The turn rate approaches what removes the error of heading, and the speed what was asked for,
    within bounds that scale with the animal; it stops at the last waypoint. All that is about the
    path; what a push led the body off it dies away beside. Of the state it reads the way that is
    known. `propulsion` scales the bound of changes of speed: 1 is the mean over a cycle. Only who
    would overrun the end of its way brakes without it.
    """
    on_x = pose.x - pose.aside.x
    on_z = pose.z - pose.aside.z
    on_heading = pose.heading - pose.aside.heading
    aside = recover(pose.aside, tables.recovery, dt)
    acceleration = acceleration_limit(c, pose.speed, command, tables, settings)
    travel = command.travel[c]
    heading_asked = command.heading[c]
    speed_asked = command.speed[c] * pose.pace
    waypoint = pose.waypoint
    corner = pose.corner
    stop = math.inf
    free = math.inf
    if command.waypoint_count[c] > 0:
        aim = next_aim(on_x, on_z, int(pose.waypoint), int(pose.corner), c, state, command, tables)
        waypoint = float(aim.waypoint)
        corner = float(aim.corner)
        away = math.hypot(aim.to_x, aim.to_z)
        # Between corners there is no room to be sure of.
        free = away if aim.corner == aim.corners else 0.0
        heading_asked = on_heading
        if not aim.stops or away > HEADING_RADIUS * tables.leg_length:
            heading_asked = math.atan2(aim.to_x, aim.to_z) - travel
        course = on_heading + travel
        left = max(math.sin(course) * aim.to_x + math.cos(course) * aim.to_z, 0.0)
        # Who goes round something does not head for the place, and is not there yet.
        if pose.detour != 0.0 and away > tables.leg_length:
            left = away
        nearest = STOPPED_BEFORE if aim.corner < aim.corners else STOPPED
        if pose.speed <= 0.0:
            nearest = START_AGAIN
        if aim.stops and left <= nearest * tables.leg_length:
            left = 0.0
        if not aim.stops:
            left = way_left(on_x, on_z, aim, c, state, command)
        stop = left
        speed_asked = min(speed_asked, math.sqrt(acceleration * left), left / dt)
    error = wrapped(heading_asked + pose.detour - on_heading)
    rule = turn_rule(c, pose.speed, speed_asked, error, free, state, tables, settings)
    speed_asked *= rule.share
    rate_asked = min(rule.limit, max(-rule.limit, error / rule.response))
    turn_rate = pose.turn_rate + (rate_asked - pose.turn_rate) * (
        1.0 - math.exp(-4.0 * dt / rule.response)
    )
    gain = propulsion * acceleration * dt
    braking = min(2.0 * acceleration, settings.hardest_acceleration * GRAVITY) * dt
    loss = propulsion * braking
    if pose.speed * pose.speed > 2.0 * acceleration * stop:
        loss = max(loss, braking)
    speed = pose.speed + min(gain, max(-loss, speed_asked - pose.speed))
    advance = 0.5 * (pose.speed + speed) * dt
    if state.led[c] and pose.gone + advance < tables.bend.kept:
        # Where the head went the body goes.
        turned = wrapped(
            state.track_from[c] + kept_yaw(c, pose.gone + advance, state, tables) - on_heading
        )
        fastest = settings.turn_rate / tables.pendulum_time
        turn_rate = min(max(turned / dt, -fastest), fastest)
    heading = wrapped(on_heading + turn_rate * dt + aside.heading)
    course = on_heading + 0.5 * turn_rate * dt + travel
    return PlanPose(
        on_x + math.sin(course) * advance + aside.x,
        on_z + math.cos(course) * advance + aside.z,
        heading,
        turn_rate,
        speed,
        waypoint,
        corner,
        pose.detour,
        pose.pace,
        aside,
        pose.gone + advance,
    )


@kernel
def sideways(place: Vec3, heading: float, left: float) -> Vec3:
    """Return a place so many metres to the left of who faces `heading`."""
    return place + Vec3(math.cos(heading), 0.0, -math.sin(heading)) * left


@kernel
def plan_pose(c: int, state: Any) -> PlanPose:
    """Return the present pose of a creature on the plane; its sway is left out."""
    here = sideways(load_vec3(state.position[c]), state.heading[c], -state.sway[c])
    return PlanPose(
        here.x,
        here.z,
        state.heading[c],
        state.turn_rate[c],
        state.speed[c],
        float(state.waypoint[c]),
        float(state.route.corner[c]),
        state.detour[c],
        state.pace[c],
        load_deflection(c, state),
        0.0,
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
    state.steered[c, 6] = pose.corner
    state.steered[c, 7] = pose.detour
    state.steered[c, 8] = pose.pace
    state.steered[c, 9] = pose.aside.x
    state.steered[c, 10] = pose.aside.z
    state.steered[c, 11] = pose.aside.heading
    state.steered[c, 12] = pose.aside.rate_x
    state.steered[c, 13] = pose.aside.rate_z
    state.steered[c, 14] = pose.aside.rate_heading
    state.steered[c, 15] = pose.gone


@kernel
def load_pose(c: int, state: Any) -> PlanPose:
    """Return the pose that `store_pose` kept."""
    kept = state.steered[c]
    aside = Deflection(kept[9], kept[10], kept[11], kept[12], kept[13], kept[14])
    return PlanPose(
        kept[0], kept[1], kept[2], kept[3], kept[4], kept[5], kept[6], kept[7], kept[8], aside,
        kept[15],
    )  # fmt: skip


@kernel
def predict(
    pose: PlanPose, seconds: float, c: int, state: Any, command: Any, tables: Any, settings: Any
) -> PlanPose:
    """Return the pose on the plane `seconds` ahead, as `steer` will bring it about."""
    dt = seconds / PREDICTION_STEPS
    if dt < 1e-9:
        return pose
    for _ in range(PREDICTION_STEPS):
        pose = steer(pose, c, state, command, tables, settings, dt, 1.0)
    return pose


@kernel
def note_pose(
    c: int, dt: float, pose: PlanPose, before: Vec3, state: Any, command: Any, tables: Any,
    settings: Any,
) -> None:  # fmt: skip
    """Keep what steering decided, and slow down where the legs did not let the body get there.

    `before` is where the body was. What looks ahead must know the speed that there really is, or
    feet are sent to where their body will not be. What a push does is no speed of the walk.
    """
    was = load_deflection(c, state)
    x = state.position[c, 0] - before.x
    z = state.position[c, 2] - before.z
    here = sideways(load_vec3(state.position[c]), state.heading[c], -state.sway[c])
    short_x = pose.x - here.x
    short_z = pose.z - here.z
    course = pose.heading - pose.aside.heading + command.travel[c]
    way = 0.5 * (state.speed[c] + pose.speed) * dt
    aside = hold_back(
        was, pose.aside, short_x, short_z, state.held[c], course, way, dt, tables
    )  # fmt: skip
    store_deflection(c, aside, state, tables)
    x -= aside.x - was.x
    z -= aside.z - was.z
    real = (math.sin(course) * x + math.cos(course) * z) / dt
    acceleration = acceleration_limit(c, pose.speed, command, tables, settings)
    # What the frame asked for: its mean speed, which steering brought about by a steady change.
    asked = 0.5 * (state.speed[c] + pose.speed)
    slower = 0.0
    # Held back by more than usual from where the push would have it: it hurries too.
    lost = math.hypot(pose.aside.x - aside.x, pose.aside.z - aside.z)
    pushed = math.hypot(pose.aside.x - was.x, pose.aside.z - was.z)
    if real < UNHURRIED * asked or lost > (1.0 - UNHURRIED) * pushed:
        state.hurry[c] = min(
            state.hurry[c] + HURRY * dt / (CYCLE * tables.pendulum_time), MOST_HURRY
        )
    if real < HELD_BACK * asked:
        slower = min(asked - real, SLOWING * acceleration * dt)
    state.turn_rate[c] = pose.turn_rate
    state.speed[c] = max(pose.speed - slower, 0.0)
    state.waypoint[c] = int(pose.waypoint)
    state.route.corner[c] = int(pose.corner)
