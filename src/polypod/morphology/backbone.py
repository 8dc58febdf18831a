"""Finds the chain of joints from back to head, and that of the tail, in a skeleton.

Both run along the middle plane. Files hang them together in any way: from the hips forward, from
the chest forward and backward, or each joint below one root; so places decide, and the tree where
it says something. Frame: metres, facing +Z, origin where the file has it, rest pose.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from polypod.morphology.limb import Limb
from polypod.morphology.names import has_word
from polypod.morphology.skeleton import Skeleton

FloatArray = NDArray[np.float64]

HEAD_NAMES = ("head", "skull")
NOT_HEAD = ("tail", "back", "abdomen")
OFF_MIDDLE = 0.05  # of a leg's length: joints of the spine are no farther from the middle plane
NEAR_HIPS = 0.1  # of a leg's length: so far ahead of the hind hips the spine may begin
LEAST_TAIL = 0.15  # of a leg's length
TAIL_BEHIND = 0.25  # of a leg's length: so far ahead of the hind hips a tail may begin


def leg_nodes(skeleton: Skeleton, limbs: list[Limb]) -> set[int]:
    """Return all nodes that move with a leg."""
    tops = {node for limb in limbs for node in (limb.joints[0], limb.sole_node, *limb.rides)}
    return {node for top in tops for node in skeleton.below(top)}


def middle_joints(skeleton: Skeleton, limbs: list[Limb], hip: FloatArray) -> list[int]:
    """Return the joints on the middle plane that carry skin and belong to no leg."""
    length = float(np.mean([limb.length for limb in limbs]))
    middle = 0.5 * float(hip[:, 0].min() + hip[:, 0].max())
    in_leg = leg_nodes(skeleton, limbs)
    return [
        node
        for node in range(len(skeleton.name))
        if skeleton.is_joint[node]
        and skeleton.weight[node] > 0.0
        and node not in in_leg
        and abs(float(skeleton.position[node, 0]) - middle) < OFF_MIDDLE * length
    ]


def find_spine(skeleton: Skeleton, limbs: list[Limb], hip: FloatArray) -> list[int]:
    """Return the nodes from the back to the head, or none where the trunk is one piece.

    The head is the joint on the middle plane that is named so, or else the foremost end of a chain
    of such joints; the spine is what leads there without a break in the skin, and, where that
    begins ahead of the hind hips, the joints that lie between.
    """
    length = float(np.mean([limb.length for limb in limbs]))
    usable = middle_joints(skeleton, limbs, hip)
    chains = [_chain_to(skeleton, usable, head) for head in _heads(skeleton, usable, hip, length)]
    best = max(chains, key=len, default=[])
    if best:
        best = _back_to_the_hips(skeleton, usable, best, float(hip[:, 2].min()), length)
    return best if len(best) >= 3 else []


def _heads(skeleton: Skeleton, usable: list[int], hip: FloatArray, length: float) -> list[int]:
    """Return the joints that may be the head."""
    named = [
        node
        for node in usable
        if has_word(skeleton.name[node], *HEAD_NAMES)
        and not has_word(skeleton.name[skeleton.parent[node]], *HEAD_NAMES)
    ]
    if named:
        return named
    ends = [node for node in usable if not set(skeleton.children[node]) & set(usable)]
    return [
        node
        for node in ends
        if not has_word(skeleton.name[node], *NOT_HEAD)
        and skeleton.position[node, 2] > hip[:, 2].max() - 0.1 * length
        and skeleton.position[node, 1] > hip[:, 1].mean() - 0.3 * length
    ]


def _chain_to(skeleton: Skeleton, usable: list[int], head: int) -> list[int]:
    """Return the way to the head from its topmost usable ancestor, without a gap."""
    chain = [head]
    while int(skeleton.parent[chain[-1]]) in usable:
        chain.append(int(skeleton.parent[chain[-1]]))
    return chain[::-1]


def _back_to_the_hips(
    skeleton: Skeleton, usable: list[int], chain: list[int], hips: float, length: float
) -> list[int]:
    """Return the chain with the joints before it that lie between the hind hips and its start."""
    place = skeleton.position
    while place[chain[0], 2] > hips + NEAR_HIPS * length:
        ahead = {node for top in chain[1:] for node in skeleton.below(top)}
        behind = [
            node
            for node in usable
            if node not in ahead
            and node != chain[0]
            and hips + NEAR_HIPS * length < place[node, 2] < place[chain[0], 2] - 1e-3 * length
        ]
        if not behind:
            break
        chain = [max(behind, key=lambda node: (float(place[node, 2]), -node)), *chain]
    return chain


def find_tail(
    skeleton: Skeleton, limbs: list[Limb], hip: FloatArray, spine: list[int]
) -> list[int]:
    """Return the nodes of the tail, from the trunk to the tip, or none.

    It is the longest chain of joints on the middle plane that begins at the hind hips or behind
    them and leads away from the head.
    """
    length = float(np.mean([limb.length for limb in limbs]))
    usable = set(middle_joints(skeleton, limbs, hip)) - set(spine)
    farthest = float(hip[:, 2].min()) + TAIL_BEHIND * length
    best: tuple[float, list[int]] = (0.0, [])
    for tip in sorted(usable):
        chain = [tip]
        while int(skeleton.parent[chain[-1]]) in usable:
            chain.append(int(skeleton.parent[chain[-1]]))
        chain.reverse()
        points = skeleton.position[chain]
        if points[0, 2] > farthest or points[-1, 2] >= points[0, 2]:
            if len(chain) > 1 or points[0, 2] > farthest:
                continue
        best = max(best, (_reach(skeleton, chain), chain), key=lambda found: found[0])
    return best[1] if best[0] >= LEAST_TAIL * length else []


def _reach(skeleton: Skeleton, chain: list[int]) -> float:
    """Return the length of a chain with the skin at its end."""
    points = skeleton.position[chain]
    skin = skeleton.vertex[skeleton.carrier == chain[-1]]
    beyond = float(np.linalg.norm(skin - points[-1], axis=1).max()) if len(skin) else 0.0
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()) + beyond
