"""From one gait to another while walking (P1 3.3, Figure 9).

Each foot has a *goal* disk that moves from the source gait's to the destination's, and the disk it
goes by, which is replaced by the goal only while the foot stands. A transition may be redirected at
any moment: the goal goes on from where it is.
"""

from __future__ import annotations

from typing import NamedTuple

from polypod.compute import kernel
from polypod.gait.pattern import SAME_MOMENT, BoolArray, FloatArray
from polypod.math.intervals import wrap_phase

# Places round the circle at which `align_cycle` tries a gait.
ALIGNMENTS = 64


class Disk(NamedTuple):
    """A foot's swing sector, as fractions of the cycle."""

    start: float
    extent: float


@kernel
def start_shift(start: float, destination_start: float, destination_extent: float) -> float:
    """Return the signed way of a sector's start to its destination's start, in (-1, 1).

    P1 3.3: in the direction that does not pass the destination's finish. A start within the
    destination's sector goes back to that sector's start, any other goes forward to it; one that
    lies on the finish passes it in neither direction and takes the shorter.
    """
    beyond = wrap_phase(start - destination_start)
    if abs(beyond - destination_extent) <= SAME_MOMENT:
        return -beyond if beyond <= 0.5 else 1.0 - beyond
    return -beyond if beyond < destination_extent else 1.0 - beyond


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
    start: FloatArray,
    extent: FloatArray,
    goal_start: FloatArray,
    goal_extent: FloatArray,
    in_swing: BoolArray,
) -> int:
    """Give each standing foot its goal disk; return how many feet swing by another.

    A foot within whose new sector the needle is does not jump into the middle of a swing: it begins
    one late, by the rules of `needle.next_foot_to_lift`, or waits for the next.

    Args:
        start: [K] sectors' starts the feet go by; written.
        extent: [K] sectors' extents the feet go by; written.
        goal_start: [K] starts of the goal disks.
        goal_extent: [K] extents of the goal disks.
        in_swing: [K] feet in the air.
    """
    swinging_by_another = 0
    for k in range(start.shape[0]):
        if not in_swing[k]:
            start[k] = goal_start[k]
            extent[k] = goal_extent[k]
        elif start[k] != goal_start[k] or extent[k] != goal_extent[k]:
            swinging_by_another += 1
    return swinging_by_another


@kernel
def align_cycle(
    needle: float,
    start: FloatArray,
    goal_start: FloatArray,
    lift_phase: FloatArray,
    destination_start: FloatArray,
    destination_extent: FloatArray,
) -> float:
    """Turn a creature's whole circle to where the destination is near; return the needle's place.

    Phases mean nothing but relative to the needle, so turning needle and disks together changes no
    step. It is done once, when another gait is asked for, lest all feet travel far round the circle
    only because two tables count from different moments. A start that goes forward makes a long
    stance, one that goes back a short one, which a leg bears more easily and counts half.

    Args:
        needle: the needle now.
        start: [K] starts of the sectors the feet go by; written.
        goal_start: [K] starts of the goal disks; written.
        lift_phase: [K] phases at which swings began; written.
        destination_start: [K] starts of the gait to reach.
        destination_extent: [K] extents of the gait to reach.
    """
    best_cost = float(goal_start.shape[0])
    best_turn = 0.0
    for i in range(ALIGNMENTS):
        turn = i / ALIGNMENTS
        cost = 0.0
        for k in range(goal_start.shape[0]):
            shift = start_shift(
                wrap_phase(goal_start[k] + turn), destination_start[k], destination_extent[k]
            )
            cost = max(cost, shift, -0.5 * shift)
        # Strictly better only: gaits that agree already stay as they are.
        if cost < best_cost - SAME_MOMENT:
            best_cost = cost
            best_turn = turn
    for k in range(goal_start.shape[0]):
        start[k] = wrap_phase(start[k] + best_turn)
        goal_start[k] = wrap_phase(goal_start[k] + best_turn)
        lift_phase[k] = wrap_phase(lift_phase[k] + best_turn)
    return wrap_phase(needle + best_turn)
