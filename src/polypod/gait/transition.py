"""From one gait to another while walking (P1 3.3, Figure 9).

Each foot has a *goal* disk that moves from the source gait's to the destination's, and the disk it
goes by, which is replaced by the goal only while the foot stands. A transition may be redirected at
any moment: the goal goes on from where it is.
"""

from __future__ import annotations

from typing import NamedTuple

from polypod.compute import kernel
from polypod.gait.pattern import SAME_MOMENT, BoolArray, FloatArray
from polypod.math.intervals import phase_between, wrap_phase

# Real switches of gait take one to two strides.
TRANSITION_CYCLES = 1.5


class Disk(NamedTuple):
    """A foot's swing sector, as fractions of the cycle."""

    start: float
    extent: float


@kernel
def disk_at_duty(
    start: float, extent: float, lag_per_duty: float, gait_duty: float, duty: float
) -> Disk:
    """Return a foot's disk of a gait with mean duty `gait_duty`, at another mean duty.

    The touchdown stays (but for the lag), the lift-off moves: see `Gait.with_duty`.
    """
    foot_duty = (1.0 - extent) * (duty / gait_duty)
    touchdown = start + extent + lag_per_duty * (duty - gait_duty)
    return Disk(wrap_phase(touchdown + foot_duty), 1.0 - foot_duty)


@kernel
def start_shift(start: float, destination_start: float, destination_extent: float) -> float:
    """Return the signed way of a sector's start to its destination's start, in (-1, 1).

    P1 3.3: in the direction that does not pass the destination's finish. A start within the
    destination's sector goes back to that sector's start, any other goes forward to it.
    """
    beyond = wrap_phase(start - destination_start)
    if beyond == 0.0:
        return 0.0
    return -beyond if beyond <= destination_extent else 1.0 - beyond


@kernel
def approach_disk(
    start: float,
    extent: float,
    destination_start: float,
    destination_extent: float,
    share: float,
) -> Disk:
    """Return a disk after a share, 0 to 1, of its remaining way to the destination."""
    if share >= 1.0:
        return Disk(destination_start, destination_extent)
    shift = start_shift(start, destination_start, destination_extent)
    return Disk(wrap_phase(start + shift * share), extent + (destination_extent - extent) * share)


@kernel
def approach_disks(
    goal_start: FloatArray,
    goal_extent: FloatArray,
    destination_start: FloatArray,
    destination_extent: FloatArray,
    turn: float,
    cycles_left: float,
) -> float:
    """Move all goal disks toward the destination's; return the cycles left of the transition.

    Linear in the needle's way, and exact at the end: after `cycles_left` cycles in any number of
    turns the goals are the destination.

    Args:
        goal_start: [K] starts of the goal disks; written.
        goal_extent: [K] extents of the goal disks; written.
        destination_start: [K] starts of the gait to reach.
        destination_extent: [K] extents of the gait to reach.
        turn: how far the needle turns, cycles.
        cycles_left: cycles until the goals shall have arrived.
    """
    share = turn / cycles_left if cycles_left > turn else 1.0
    for k in range(goal_start.shape[0]):
        disk = approach_disk(
            goal_start[k], goal_extent[k], destination_start[k], destination_extent[k], share
        )
        goal_start[k] = disk.start
        goal_extent[k] = disk.extent
    return max(cycles_left - turn, 0.0)


@kernel
def adopt_disks(
    needle: float,
    start: FloatArray,
    extent: FloatArray,
    goal_start: FloatArray,
    goal_extent: FloatArray,
    in_swing: BoolArray,
) -> int:
    """Give each standing foot its goal disk; return how many feet still go by another.

    A foot within whose new sector the needle is waits, or it would jump into the middle of a swing:
    it lifts by `needle.next_foot_to_lift` or takes the disk when the needle has left the sector.

    Args:
        needle: the needle now.
        start: [K] sectors' starts the feet go by; written.
        extent: [K] sectors' extents the feet go by; written.
        goal_start: [K] starts of the goal disks.
        goal_extent: [K] extents of the goal disks.
        in_swing: [K] feet in the air.
    """
    waiting = 0
    for k in range(start.shape[0]):
        outside = wrap_phase(needle - goal_start[k]) >= goal_extent[k]
        if outside and not in_swing[k]:
            start[k] = goal_start[k]
            extent[k] = goal_extent[k]
        elif (
            abs(phase_between(start[k], goal_start[k])) > SAME_MOMENT
            or abs(extent[k] - goal_extent[k]) > SAME_MOMENT
        ):
            waiting += 1
    return waiting
