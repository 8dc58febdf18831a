"""How far spines, necks and tails bend where nobody says it.

Limits bound what a gait or a turn asks for; they are no amplitudes. Sagittal: 60 degrees from most
flexed to most extended are enough for the fastest gallopers (cheetah 50-70, greyhound 40-60, dog
20-35, horse 10-25, BIOMECHANICS 4). Sideways: a lizard's pelvis yaws by 18 degrees either way at
each stride, and it bends much more where it turns on the spot, as a wolf does.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from polypod.morphology.types import FloatArray, IntArray


class Range(NamedTuple):
    """Yaw, pitch and roll either way, degrees."""

    yaw: float
    pitch: float
    roll: float


# From one girdle to the next. Bones that are shorter together, in leg lengths, bend so much less.
TRUNK_UPRIGHT = Range(45.0, 30.0, 15.0)
TRUNK_SPRAWLING = Range(60.0, 25.0, 15.0)
WHOLE_UPRIGHT, WHOLE_SPRAWLING = 0.7, 1.0
# From the foremost girdle to the head, all together.
NECK_UPRIGHT = Range(75.0, 60.0, 30.0)
NECK_SPRAWLING = Range(50.0, 35.0, 20.0)
# From the trunk to the tip, all together.
TAIL = Range(120.0, 75.0, 30.0)
# No single joint bends more.
JOINT_MOST = Range(40.0, 35.0, 20.0)


def default_limits(
    bone_length: FloatArray, of_girdle: IntArray, upright: bool, leg_length: float
) -> FloatArray:
    """Return [S, 3] rad: yaw, pitch and roll of each segment against the one behind it.

    A range is divided among the joints by the lengths of the bones that meet there: a curve bends
    evenly. The first row is 0.

    Args:
        bone_length: [S] m.
        of_girdle: [G] the segments on which girdles sit.
        upright: the legs stand below their hips.
        leg_length: m.
    """
    count = len(bone_length)
    limit = np.zeros((count, 3))
    trunk = TRUNK_UPRIGHT if upright else TRUNK_SPRAWLING
    whole = WHOLE_UPRIGHT if upright else WHOLE_SPRAWLING
    neck = NECK_UPRIGHT if upright else NECK_SPRAWLING
    for first, last in pairwise(of_girdle):
        joints = np.arange(first + 1, last + 1)
        gap = 0.5 * (bone_length[first:last].sum() + bone_length[first + 1 : last + 1].sum())
        part = min(1.0, gap / (whole * leg_length))
        limit[joints] = divided(part * np.array(trunk), bone_length, joints)
    joints = np.arange(of_girdle[-1] + 1, count)
    limit[joints] = divided(np.array(neck), bone_length, joints)
    return limit


def tail_limits(tail_length: FloatArray) -> FloatArray:
    """Return [T, 3] rad: yaw, pitch and roll of each segment of a tail."""
    # The joint at the root has a bone of the tail on one side alone.
    length = np.concatenate([tail_length[:1], tail_length])
    return divided(np.array(TAIL), length, np.arange(1, len(length)))


def divided(whole: FloatArray, bone_length: FloatArray, joints: IntArray) -> FloatArray:
    """Return [joints, 3] rad: a range [3] in degrees divided among the joints before segments."""
    share = bone_length[joints - 1] + bone_length[joints]
    share = share / max(float(share.sum()), 1e-300)
    return np.asarray(np.radians(np.minimum(share[:, None] * whole, np.array(JOINT_MOST))))
