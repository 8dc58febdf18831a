"""The needle: where in its cycle a creature is, and which feet lift and land (P1 3.3).

A creature's rows are arrays [K]: `start` and `extent` are the disks its feet go by now, `in_swing`
and `stood` what they do. In every step a controller

1. turns the needle, in `step_count` equal parts if it turns far,
2. gives the standing feet their new disks (`transition.adopt_disks`) if a transition is under way,
3. lifts `next_foot_to_lift` until there is none, each at its `lift_phase`,
4. carries swinging feet along by `progress_since_lift` and lands them when it is 1.

A foot swings from the phase at which it really left (`lift_phase`) to the end of its sector, so
progress follows the disk, and neither a changed tempo nor a late lift leaves a foot behind.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from polypod.compute import kernel
from polypod.gait.pattern import SAME_MOMENT, BoolArray, FloatArray
from polypod.math.intervals import sector_progress, wrap_phase

# A foot that just landed stands for at least this share of its disk's stance before it lifts again.
LEAST_STANCE = 0.5
# The needle moves by at most this share of the shortest swing or stance in one part of a step.
LARGEST_PART = 0.5
# So near to the edge of a sector is at it, cycles.
EDGE = 1e-9
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
    beyond it a foot may miss a swing, and goes with the next.
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
def progress_since_lift(needle: float, lift_phase: float, start: float, extent: float) -> float:
    """Return the progress, in [0, 1], of a swing that began at `lift_phase` inside its sector.

    1 once the needle has left the sector, and for a foot that lifted outside of it: it is to land.
    """
    inside = wrap_phase(needle - start)
    begun = wrap_phase(lift_phase - start)
    if begun >= 1.0 - EDGE:  # by rounding: a lift at the very edge of the sector
        begun = 0.0
    if inside >= extent or begun >= extent:
        return 1.0
    return max(inside - begun, 0.0) / (extent - begun)


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
    in_swing: BoolArray,
    stood: FloatArray,
    held: BoolArray,
    minimum_down: int,
    window: float,
    turn: float = 0.0,
) -> int:
    """Return the foot that shall lift now, the one due for longest, or -1.

    A standing foot may lift while the needle is in the first `window` of its sector, if it has
    stood for a fair share of its stance (a disk that was just replaced may have its sector right
    behind a landing). A foot that missed the window waits for the next cycle. None lifts that would
    leave fewer than `minimum_down` feet.

    Args:
        needle: the needle now.
        start: [K] start of the swing sector each foot goes by.
        extent: [K] its extent.
        in_swing: [K] feet in the air.
        stood: [K] cycles for which each foot has stood.
        held: [K] feet that must not lift in this step (no place found; the creature stops).
        minimum_down: least number of feet that must stay down.
        window: share of a sector in which a late lift is allowed.
        turn: where the controller lands feet after it lifts others, how far the needle turned in
            this step, cycles: feet whose sector ended in it count as down. With 0, feet that change
            places all stand for a step.
    """
    down = 0
    for k in range(start.shape[0]):
        since_end = wrap_phase(needle - start[k]) - extent[k]
        if not in_swing[k] or 0.0 <= since_end < turn:
            down += 1
    chosen = -1
    if down <= minimum_down:
        return chosen
    longest_due = -1.0
    for k in range(start.shape[0]):
        if in_swing[k] or held[k] or stood[k] < LEAST_STANCE * (1.0 - extent[k]):
            continue
        due = wrap_phase(needle - start[k])
        if due < window * extent[k] and due > longest_due:
            longest_due = due
            chosen = k
    return chosen


@kernel
def lift_phase(needle: float, turn: float, start: float) -> float:
    """Return the phase at which a foot's swing began that is lifted now.

    A foot that lifts in the very step in which its sector began is on time: its swing began at the
    sector's start, between two steps. Any other begins where the needle is.
    """
    return start if wrap_phase(needle - start) <= turn else needle
