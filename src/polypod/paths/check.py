"""What makes a path impossible: the leg's reach, other legs, speed, and the true shapes."""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.environment.table import (
    EnvironmentTable,
    is_forbidden_at,
    penetration,
    penetration_at,
)
from polypod.footprints.settings import StepRequest
from polypod.math.hermite import hermite
from polypod.math.vec3 import distance, load_vec3, mix
from polypod.paths.curve import (
    PATH_KNOTS,
    PathRow,
    path_point,
    seconds_ahead,
    swing_progress,
)
from polypod.paths.scratch import OtherLegs

# The most that a bell-shaped swing exceeds its mean speed.
PEAK_SPEED = 1.875
# Samples on each piece of the path in the exact check.
EXACT_SAMPLES = 3
# Chords between frames are checked at so many parts; slower swings have more frames than needed.
CHORD_SAMPLES = 4
MOST_FRAMES = 24


@kernel
def leg_gap(legs: OtherLegs, s: int, x: float, z: float) -> float:
    """Return the distance in plan from a place to leg segment `s`; m."""
    a_x = legs.a[s, 0]
    a_z = legs.a[s, 2]
    step_x = legs.b[s, 0] - a_x
    step_z = legs.b[s, 2] - a_z
    square = step_x * step_x + step_z * step_z
    u = 0.0
    if square > 0.0:
        u = min(max(((x - a_x) * step_x + (z - a_z) * step_z) / square, 0.0), 1.0)
    return math.hypot(x - a_x - step_x * u, z - a_z - step_z * u)


@kernel
def meets_legs(legs: OtherLegs, count: int, gap_wanted: float, path: PathRow) -> bool:
    """Return whether the foot would meet another leg on the path.

    As in P1 section 4 the other legs' projections count: a leg hangs above its sole, and sweeps
    through what the sole passes over or under. A foot that starts beside another leg may stay as
    near as it is. `count` segments are there; `gap_wanted` (m) is the foot's radius and the room
    beside it.
    """
    for s in range(count):
        clear = legs.radius[s] + gap_wanted
        x0 = min(legs.a[s, 0], legs.b[s, 0]) - clear
        x1 = max(legs.a[s, 0], legs.b[s, 0]) + clear
        z0 = min(legs.a[s, 2], legs.b[s, 2]) - clear
        z1 = max(legs.a[s, 2], legs.b[s, 2]) + clear
        at_start = leg_gap(legs, s, path.point[0, 0], path.point[0, 2])
        allowed = min(clear, 0.999 * at_start)
        for k in range(1, PATH_KNOTS):
            x = path.point[k, 0]
            z = path.point[k, 2]
            if x < x0 or x > x1 or z < z0 or z > z1:
                continue
            if leg_gap(legs, s, x, z) < allowed:
                return True
    return False


@kernel
def out_of_reach(request: StepRequest, margin: float, path: PathRow) -> bool:
    """Return whether the path leaves what the leg reaches, or is too long for the time it has.

    Checked at knots and half way between them, the hip moving on as predicted; `margin` is kept
    from the leg's limits, as a share of them. A foot that starts beyond may come back inside.
    """
    if path.length[0] * PEAK_SPEED > request.speed_limit * request.swing_seconds:
        return True
    offset = request.effector_offset_touchdown
    at_start = distance(request.start_world + offset, request.hip_start)
    most = max(request.reach_max * (1.0 - margin), at_start)
    at_end = distance(load_vec3(path.point[PATH_KNOTS - 1]) + offset, request.hip_touchdown)
    most = max(most, min(request.reach_max, at_end))
    least = min(request.reach_min * (1.0 + margin), at_start)
    before = load_vec3(path.point[0])
    for k in range(1, PATH_KNOTS):
        point = load_vec3(path.point[k])
        middle = path.fraction[k] - 0.5 * (path.fraction[k] - path.fraction[k - 1])
        hip = mix(request.hip_start, request.hip_touchdown, middle)
        reach = distance(mix(before, point, 0.5) + offset, hip)
        if reach > most or reach < least:
            return True
        hip = mix(request.hip_start, request.hip_touchdown, path.fraction[k])
        reach = distance(point + offset, hip)
        if reach > most or reach < least:
            return True
        before = point
    return False


@kernel
def chords_clear(
    env: EnvironmentTable, accepted: float, request: StepRequest, path: PathRow
) -> bool:
    """Return whether the straight ways between the foot's places in two frames are free.

    What plays between two frames is their chord: it cuts the corners that the curve goes round.
    `accepted` (m) is how deep a chord may cut into what is passed over; nothing forbidden is cut.
    """
    if request.frame_seconds <= 0.0 or request.swing_seconds <= 0.0:
        return True
    frames = min(math.ceil(request.swing_seconds / request.frame_seconds), MOST_FRAMES)
    before = load_vec3(path.point[0])
    for frame in range(1, frames + 1):
        time = min(frame * request.frame_seconds / request.swing_seconds, 1.0)
        along, _ = swing_progress(request.profile, time, request.launch)
        after = path_point(path.point, path.tangent, path.fraction, PATH_KNOTS, along)
        for i in range(1, CHORD_SAMPLES):
            place = mix(before, after, i / CHORD_SAMPLES)
            # Obstacles are a frame ahead of the foot: they are where this frame ends.
            ahead = max(frame - 2.0 + i / CHORD_SAMPLES, 0.0) * request.frame_seconds
            depth, _ = penetration_at(env, place, ahead)
            if depth > accepted or is_forbidden_at(env, place.x, place.z, 0.0, ahead):
                return False
        before = after
    return True


@kernel
def deepest(
    env: EnvironmentTable, accepted: float, request: StepRequest, path: PathRow, extra: Any
) -> float:
    """Return how deep the path goes into true shapes beyond `accepted`; m, 0: not at all.

    What is missing is added to `extra` [PATH_KNOTS] at the knots about it, for a second try. A foot
    that starts sunk in may come out.
    """
    sunk, _ = penetration(env, load_vec3(path.point[0]))
    worst = 0.0
    for k in range(PATH_KNOTS - 1):
        span = path.fraction[k + 1] - path.fraction[k]
        p0 = load_vec3(path.point[k])
        p1 = load_vec3(path.point[k + 1])
        m0 = load_vec3(path.tangent[k]) * span
        m1 = load_vec3(path.tangent[k + 1]) * span
        for j in range(EXACT_SAMPLES):
            u = (j + 1.0) / EXACT_SAMPLES
            ahead = 0.0
            if env.mover_count > 0:
                ahead = seconds_ahead(request, path.fraction[k] + span * u)
            depth, _ = penetration_at(env, hermite(p0, m0, p1, m1, u), ahead)
            excess = depth - accepted
            if sunk > 0.0 and path.fraction[k] < 0.1:
                excess -= sunk
            if excess > 0.0:
                worst = max(worst, excess)
                lift = 2.0 * excess + accepted
                extra[k] = max(extra[k], lift)
                extra[k + 1] = max(extra[k + 1], lift)
    return worst
