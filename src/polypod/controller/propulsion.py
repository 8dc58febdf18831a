"""When the body may change its speed: while a foot is in the propulsion of its stance (P2 4).

A stance is reception up to its middle and propulsion from there on. A body in flight has nothing to
push against, and one that only receives its weight pushes nothing forward.
"""

from __future__ import annotations

from typing import Any

from polypod.compute import kernel
from polypod.math.intervals import covered_share, wrap_phase

# Moments of a step at which feet are looked at.
MOMENTS = 4
# Where feet hardly push at all, changes of speed are not as much larger as would make up for it.
LEAST_SHARE = 0.1
# A flight that lasts so many cycles longer than the gait's is none that the gait meant.
OVERDUE = 0.2


@kernel
def is_propelling(c: int, k: int, phase: float, late: bool, state: Any) -> bool:
    """Return whether a foot that stands pushes at a phase of its disk.

    One that is `late`, still down in its swing sector, does.
    """
    inside = wrap_phase(phase - state.swing_start[c, k])
    extent = state.swing_extent[c, k]
    if inside < extent:
        return late
    return bool(inside - extent >= 0.5 * (1.0 - extent))


@kernel
def is_overdue(c: int, state: Any) -> bool:
    """Return whether no foot is down although one should have landed a while ago."""
    overdue = False
    for k in range(state.swinging.shape[1]):
        if not state.swinging[c, k]:
            return False
        inside = wrap_phase(state.needle[c] - state.swing_start[c, k])
        overdue = overdue or inside > state.swing_extent[c, k] + OVERDUE
    return overdue


@kernel
def propulsion(c: int, state: Any, scratch: Any) -> float:
    """Return by how much changes of speed are larger in this step than on the mean of a cycle.

    The share of the step in which some foot propels, over the share of the cycle in which one does
    by the gait: 0 in flight, 1 on the mean. Who stands propels.
    """
    if state.cycle_rate[c] <= 0.0:
        return 1.0
    needle = state.needle[c]
    turn = state.turn[c]
    feet = state.swinging.shape[1]
    driven = 0
    for i in range(MOMENTS):
        phase = needle - turn * (i + 0.5) / MOMENTS
        for k in range(feet):
            late = wrap_phase(needle - turn - state.swing_start[c, k]) < state.swing_extent[c, k]
            if not state.swinging[c, k] and is_propelling(c, k, phase, late, state):
                driven += 1
                break
    if driven == 0 and is_overdue(c, state):
        return 1.0
    for k in range(feet):
        half = 0.5 * (1.0 - state.swing_extent[c, k])
        scratch.start[k] = wrap_phase(state.swing_start[c, k] - half)
        scratch.extent[k] = half
    share = covered_share(scratch.start, scratch.extent)
    return driven / MOMENTS / max(share, LEAST_SHARE)
