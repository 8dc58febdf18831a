"""Feet spacing as it comes and goes: what was asked for, and feet of one side that pass each other.

Where strides are long a hind foot comes down beside or ahead of where the fore foot of its side
still stands or has just stood. Quadrupeds that trot fast or gallop set their hind feet down farther
out and their fore feet nearer to the middle, and so pass the ones outside the others (Hildebrand
1977). So do these, as much as their strides need it.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.controller.stride import stance_centre, stance_seconds
from polypod.paths.apart import ROOM

# Room between legs that pass each other, and from the middle to a fore leg, `ROOM`s: with one alone
# a planner that looks at legs as they will be sends feet farther out now and then.
PASSING = 2.0
TWIN = 1.5
# The fore foot does so much of it on level ground; elsewhere fore feet keep clear of each other.
OF_FORE = 0.25
# They have parted when the ends of their stances overlap, and begin so far before, leg lengths.
PARTED = 0.3
# More feet than these are many: half of them carry a body at any moment, and a wave of them is on
# its way at once.
MANY = 10


@kernel
def passes(k: int, other: int, legs: Any) -> bool:
    """Return whether two legs are neighbours on a side that part, and so may pass each other."""
    beside = legs.side[k] == legs.side[other] and abs(legs.row[k] - legs.row[other]) == 1
    return bool(beside and legs.upright[k] and legs.upright[other])


@kernel
def stance_edge(c: int, k: int, end: float, state: Any, command: Any, tables: Any) -> float:
    """Return how far ahead of the body centre a stance begins (`end` 1) or ends (-1), m."""
    middle: float = tables.legs.sole_stance[k, 2] + command.spacing[c, k, 1]
    way = state.speed[c] * math.cos(command.travel[c]) * stance_seconds(c, k, state)
    return middle + stance_centre(c, k, way, state, tables) + 0.5 * end * abs(way)


@kernel
def half_width(k: int, legs: Any) -> float:
    """Return half of how wide a leg is below its first section, m."""
    wide: float = legs.foot_half_size[k, 0]
    for i in range(1, legs.joint_count[k] + 1):
        wide = max(wide, legs.section_radius[k, i])
    return wide


@kernel
def parted(c: int, hind: int, fore: int, state: Any, command: Any, tables: Any) -> float:
    """Return by how much two neighbouring feet of a side are to part sideways, m.

    One leg's first section passes the other one's lower ones, too.
    """
    legs = tables.legs
    overlap = stance_edge(c, hind, 1.0, state, command, tables)
    overlap -= stance_edge(c, fore, -1.0, state, command, tables)
    overlap += legs.foot_half_size[hind, 1] + legs.foot_half_size[fore, 1]
    share = min(max(1.0 + overlap / (PARTED * legs.length[hind]), 0.0), 1.0)
    share = share * share * (3.0 - 2.0 * share)
    hind_wide = half_width(hind, legs)
    fore_wide = half_width(fore, legs)
    wide = max(
        max(hind_wide, legs.section_radius[hind, 0]) + fore_wide,
        hind_wide + legs.section_radius[fore, 0],
    )
    wide += PASSING * ROOM * legs.length[hind]
    apart = (legs.sole_stance[hind, 0] + command.spacing[c, hind, 0]) * legs.side[hind]
    apart -= (legs.sole_stance[fore, 0] + command.spacing[c, fore, 0]) * legs.side[fore]
    return share * max(wide - apart, 0.0)


@kernel
def parting(c: int, k: int, state: Any, command: Any, tables: Any) -> float:
    """Return how far left of its rest place a foot goes to pass its neighbours on its side, m.

    A fore foot goes toward the middle as far as the other fore foot lets it, at most a quarter
    of the way, and the hind foot does the rest.
    """
    legs = tables.legs
    if not legs.upright[k] or legs.side[k] == 0:
        return 0.0
    out = 0.0
    inward = OF_FORE * (1.0 - state.caution[c])
    for other in range(legs.length.shape[0]):
        if not passes(k, other, legs):
            continue
        if legs.row[other] > legs.row[k]:
            whole = parted(c, k, other, state, command, tables)
            out += whole - min(inward * whole, inward_room(other, tables))
        else:
            whole = parted(c, other, k, state, command, tables)
            out -= min(inward * whole, inward_room(k, tables))
    return float(out * legs.side[k])


@kernel
def inward_room(k: int, tables: Any) -> float:
    """Return how far toward the middle a foot may go before it is in the way of its twin, m."""
    legs = tables.legs
    least = half_width(k, legs) + TWIN * ROOM * legs.length[k]
    return max(abs(legs.sole_stance[k, 0]) - least, 0.0)


@kernel
def shift_spacing(c: int, dt: float, state: Any, command: Any, tables: Any, settings: Any) -> None:
    """Move each foot's rest place to the wished one at a set rate (P1 Fig 6)."""
    for k in range(state.swinging.shape[1]):
        most = settings.spacing_rate * tables.legs.length[k] * dt
        for axis in range(2):
            gap = command.spacing[c, k, axis] - state.spacing[c, k, axis]
            if axis == 0:
                gap += parting(c, k, state, command, tables)
            state.spacing[c, k, axis] += min(most, max(-most, gap))
