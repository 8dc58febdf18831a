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
    """Measure the trunk's box and its belly from the skin that no leg carries."""
    length = float(np.mean([limb.length for limb in limbs]))
    leg_nodes: set[int] = set()
    for limb in limbs:
        for node in (limb.joints[0], limb.sole_node, *limb.rides):
            leg_nodes.update(skeleton.below(node))
    skin = skeleton.vertex[skeleton.share(sorted(leg_nodes)) < 0.5]
    low, high = hip.min(axis=0), hip.max(axis=0)
    least = 0.05 * length
    if not len(skin):
        half = np.maximum(0.5 * (high - low), least)
        return Trunk(least, half, 0.5 * (low + high))
    # The box is that of nearly all the skin: whiskers and tips of ears do not make a trunk.
    box_low, box_high = np.percentile(skin, [1.0, 99.0], axis=0)
    over_legs = np.all(
        (skin[:, [0, 2]] >= low[[0, 2]] - [least, 0.2 * length])
        & (skin[:, [0, 2]] <= high[[0, 2]] + [least, 0.2 * length]),
        axis=1,
    )
    belly = skin[over_legs] if over_legs.any() else skin
    thickness = float(centre[1] - np.percentile(belly[:, 1], 2.0))
    return Trunk(
        max(thickness, 0.02 * length),
        np.maximum(0.5 * (box_high - box_low), 0.02 * length),
        0.5 * (box_low + box_high),
    )


def find_spine(skeleton: Skeleton, limbs: list[Limb], hip: FloatArray) -> list[int]:
    """Return the nodes from the back to the head, or none where the trunk is one piece.

    The head is the joint on the middle plane that is named so, or else the foremost end of a chain
    of such joints; the spine is what leads there without a break in the skin.
    """
    length = float(np.mean([limb.length for limb in limbs]))
    middle = 0.5 * float(hip[:, 0].min() + hip[:, 0].max())
    in_leg = {node for limb in limbs for node in skeleton.below(limb.joints[0])}
    in_leg |= {node for limb in limbs for node in skeleton.below(limb.sole_node)}
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
