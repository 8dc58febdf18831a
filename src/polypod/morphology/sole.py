"""The sole: the point, and the shape, of a foot that stands on the ground."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from polypod.morphology.skeleton import Skeleton

FloatArray = NDArray[np.float64]

# Parts of the leg's length.
SOLE_BAND = 0.02  # vertices this near the lowest belong to the sole
LEAST_HALF_SIZE = 0.01
MOST_HALF_SIZE = 0.25
FOOT_REACH = 0.3  # a foot's pivot is this near its sole at most
ANKLE_HEIGHT = 0.12  # nearer than this it is a foot, whatever its shape
FLATNESS = 0.35  # farther: a foot is this much longer than its pivot is far
STRETCHED_DROP = 0.15  # a foot that hangs less than this below its hip does not stand


@dataclass(frozen=True)
class Sole:
    """A sole at rest, metres."""

    place: FloatArray  # [3]
    half_size: FloatArray  # [2] along x and z
    stretched: bool  # the leg sticks out: the sole is its tip, not its lowest point
    source: str  # "skin", "mark" or "pivot"

    def at_mark(self, mark: FloatArray, length: float) -> Sole:
        """Return the sole at a mark, or straight below it where the skin hangs lower."""
        drop = float(mark[1] - self.place[1])
        place = mark.copy()
        if self.source == "skin" and not self.stretched and 0.0 < drop < FOOT_REACH * length:
            place[1] = self.place[1]
        return replace(self, place=place, source="mark")


def find_sole(
    skeleton: Skeleton, group: list[int], hip: int, pivot: FloatArray, length: float
) -> Sole:
    """Find the sole from the skin that hangs mostly on the foot.

    Args:
        skeleton: the rig, metres, facing +Z.
        group: the nodes that belong to the foot.
        hip: the leg's first joint.
        pivot: [3] where the foot turns.
        length: m, hip to pivot along the chain.

    Returns:
        the sole; at the pivot where no skin hangs on the foot.
    """
    skin = skeleton.vertex[skeleton.share(group) >= 0.5]
    if not len(skin):
        half = np.full(2, LEAST_HALF_SIZE * length)
        return Sole(pivot.copy(), half, False, "pivot")
    lowest = float(skin[:, 1].min())
    reach = float(np.linalg.norm(skin - pivot, axis=1).max())
    drop = float(skeleton.position[hip, 1]) - lowest
    stretched = drop < STRETCHED_DROP * (length + reach)
    if stretched:
        away = np.linalg.norm(skin - skeleton.position[hip], axis=1)
        patch = skin[away > away.max() - SOLE_BAND * (length + reach)]
        middle = 0.5 * (patch.min(axis=0) + patch.max(axis=0))
        half = np.full(2, LEAST_HALF_SIZE * length)
        return Sole(middle, half, True, "skin")
    patch = skin[skin[:, 1] <= lowest + SOLE_BAND * (length + reach)]
    middle = 0.5 * (patch.min(axis=0) + patch.max(axis=0))
    half = 0.5 * np.ptp(patch, axis=0)[[0, 2]]
    half = np.clip(half, LEAST_HALF_SIZE * length, MOST_HALF_SIZE * length)
    return Sole(np.array([middle[0], lowest, middle[2]]), half, False, "skin")


def is_flat_foot(sole: Sole, pivot: FloatArray, length: float) -> bool:
    """Tell whether a joint is a foot that stands, rather than a shank that ends in a point."""
    if sole.source != "skin" or sole.stretched:
        return False
    away = float(np.linalg.norm(sole.place - pivot))
    if away <= ANKLE_HEIGHT * length:
        return True
    return away <= FOOT_REACH * length and 2.0 * float(sole.half_size.max()) >= FLATNESS * away
