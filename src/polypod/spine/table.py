"""What the spine's four steps know of a creature, made once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polypod.morphology.girdles import Girdles
from polypod.morphology.spine import SpineTable
from polypod.morphology.types import FloatArray, IntArray, LegTable
from polypod.spine.advancing import TRACK
from polypod.spine.leading import BEYOND, LONG

# Of what joints allow the track takes so much: the rest is for what a gait bends a spine by.
FOR_TURNS = 0.8
# And so much of the roll: what turns a joint two ways at once rolls it a little.
FOR_BANKS = 0.9
# The track behind is kept as far as tail or trunk reach, and a little farther.
BEHIND = 1.05
# Girdles nearer to each other than this, leg lengths, yaw less by their feet, by the square: a wave
# of many of them would lead each aside.
APART = 1.2
# The inner feet need so many times as much room in a turn as they stand beside the middle.
ROOM_INSIDE = 2.6
# And so many times more where each has the next one close by: a centipede of 1.3 m walks on arcs of
# 0.63 m at its full pace, and on tighter ones its legs hold it up (0.5 m: 0.73 of it).
CROWDED_INSIDE = 3.0


class BendTable(NamedTuple):
    """G girdles as nodes of a curve along the S segments of a spine."""

    most_yaw: FloatArray  # [G] rad by which limits let a girdle turn against the body's axis
    yaw_gap: FloatArray  # [G] rad, and against the next girdle ahead; 0 for the foremost
    roll_gap: FloatArray  # [G] rad by which a girdle may roll against the next one ahead
    apart: float  # 1; less where girdles are nearer to each other than `APART`
    tightest: float  # 1/m, the curvature of the tightest arc on which the trunk can lie; 0: rigid
    neck_range: FloatArray  # [3] rad: yaw, pitch and roll of all joints of the neck together
    first_girdle: IntArray  # [S] the hindmost girdle on a segment, -1: none
    last_girdle: IntArray  # [S] the foremost
    behind: IntArray  # [S] of a segment without one: the next girdle behind
    begin: FloatArray  # [S] where it begins and ends at rest, shares of the way from that girdle
    end: FloatArray  # [S] to the next
    track_step: float  # m, from one place of the track behind to the next
    kept: float  # m, how far ahead its way is kept, whose head leads it; 0: its middle does


def make_bend_table(spine: SpineTable, girdles: Girdles, legs: LegTable) -> BendTable:
    """Return what is made from the spine's segments, its girdles and their legs."""
    leg_length = float(np.mean(legs.length))
    count = len(girdles.place)
    apart = min(1.0, float(np.ptp(girdles.place)) / max(count - 1, 1) / (APART * leg_length))
    segments = len(spine.joint)
    first = np.full(segments, -1, np.int64)
    last = np.full(segments, -1, np.int64)
    behind = np.full(segments, -1, np.int64)
    begin, end = np.zeros(segments), np.zeros(segments)
    for g, s in enumerate(spine.of_girdle if segments else ()):
        first[s] = g if first[s] < 0 else first[s]
        last[s] = g
    z = spine.pivot_rest[:, 2]
    for s in range(min(spine.neck, segments)):
        if first[s] >= 0:
            continue
        g = int(np.searchsorted(spine.of_girdle, s) - 1)
        span = girdles.place[g + 1] - girdles.place[g]
        behind[s] = g
        begin[s], end[s] = np.clip((z[s : s + 2] - girdles.place[g]) / span, 0.0, 1.0)
        if end[s] - begin[s] < 1e-3:
            begin[s], end[s] = max(end[s] - 0.5, 0.0), min(begin[s] + 0.5, 1.0)
    back = min(float(girdles.place[0]), float(z[0]), float(spine.tail_pivot_rest[:, 2].min()))
    reach = max(BEHIND * -back, 1e-6)
    front = float(girdles.place[-1])
    return BendTable(
        most_yaw=most_yaw(spine, girdles),
        yaw_gap=gaps(spine, girdles, 0, FOR_TURNS),
        roll_gap=gaps(spine, girdles, 2, FOR_BANKS),
        apart=apart * apart,
        tightest=tightest(spine, girdles, float(np.abs(legs.sole_stance[:, 0]).mean()), apart),
        neck_range=spine.limit[spine.neck :].sum(axis=0).reshape(3) if segments else np.zeros(3),
        first_girdle=first,
        last_girdle=last,
        behind=behind,
        begin=begin,
        end=end,
        track_step=reach / (TRACK - 2),
        kept=BEYOND * front if segments and front >= LONG * leg_length else 0.0,
    )


def gaps(spine: SpineTable, girdles: Girdles, axis: int, share: float) -> FloatArray:
    """Return [G] how far, rad, each girdle may turn against the next one ahead; 0 for the foremost.

    About an axis of the limits, 0 yaw to 2 roll, by a share of what the joints between allow.
    """
    gap = np.zeros(len(girdles.place))
    for g in range(len(gap) - 1):
        if len(spine.joint):
            joints = slice(spine.of_girdle[g] + 1, spine.of_girdle[g + 1] + 1)
            gap[g] = share * spine.limit[joints, axis].sum()
    return gap


def tightest(spine: SpineTable, girdles: Girdles, beside: float, apart: float) -> float:
    """Return the curvature, 1/m, of the tightest arc that a creature walks on; 0: it is rigid.

    On which its trunk can lie, and on whose inner side its feet have room: they stand `beside` its
    middle, m, and its girdles are `apart`, 1 where far.
    """
    span = float(girdles.place[-1] - girdles.place[0])
    if span <= 0.0:
        return 0.0
    room = ROOM_INSIDE + CROWDED_INSIDE * (1.0 - apart)
    return min(float(gaps(spine, girdles, 0, FOR_TURNS).sum()) / span, 1.0 / (room * beside))


def most_yaw(spine: SpineTable, girdles: Girdles) -> FloatArray:
    """Return [G] how far, rad, limits let each girdle turn against the body's axis.

    All that the spine bends from the hindmost to the foremost, shared as they lie along it.
    """
    span = float(girdles.place[-1] - girdles.place[0])
    whole = float(gaps(spine, girdles, 0, FOR_TURNS).sum())
    return np.asarray(whole * np.abs(girdles.place) / span) if span > 0.0 else 0.0 * girdles.place
