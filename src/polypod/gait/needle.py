"""The needle: where in its cycle a creature is, and which feet lift and land (P1 3.3).

A creature's rows are arrays [K]: `start` and `extent` are the disks its feet go by now,
`goal_start` and `goal_extent` the disks they take when they next stand (equal to the former but in
a transition). In every step a controller

1. turns the needle, in `step_count` equal parts if it turns far,
2. lands feet (`land_feet`) before it lifts any, so that feet can change places,
3. lets standing feet take their new disks (`transition.adopt_disks`),
4. lifts `next_foot_to_lift` until there is none, by `lift_off`.

A foot swings from the phase at which it really left (`lift_phase`) to the end of its sector, so
progress follows the disk, and neither a changed tempo nor a late lift leaves a foot behind.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from polypod.compute import kernel
from polypod.gait.pattern import SAME_MOMENT, BoolArray, FloatArray
from polypod.math.intervals import sector_progress, wrap_phase

# A foot that could not lift on time may still do so in this first share of its sector.
LATE_LIFT_WINDOW = 0.5
# A foot whose new disk is under way takes it in mid-swing while this share of the sector is left:
# less would be a swing several times as fast as its neighbours'.
LEAST_SWING_LEFT = 0.35
# The needle moves by at most this share of the shortest swing or stance in one part of a step.
LARGEST_PART = 0.5
MOST_PARTS = 256


class Turned(NamedTuple):
    """Where the needle is after a step, and how far it turned, in cycles."""

    needle: float
    turn: float


@kernel
def turn_needle(needle: float, dt: float, period: float) -> Turned:
    """Return the needle after `dt` s of a cycle of `period` s; an infinite period stands still."""
    turn = dt / period
    return Turned(wrap_phase(needle + turn), turn)


@kernel
def step_count(turn: float, extent: FloatArray) -> int:
    """Return into how many equal parts a turn must be divided so that no foot's event is missed.

    Fast small creatures turn through whole sectors between two frames of film. At most MOST_PARTS:
    beyond it events merge, which `land_feet` and `next_foot_to_lift` survive.
    """
    shortest = 1.0
    for k in range(extent.shape[0]):
        shortest = min(shortest, extent[k], 1.0 - extent[k])
    parts = math.ceil(min(turn / (LARGEST_PART * shortest), float(MOST_PARTS)))
    return max(int(parts), 1)


@kernel
def swing_progress(needle: float, start: float, extent: float) -> float:
    """Return the progress of a swing by its disk, in [0, 1), or -1 where the disk says stance."""
    return sector_progress(needle, start, extent)


@kernel
def stance_progress(needle: float, start: float, extent: float) -> float:
    """Return the progress of a stance by its disk, in [0, 1), or -1 where the disk says swing."""
    return sector_progress(needle, wrap_phase(start + extent), 1.0 - extent)


@kernel
def progress_since_lift(needle: float, lift_phase: float, start: float, extent: float) -> float:
    """Return the progress, in [0, 1], of a swing that began at `lift_phase` inside its sector.

    1 once the needle has left the sector.
    """
    inside = wrap_phase(needle - start)
    if inside >= extent:
        return 1.0
    begun = wrap_phase(lift_phase - start)
    if begun >= extent:  # by rounding: a lift at the very edge of the sector
        begun = 0.0
    return max(inside - begun, 0.0) / (extent - begun)


@kernel
def land_feet(
    needle: float,
    turn: float,
    start: FloatArray,
    extent: FloatArray,
    in_swing: BoolArray,
    landed: BoolArray,
) -> int:
    """Put down the feet whose sectors the needle has left; return how many.

    Args:
        needle: the needle after its turn.
        turn: how far it turned, cycles.
        start: [K] start of each foot's swing sector.
        extent: [K] extent of each foot's swing sector.
        in_swing: [K] feet in the air; written.
        landed: [K] feet put down by this call; written.
    """
    count = 0
    for k in range(start.shape[0]):
        inside = wrap_phase(needle - start[k])
        # Inside again after a turn longer than the stance: it landed in between.
        left = inside >= extent[k] or turn >= inside + 1.0 - extent[k]
        landed[k] = in_swing[k] and left
        if landed[k]:
            in_swing[k] = False
            count += 1
    return count


@kernel
def feet_down_count(in_swing: BoolArray) -> int:
    """Return how many feet stand."""
    count = 0
    for k in range(in_swing.shape[0]):
        if not in_swing[k]:
            count += 1
    return count


@kernel
def minimum_feet_down(start: FloatArray, extent: FloatArray) -> int:
    """Return the least number of feet that a gait's disks ever leave standing.

    It is reached just after a lift-off, so those moments are enough. (`Gait.minimum_feet_down` is
    the same from the outside, without a compiler.)
    """
    fewest: int = start.shape[0]
    for moment in range(start.shape[0]):
        down = 0
        for k in range(start.shape[0]):
            if wrap_phase(start[moment] + SAME_MOMENT - start[k]) >= extent[k]:
                down += 1
        fewest = min(fewest, down)
    return fewest


@kernel
def next_foot_to_lift(
    needle: float,
    start: FloatArray,
    extent: FloatArray,
    goal_start: FloatArray,
    goal_extent: FloatArray,
    in_swing: BoolArray,
    held: BoolArray,
    minimum_down: int,
    window: float,
) -> int:
    """Return the foot that shall lift now, the one due for longest, or -1.

    A standing foot may lift while the needle is in the first `window` of its sector; a foot that
    missed all of it waits for the next. None lifts that would leave fewer than `minimum_down` feet.
    A foot whose new disk is waiting, since the needle is within its sector, lifts by that disk if
    enough of the sector is left; if not it holds its place until the new sector begins.

    Args:
        needle: the needle now.
        start: [K] start of the swing sector each foot goes by.
        extent: [K] its extent.
        goal_start: [K] start of the sector each foot goes by next.
        goal_extent: [K] its extent.
        in_swing: [K] feet in the air.
        held: [K] feet that must not lift in this step (no place found; the creature stops).
        minimum_down: least number of feet that must stay down.
        window: share of a sector in which a late lift is allowed.
    """
    if feet_down_count(in_swing) <= minimum_down:
        return -1
    chosen = -1
    longest_due = -1.0
    for k in range(start.shape[0]):
        if in_swing[k] or held[k]:
            continue
        progress = sector_progress(needle, start[k], extent[k])
        if progress < 0.0 or progress >= window:
            continue
        goal_progress = sector_progress(needle, goal_start[k], goal_extent[k])
        if goal_progress > 1.0 - LEAST_SWING_LEFT:
            continue
        due = progress * extent[k]
        if due > longest_due:
            longest_due = due
            chosen = k
    return chosen


@kernel
def lift_off(
    k: int,
    needle: float,
    turn: float,
    start: FloatArray,
    extent: FloatArray,
    goal_start: FloatArray,
    goal_extent: FloatArray,
    in_swing: BoolArray,
) -> float:
    """Lift a foot, by its new disk if one waits; return the phase at which its swing began.

    A foot that lifts in the very step in which its sector began is on time: its swing began at the
    sector's start, between two steps. Any other begins where the needle is.

    Args:
        k: the foot, from `next_foot_to_lift`.
        needle: the needle after its turn.
        turn: how far it turned in this step, cycles.
        start: [K] sectors' starts; written.
        extent: [K] sectors' extents; written.
        goal_start: [K] the new disks' starts.
        goal_extent: [K] the new disks' extents.
        in_swing: [K] feet in the air; written.
    """
    in_swing[k] = True
    if sector_progress(needle, goal_start[k], goal_extent[k]) >= 0.0:
        start[k] = goal_start[k]
        extent[k] = goal_extent[k]
    return start[k] if wrap_phase(needle - start[k]) <= turn else needle


@kernel
def needle_turns(speed: float, feet_in_swing: int) -> bool:
    """Return whether the cycle goes on: always but for a creature at rest with all feet down."""
    return speed > 0.0 or feet_in_swing > 0
