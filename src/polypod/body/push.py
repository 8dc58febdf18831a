"""Pushes: how far a body is off the path that steering gives it, and how it comes back (P2 5.2, 6).

P2 displaces a pelvis node on the plan and lets the walk go on. Here an impulse changes the velocity
of the body; what takes it off its path dies away like a critically damped spring, solved exactly,
so that the frame rate does not matter. The path itself is steering's, and knows nothing of it.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from polypod.compute import kernel
from polypod.gait.tempo import GRAVITY

# Rate of the spring, over that of an inverted pendulum as high as the hips. At one half a pushed
# body slows down as it would over feet that stand at its capture point (velocity over that rate).
RECOVERY = 0.5
# Hips lower than this count as so high, leg lengths: low-slung bodies are no quicker than legs.
LOWEST_HIP = 0.3
# The hardest push that legs can answer, in sqrt(g h), and the farthest it turns a body, rad: what
# is more is lost.
HARDEST = 1.5
FARTHEST_TURN = 0.8
# A body tips in the push's direction as one that pivots over its feet, at most at this share of the
# pendulum's rate, rad.
MOST_TIP = 1.0
# Legs that are at their end take the velocity out of a body in so many pendulum times.
HOLD = 1.0
# Nearer to its path than this, leg lengths, and slower, a body is on it.
ON_PATH = 1e-9
# Feet need not step for a push that leads the body less far off its path, leg lengths.
NOTICED = 0.03


class Deflection(NamedTuple):
    """How far the body is off its path on the plane, and how fast it moves against it."""

    x: float  # m, world
    z: float
    heading: float  # rad
    rate_x: float  # m/s
    rate_z: float
    rate_heading: float  # rad/s


NO_DEFLECTION = Deflection(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def recovery_rate(hip_height: float, leg_length: float) -> float:
    """Return the rate of the spring that brings a body back, 1/s; metres."""
    return RECOVERY * math.sqrt(GRAVITY / max(hip_height, LOWEST_HIP * leg_length))


@kernel
def load_deflection(c: int, state: Any) -> Deflection:
    """Return how far a creature is off its path."""
    kept = state.deflection[c]
    return Deflection(kept[0], kept[1], kept[2], kept[3], kept[4], kept[5])


@kernel
def store_deflection(c: int, aside: Deflection, state: Any, tables: Any) -> None:
    """Keep how far a creature is off its path; who is all but on it is on it."""
    size = math.hypot(aside.x, aside.z) + tables.leg_length * abs(aside.heading)
    rate = math.hypot(aside.rate_x, aside.rate_z) + tables.leg_length * abs(aside.rate_heading)
    if size + rate / tables.recovery <= ON_PATH * tables.leg_length:
        aside = NO_DEFLECTION
    state.deflection[c, 0] = aside.x
    state.deflection[c, 1] = aside.z
    state.deflection[c, 2] = aside.heading
    state.deflection[c, 3] = aside.rate_x
    state.deflection[c, 4] = aside.rate_z
    state.deflection[c, 5] = aside.rate_heading


@kernel
def is_pushed(aside: Deflection) -> bool:
    """Return whether a body is off its path."""
    return (
        aside.x != 0.0
        or aside.z != 0.0
        or aside.heading != 0.0
        or aside.rate_x != 0.0
        or aside.rate_z != 0.0
        or aside.rate_heading != 0.0
    )


@kernel
def recover(aside: Deflection, recovery: float, seconds: float) -> Deflection:
    """Return the deflection `seconds` later: d'' = -2 w d' - w^2 d, solved exactly."""
    if not is_pushed(aside):
        return aside
    decay = math.exp(-recovery * seconds)
    drift_x = aside.rate_x + recovery * aside.x
    drift_z = aside.rate_z + recovery * aside.z
    drift_heading = aside.rate_heading + recovery * aside.heading
    return Deflection(
        (aside.x + drift_x * seconds) * decay,
        (aside.z + drift_z * seconds) * decay,
        (aside.heading + drift_heading * seconds) * decay,
        (aside.rate_x - recovery * drift_x * seconds) * decay,
        (aside.rate_z - recovery * drift_z * seconds) * decay,
        (aside.rate_heading - recovery * drift_heading * seconds) * decay,
    )


@kernel
def hold_back(
    was: Deflection, aside: Deflection, short_x: float, short_z: float, turned: float,
    course: float, way: float, seconds: float, tables: Any,
) -> Deflection:  # fmt: skip
    """Return the deflection of a body that got less far in a step than it was to go.

    What legs or others did not let it move, and would have led it from `was` to `aside`, it has not
    moved; its velocity dies away as long as they hold it. Nor do they lead it off its path
    otherwise: of the rest of what it fell short by (m) the path's is only what is missing of its
    own `way` (m) along its `course`. `turned` is the share of the step's turn that was possible.
    """
    if not is_pushed(aside):
        return aside
    move_x = aside.x - was.x
    move_z = aside.z - was.z
    square = move_x * move_x + move_z * move_z
    held = 0.0
    if square > 0.0:
        held = min(max((short_x * move_x + short_z * move_z) / square, 0.0), 1.0)
    short_x -= held * move_x
    short_z -= held * move_z
    sine = math.sin(course)
    cosine = math.cos(course)
    own = min(max(short_x * sine + short_z * cosine, 0.0), way)
    short_x -= own * sine
    short_z -= own * cosine
    still = 1.0 - turned
    slowing = seconds / (HOLD * tables.pendulum_time)
    straight = math.exp(-held * slowing)
    round_about = math.exp(-still * slowing)
    return Deflection(
        aside.x - held * move_x - short_x,
        aside.z - held * move_z - short_z,
        aside.heading - still * (aside.heading - was.heading),
        aside.rate_x * straight,
        aside.rate_z * straight,
        aside.rate_heading * round_about,
    )


@kernel
def moved_aside(aside: Deflection, x: float, z: float) -> Deflection:
    """Return the deflection of a body that was moved off its path, m."""
    return Deflection(
        aside.x + x, aside.z + z, aside.heading, aside.rate_x, aside.rate_z, aside.rate_heading
    )


@kernel
def caught_at(aside: Deflection, recovery: float) -> Deflection:
    """Return the deflection at which feet catch a body: where a fresh push takes it farthest."""
    return recover(aside, recovery, 1.0 / recovery)


@kernel
def is_thrown(aside: Deflection, tables: Any) -> bool:
    """Return whether a push leads a body so far off its path that it is to be noticed."""
    if not is_pushed(aside):
        return False
    caught = caught_at(aside, tables.recovery)
    way = max(math.hypot(caught.x, caught.z), tables.leg_length * abs(caught.heading))
    return bool(way > NOTICED * tables.leg_length)


@kernel
def moved_by_push(aside: Deflection, recovery: float, seconds: float) -> tuple[float, float]:
    """Return how far a deflection moves a body in some seconds, world x and z, m."""
    then = recover(aside, recovery, seconds)
    return then.x - aside.x, then.z - aside.z
