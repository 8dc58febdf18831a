"""Gaits that follow speed: which one of its ladder a creature takes, from moment to moment.

A herd has a ladder of gaits from slow to fast, with the Froude numbers between them
(`gait.library.gait_ladder`). A creature climbs it by the speed at which it is steered, each time by
a whole transition; a gait is left a tenth late in either direction (Griffin 2004 and BIOMECHANICS
2: a hysteresis of about 20 % in Froude number).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from polypod.compute import kernel
from polypod.gait.library import FROUDE_HYSTERESIS, gait_ladder, make_gait
from polypod.gait.pattern import FloatArray
from polypod.gait.tempo import froude_number
from polypod.morphology.types import LegTable

# The speed that decides follows the creature's own within so many cycles, upward and downward:
# who is held back for a moment keeps its gait.
QUICKENING = 0.25
SLACKENING = 1.5
# Touchdowns that follow the duty move at most so far round the circle in a cycle: a foot's stance
# is longer or shorter by no more.
LARGEST_SHIFT = 0.3
PINNED = -1  # the rung of a creature whose gait was asked for by name


class GaitLadder(NamedTuple):
    """A herd's gaits from slow to fast, R of them, as the command states one."""

    touchdown: FloatArray  # [R, K] phase of each foot's touchdown
    share: FloatArray  # [R, K] each foot's duty over the mean duty
    lag: FloatArray  # [R, K] shift of the touchdown per unit of mean duty
    duty: FloatArray  # [R, 3] mean duty at which it was stated, lowest, highest
    vault: FloatArray  # [R] Alexander's q of upright legs
    limit: FloatArray  # [R] Froude number above which the next one is taken; the last is infinite


def ladder_names(legs: LegTable) -> tuple[str, ...]:
    """Return the names of the gaits [R] that creatures with these legs take, from slow to fast."""
    return gait_ladder(legs.side, legs.row, legs.upright)[0]


def make_ladder(legs: LegTable) -> GaitLadder:
    """Return the gaits that creatures with these legs take by themselves."""
    names, limits = gait_ladder(legs.side, legs.row, legs.upright)
    gaits = [make_gait(name, legs.side, legs.row) for name in names]
    return GaitLadder(
        touchdown=np.array([gait.touchdown for gait in gaits]),
        share=np.array([gait.duty_share for gait in gaits]),
        lag=np.array([gait.lag_per_duty for gait in gaits]),
        duty=np.array([(gait.duty, gait.duty_low, gait.duty_high) for gait in gaits]),
        vault=np.array([gait.vault for gait in gaits]),
        limit=np.array([*limits, math.inf]),
    )


@kernel
def note_gait_speed(c: int, speed: float, turn: float, state: Any) -> None:
    """Let the speed that decides on the gait follow the creature's `speed`, m/s.

    `turn` is how far the needle turns meanwhile, cycles. Who stands has none.
    """
    if state.cycle_rate[c] <= 0.0:
        state.gait_speed[c] = 0.0
        return
    gap = speed - state.gait_speed[c]
    cycles = QUICKENING if gap > 0.0 else SLACKENING
    state.gait_speed[c] += gap * (1.0 - math.exp(-turn / cycles))


@kernel
def next_rung(rung: int, speed: float, length: float, limit: FloatArray) -> int:
    """Return the rung to be on at a speed, m/s: the present one until a limit is well passed.

    Who gains speed takes one gait after the other, who loses it may leave some out. `length` is
    what Froude numbers of the limits [R] count with, m. A creature without a rung gets the one that
    its speed asks for.
    """
    froude = froude_number(speed, length)
    slack = 0.0 if rung == PINNED else FROUDE_HYSTERESIS
    chosen = max(rung, 0)
    while froude > limit[chosen] * (1.0 + slack):
        chosen += 1
        if rung != PINNED:
            return chosen
    while chosen > 0 and froude < limit[chosen - 1] * (1.0 - slack):
        chosen -= 1
    return chosen


@kernel
def wished_rung(c: int, state: Any, command: Any, tables: Any) -> int:
    """Return the rung of the ladder that a creature is to be on, `PINNED` where it follows none."""
    if not command.follows[c]:
        return PINNED
    if state.cycle_rate[c] <= 0.0:
        return 0
    rung: int = state.rung[c]
    # A transition under way is finished first.
    if rung != PINNED and state.blend_left[c] > 0.0:
        return rung
    length = tables.hip_height if tables.upright else tables.leg_length
    return int(next_rung(rung, state.gait_speed[c], length, tables.ladder.limit))


@kernel
def take_gait(c: int, rung: int, state: Any, command: Any, tables: Any) -> None:
    """Write down the gait that a creature is to walk in: of the ladder, or the one asked for."""
    ladder = tables.ladder
    for k in range(state.gait_touchdown.shape[1]):
        if rung == PINNED:
            state.gait_touchdown[c, k] = command.gait_touchdown[c, k]
            state.gait_share[c, k] = command.gait_share[c, k]
            state.gait_lag[c, k] = command.gait_lag[c, k]
        else:
            state.gait_touchdown[c, k] = ladder.touchdown[rung, k]
            state.gait_share[c, k] = ladder.share[rung, k]
            state.gait_lag[c, k] = ladder.lag[rung, k]
    state.gait_vault[c] = command.gait_vault[c] if rung == PINNED else ladder.vault[rung]
    for i in range(3):
        if rung == PINNED:
            state.gait_duty[c, i] = command.gait_duty[c, i]
        else:
            state.gait_duty[c, i] = ladder.duty[rung, i]


@kernel
def duty_change(c: int, gap: float, turn: float, cycles: float, state: Any, command: Any) -> float:
    """Return by how much the mean duty follows a `gap` while the needle turns by `turn` cycles.

    Within about `cycles`. Where touchdowns follow the duty through a continuum of gaits they must
    not run ahead of the needle, nor back into it.
    """
    change: float = gap * (1.0 - math.exp(-turn / cycles))
    if not command.follows[c]:
        return change
    steepest = 0.0
    for k in range(state.gait_lag.shape[1]):
        steepest = max(steepest, abs(state.gait_lag[c, k]))
    most = LARGEST_SHIFT * turn / max(steepest, 1e-12)
    return min(most, max(-most, change))
