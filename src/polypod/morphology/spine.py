"""A spine as a chain of segments, and what rides on each (P2 5, Figures 12, 14 and 19).

The body frame is the trunk's frame of reference. Each segment moves rigidly against it, and not at
all at rest; a joint moves as the segment on which it rides. So it does not matter how the file's
own tree leads: from the hips to the head, from the chest both ways, or from a root to each of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class SpineTable(NamedTuple):
    """The S segments of a spine, from back to head, and what rides on them; S may be 0.

    The T segments of the tail are a chain of their own, from the trunk to the tip. In what changes,
    their rows come after the spine's: of [S + T] segments, tail segment t is S + t.

    Where S is 0 the trunk is rigid: `of_girdle`, `of_leg` and `of_joint` are -1, the body itself.
    """

    joint: IntArray  # [S] row of the joint table that moves as the segment: its pivot is where the
    # segment begins or, where the file's tree leads backward, where it ends
    pivot_rest: FloatArray  # [S + 1, 3] body frame, m: where each segment begins, and the last ends
    bone_length: FloatArray  # [S] m, from where a segment begins to where it ends, above 0
    limit: FloatArray  # [S, 3] rad: how far a segment may turn either way against the one behind
    # it: yaw, pitch, roll; 0 for the first, which has none behind it
    hinge: IntArray  # [S] the row of `limit` for what the segment's joint turns against its parent
    of_girdle: IntArray  # [G] the segment on which each girdle sits, never falling; the first is 0
    of_leg: IntArray  # [K] the segment on which each leg hangs
    of_joint: IntArray  # [J] the segment, of S + T, on which a joint rides that no leg carries; -1:
    # on its parent, or on the body where it has none
    girdle_rest: FloatArray  # [G, 3] body frame, m: the middle of each girdle's hips
    head: int  # segment of the head, S - 1, or -1: none lies ahead of the foremost girdle
    neck: int  # first segment ahead of the foremost girdle's; S: there is none
    tail_joint: IntArray  # [T] row of the joint table of each segment of the tail
    tail_pivot_rest: FloatArray  # [T + 1, 3] body frame, m: where each begins, and the tip
    tail_length: FloatArray  # [T] m
    tail_limit: FloatArray  # [T, 3] rad: against the one nearer the trunk, the first against
    # segment 0 of the spine: yaw, pitch, roll


def rigid_trunk(legs: int, joints: int, girdles: int) -> SpineTable:
    """Return the table of a creature whose trunk does not bend."""
    none, places = np.zeros(0, np.int64), np.zeros((0, 3))
    return SpineTable(
        joint=none,
        pivot_rest=np.zeros((1, 3)),
        bone_length=np.zeros(0),
        limit=places,
        hinge=none,
        of_girdle=np.full(girdles, -1, np.int64),
        of_leg=np.full(legs, -1, np.int64),
        of_joint=np.full(joints, -1, np.int64),
        girdle_rest=np.zeros((girdles, 3)),
        head=-1,
        neck=0,
        tail_joint=none,
        tail_pivot_rest=np.zeros((1, 3)),
        tail_length=np.zeros(0),
        tail_limit=places,
    )
