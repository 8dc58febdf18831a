"""The trunk: its centre, its box, its belly, and the chain of joints from back to head."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.morphology.limb import Limb
from polypod.morphology.names import has_word
from polypod.morphology.skeleton import Skeleton

FloatArray = NDArray[np.float64]

HEAD_NAMES = ("head", "skull")
AROUND = 0.15  # of a leg's length: joints this near to the hips carry the trunk
LEAST = 0.02  # of a leg's length
NOT_TRUNK = ("tail", "arm", "hand", "hair", "skirt", "cape", "cloth")
NOT_HEAD = ("tail", "back", "abdomen")


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
    in_leg = _leg_nodes(skeleton, limbs)
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


def _leg_nodes(skeleton: Skeleton, limbs: list[Limb]) -> set[int]:
    """Return all nodes that move with a leg."""
    tops = {node for limb in limbs for node in (limb.joints[0], limb.sole_node, *limb.rides)}
    return {node for top in tops for node in skeleton.below(top)}


def find_spine(skeleton: Skeleton, limbs: list[Limb], hip: FloatArray) -> list[int]:
    """Return the nodes from the back to the head, or none where the trunk is one piece.

    The head is the joint on the middle plane that is named so, or else the foremost end of a chain
    of such joints; the spine is what leads there without a break in the skin.
    """
    length = float(np.mean([limb.length for limb in limbs]))
    middle = 0.5 * float(hip[:, 0].min() + hip[:, 0].max())
    in_leg = _leg_nodes(skeleton, limbs)
    usable = [
        node
        for node in range(len(skeleton.name))
        if skeleton.is_joint[node]
        and skeleton.weight[node] > 0.0
        and node not in in_leg
        and abs(float(skeleton.position[node, 0]) - middle) < 0.05 * length
    ]
    heads = [
        node
        for node in usable
        if has_word(skeleton.name[node], *HEAD_NAMES)
        and not has_word(skeleton.name[skeleton.parent[node]], *HEAD_NAMES)
    ]
    if not heads:
        ends = [n for n in usable if not set(skeleton.children[n]) & set(usable)]
        ends = [n for n in ends if not has_word(skeleton.name[n], *NOT_HEAD)]
        rise = hip[:, 1].mean()
        heads = [
            n
            for n in ends
            if skeleton.position[n, 2] > hip[:, 2].max() - 0.1 * length
            and skeleton.position[n, 1] > rise - 0.3 * length
        ]
    chains = []
    for head in heads:
        chain = [head]
        while int(skeleton.parent[chain[-1]]) in usable:
            chain.append(int(skeleton.parent[chain[-1]]))
        chains.append(chain[::-1])
    best = max(chains, key=len, default=[])
    return best if len(best) >= 3 else []
