"""The trunk: its centre, its box and its belly."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.morphology.backbone import leg_nodes
from polypod.morphology.limb import Limb
from polypod.morphology.names import has_word
from polypod.morphology.skeleton import Skeleton

FloatArray = NDArray[np.float64]

AROUND = 0.15  # of a leg's length: joints this near to the hips carry the trunk
LEAST = 0.02  # of a leg's length
NOT_TRUNK = ("tail", "arm", "hand", "hair", "skirt", "cape", "cloth")


class Trunk(NamedTuple):
    """The trunk at rest, in the limbs' frame."""

    thickness: float  # m, from the centre down to the belly
    half_size: FloatArray  # [3] m
    box_centre: FloatArray  # [3] m


def body_centre(hip: FloatArray) -> FloatArray:
    """Return [3]: the middle of the hips in plan, at their mean height."""
    low, high = hip.min(axis=0), hip.max(axis=0)
    middle = 0.5 * (low + high)
    return np.array([middle[0], float(hip[:, 1].mean()), middle[2]])


def measure_trunk(
    skeleton: Skeleton, limbs: list[Limb], hip: FloatArray, centre: FloatArray
) -> Trunk:
    """Measure the trunk's box and its belly: the skin near the hips that no leg carries."""
    length = float(np.mean([limb.length for limb in limbs]))
    in_leg = leg_nodes(skeleton, limbs)
    skin = skeleton.vertex[skeleton.share(sorted(in_leg)) < 0.5]
    low, high = hip.min(axis=0), hip.max(axis=0)
    least = LEAST * length
    if not len(skin):
        return Trunk(least, np.maximum(0.5 * (high - low), least), 0.5 * (low + high))
    over_legs = [
        node
        for node in np.flatnonzero(skeleton.weight > 0.0).tolist()
        if node not in in_leg
        and np.all(skeleton.position[node, [0, 2]] >= low[[0, 2]] - AROUND * length)
        and np.all(skeleton.position[node, [0, 2]] <= high[[0, 2]] + AROUND * length)
        and not has_word(skeleton.name[node], *NOT_TRUNK)
    ]
    near = skeleton.vertex[skeleton.share(over_legs) >= 0.5]
    trunk = near if len(near) else skin
    # Single spikes and hairs do not make a box, but the belly is as low as it is.
    box_low, box_high = np.percentile(trunk, [1.0, 99.0], axis=0)
    return Trunk(
        max(float(centre[1] - trunk[:, 1].min()), least),
        np.maximum(0.5 * (box_high - box_low), least),
        0.5 * (box_low + box_high),
    )
