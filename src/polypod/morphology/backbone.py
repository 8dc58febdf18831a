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
TAIL_NAMES = ("tail",)
NOT_HEAD = ("back", "abdomen")
NOT_BONES = ("belly", "udder", "skirt", "cape", "cloth", "hair", "mane", "saddle", "rider", "wing")
# Of a leg's length:
OFF_MIDDLE = 0.05  # joints of the spine are no farther from the middle plane
NEAR_HIPS = 0.1  # so far ahead of the hind hips the spine may begin,
BEHIND_HIPS = 0.15  # and so far behind them
BELOW_HIPS = 0.6  # behind the fore legs joints of the spine lie no lower: roots are on the ground
LEAST_TAIL = 0.15  # a tail is longer


class Middle:
    """The joints on the middle plane that carry skin and belong to no leg."""

    def __init__(self, skeleton: Skeleton, limbs: list[Limb], hip: FloatArray) -> None:
        self.skeleton = skeleton
        self.limbs = limbs  # K of them
        self.hip = hip  # [K, 3]
        self.length = float(np.mean([limb.length for limb in limbs]))
        in_leg = leg_nodes(skeleton, limbs)
        middle = 0.5 * float(hip[:, 0].min() + hip[:, 0].max())
        self.joints = [
            node
            for node in range(len(skeleton.name))
            if skeleton.is_joint[node]
            and skeleton.weight[node] > 0.0
            and node not in in_leg
            and not has_word(skeleton.name[node], *NOT_BONES)
            and abs(float(skeleton.position[node, 0]) - middle) < OFF_MIDDLE * self.length
        ]

    def chain_to(self, node: int, among: set[int]) -> list[int]:
        """Return a node's ancestors among some nodes, the topmost first, and the node."""
        return [other for other in self.skeleton.above(node)[::-1] if other in among] + [node]

    def back(self, node: int) -> float:
        """Return how far back a joint or the middle of the skin that it carries is, z in m.

        A joint that hangs on the one ahead of it lies at the fore end of its bone.
        """
        skin = self.skeleton.vertex[self.skeleton.carrier == node, 2]
        place = float(self.skeleton.position[node, 2])
        return min(place, float(skin.mean())) if len(skin) else place


def leg_nodes(skeleton: Skeleton, limbs: list[Limb]) -> set[int]:
    """Return all nodes that move with a leg."""
    tops = {node for limb in limbs for node in (limb.joints[0], limb.sole_node, *limb.rides)}
    return {node for top in tops for node in skeleton.below(top)}


def find_spine(middle: Middle) -> list[int]:
    """Return the nodes from the back to the head, or none where the trunk is one piece.

    The head is the joint on the middle plane that is named so, or else the foremost end of a chain
    of such joints; the spine is what leads there, and, where that begins ahead of the hind hips,
    the joints that lie between.
    """
    lowest = float(middle.hip[:, 1].mean()) - BELOW_HIPS * middle.length
    place = middle.skeleton.position
    trunk = {
        node
        for node in middle.joints
        if (place[node, 1] > lowest or place[node, 2] > middle.hip[:, 2].max())
        and not has_word(middle.skeleton.name[node], *TAIL_NAMES)
    }
    chains = [middle.chain_to(head, trunk) for head in _heads(middle, trunk)]
    best = max(chains, key=len, default=[])
    return _back_to_the_hips(middle, trunk, best) if best else []


def _heads(middle: Middle, trunk: set[int]) -> list[int]:
    """Return the joints that may be the head."""
    skeleton, hip = middle.skeleton, middle.hip
    named = [
        node
        for node in sorted(trunk)
        if has_word(skeleton.name[node], *HEAD_NAMES)
        and not _named_so(skeleton, int(skeleton.parent[node]))
    ]
    if named:
        return named
    ends = [
        _without_jaw(skeleton, node, trunk)
        for node in sorted(trunk)
        if not set(skeleton.children[node]) & trunk
        and not has_word(skeleton.name[node], *NOT_HEAD)
        and _front(skeleton, node) > hip[:, 2].max() - 0.1 * middle.length
        and skeleton.position[node, 1] > hip[:, 1].mean() - 0.3 * middle.length
    ]
    return list(dict.fromkeys(ends))


def _without_jaw(skeleton: Skeleton, end: int, trunk: set[int]) -> int:
    """Return the end of a chain, or the joint above it whose skin reaches as far forward."""
    above = int(skeleton.parent[end])
    while above in trunk and _front(skeleton, above) >= _front(skeleton, end):
        end, above = above, int(skeleton.parent[above])
    return end


def _named_so(skeleton: Skeleton, node: int) -> bool:
    return node >= 0 and has_word(skeleton.name[node], *HEAD_NAMES)


def _front(skeleton: Skeleton, node: int) -> float:
    """Return how far forward a node or most of the skin that it carries reaches, m."""
    skin = skeleton.vertex[skeleton.carrier == node, 2]
    ahead = float(np.percentile(skin, 90.0)) if len(skin) else -np.inf
    return max(float(skeleton.position[node, 2]), ahead)


def _back_to_the_hips(middle: Middle, trunk: set[int], chain: list[int]) -> list[int]:
    """Return the chain with the joints before it that lie between the hind hips and its start."""
    hips = float(middle.hip[:, 2].min())
    behind = hips - BEHIND_HIPS * middle.length
    while middle.back(chain[0]) > hips + NEAR_HIPS * middle.length:
        ahead = {node for top in chain[1:] for node in middle.skeleton.below(top)}
        ahead = ahead - set(middle.skeleton.below(chain[0])) | set(chain)
        nearer = middle.back(chain[0]) - 1e-3 * middle.length
        found = [node for node in sorted(trunk - ahead) if behind < middle.back(node) < nearer]
        if not found:
            # A pelvis that reaches far behind its hips.
            found = [n for n in _carriers(middle, trunk - ahead) if middle.back(n) < nearer]
        if not found:
            break
        chain = [max(found, key=middle.back), *chain]
    return chain


def _carriers(middle: Middle, trunk: set[int]) -> list[int]:
    """Return the joints of the trunk from which the hindmost legs hang."""
    rear = float(middle.hip[:, 2].min()) + NEAR_HIPS * middle.length
    found = []
    for limb, place in zip(middle.limbs, middle.hip, strict=True):
        above = [node for node in middle.skeleton.above(limb.joints[0]) if node in trunk]
        if place[2] <= rear and above:
            found.append(above[0])
    return found


def find_tail(middle: Middle, spine: list[int]) -> list[int]:
    """Return the nodes of the tail, from the trunk to the tip, or none.

    It is the longest chain of joints on the middle plane that is named so, or else that begins at
    the hind hips or behind them and leads backward.
    """
    skeleton = middle.skeleton
    usable = set(middle.joints) - {
        above for node in spine for above in (node, *skeleton.above(node))
    }
    hips = float(middle.hip[:, 2].min())
    found: list[tuple[bool, float, list[int]]] = []
    for tip in sorted(usable):
        chain = middle.chain_to(tip, usable)
        named = has_word(skeleton.name[chain[-1]], *TAIL_NAMES)
        points = np.array([*skeleton.position[chain], _end(skeleton, chain[-1])])
        near = NEAR_HIPS * middle.length
        leads_back = points[0, 2] < hips + near and points[-1, 2] < min(points[0, 2], hips) - near
        reach = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
        if (named or leads_back) and reach >= LEAST_TAIL * middle.length:
            found.append((named, reach, chain))
    return max(found, key=lambda each: each[:2], default=(False, 0.0, []))[2]


def _end(skeleton: Skeleton, node: int) -> FloatArray:
    """Return the skin of a node that is farthest from it [3]."""
    skin = skeleton.vertex[skeleton.carrier == node]
    place = skeleton.position[node]
    return np.asarray(skin[np.linalg.norm(skin - place, axis=1).argmax()] if len(skin) else place)
