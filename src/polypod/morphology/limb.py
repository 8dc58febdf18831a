"""One leg from its hip and its foot: the joints that turn, the foot, the sole.

Frame of this module: metres, +Y up, facing +Z, origin where the file has it, rest pose.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from polypod.errors import RigError, choices
from polypod.morphology.names import has_word
from polypod.morphology.skeleton import Skeleton
from polypod.morphology.sole import Sole, find_sole, is_flat_foot

FloatArray = NDArray[np.float64]

# A detached foot hangs where the chain's tip is, within this part of the leg's length.
COINCIDENT = 0.02
# Without a joint at the tip: the foot's pivot touches the shank's skin, within this part.
TOUCHING = 0.1
TOE_SPREAD = 0.06  # of the leg's length: toes of one foot branch so near each other
LOWERED = "its sole was put below the mark, where the skin is lowest"


@dataclass(frozen=True)
class Limb:
    """A leg at rest; node indices, places in the module's frame."""

    hip: int
    foot: int  # the node that was named or detected
    joints: tuple[int, ...]  # turned by inverse kinematics, hip first
    foot_joint: int  # the oriented foot, -1: the last joint ends in the sole
    effector: FloatArray  # [3] what inverse kinematics brings to its place
    sole: Sole
    length: float  # hip to sole along the chain
    rides: dict[int, int] = field(default_factory=dict)  # node -> node it must move with
    guesses: tuple[str, ...] = ()  # phrases about this foot

    @property
    def sole_node(self) -> int:
        """The node to which the sole is fixed."""
        return self.foot_joint if self.foot_joint >= 0 else self.joints[-1]


@dataclass(frozen=True)
class Chain:
    """The way from a hip to a foot: joints above it, and the nodes that belong to the foot."""

    joints: list[int]  # hip first, without the foot
    foot: int  # the foot's pivot node, attached or detached
    detached: bool
    tip: int  # the chain's own node at the foot's place, -1 where there is none
    guesses: tuple[str, ...] = ()


def build_limb(skeleton: Skeleton, hip: int, foot: int) -> Limb:
    """Work out a leg.

    Args:
        skeleton: the rig in this module's frame.
        hip: node index of the first joint.
        foot: node index of the foot, below the hip or detached.

    Raises:
        RigError: no chain from the hip reaches the foot, or the leg has no length.
    """
    chain = find_chain(skeleton, hip, foot)
    limb = _detached(skeleton, foot, chain) if chain.detached else _attached(skeleton, chain)
    if not limb.joints or not limb.length > 0.0:
        raise RigError(
            f'{skeleton.document.name}: the leg from "{skeleton.label(hip)}" to '
            f'"{skeleton.label(foot)}" has no length; name a hip above its foot'
        )
    return limb


def find_chain(skeleton: Skeleton, hip: int, foot: int) -> Chain:
    """Find how the hip leads to the foot, looking for detached feet by coincidence.

    Raises:
        RigError: it does not.
    """
    path = skeleton.path(hip, foot)
    if path:
        length = _path_length(skeleton, path)
        twin = _detached_at(skeleton, hip, foot, COINCIDENT * length)
        if twin >= 0:
            return Chain(path[:-1], twin, True, foot)
        return Chain(path[:-1], foot, False, foot)
    return _chain_to_detached(skeleton, hip, foot)


def _path_length(skeleton: Skeleton, path: list[int]) -> float:
    return float(np.linalg.norm(np.diff(skeleton.position[path], axis=0), axis=1).sum())


def _detached_at(skeleton: Skeleton, hip: int, foot: int, tolerance: float) -> int:
    """Return the topmost skinned joint outside the leg at the foot's place, -1 for none."""
    own = set(skeleton.below(hip)) | set(skeleton.above(hip))
    away = np.linalg.norm(skeleton.position - skeleton.position[foot], axis=1)
    near = [
        int(node)
        for node in np.flatnonzero(skeleton.is_joint & (away <= tolerance))
        if int(node) not in own and skeleton.weight[skeleton.below(int(node))].sum() > 0.0
    ]
    tops = [node for node in near if not set(skeleton.above(node)) & set(near)]
    return min(tops, key=lambda node: (float(away[node]), node)) if tops else -1


def _chain_to_detached(skeleton: Skeleton, hip: int, foot: int) -> Chain:
    shared = set(skeleton.above(hip)) | {hip}
    roots = [node for node in [foot, *skeleton.above(foot)] if node not in shared]
    if foot in shared:
        roots = []
    found: list[tuple[float, int, int]] = []
    for tip in skeleton.below(hip)[1:]:
        length = _path_length(skeleton, skeleton.path(hip, tip))
        for root in roots:
            away = float(np.linalg.norm(skeleton.position[root] - skeleton.position[tip]))
            if length > 0.0 and away <= COINCIDENT * length:
                found.append((away / length, -tip, root))
    if found:
        _, tip, root = min(found)
        return Chain(skeleton.path(hip, -tip)[:-1], root, True, -tip)
    touched = touched_by(skeleton, hip, roots[-1]) if roots else -1
    if touched >= 0:
        guess = "hung on the shank whose skin it touches, for no joint is at its place"
        return Chain(skeleton.path(hip, touched), roots[-1], True, -1, (guess,))
    below = [node for node in skeleton.below(hip)[1:] if not skeleton.children[node]]
    reach = choices((skeleton.label(node) for node in below or [hip]), 12)
    raise RigError(
        f'{skeleton.document.name}: leg "{skeleton.label(hip)}:{skeleton.label(foot)}": no chain '
        f"from the hip reaches this foot, neither below the hip nor at its tip; it ends in {reach}"
    )


def touched_by(skeleton: Skeleton, hip: int, foot: int) -> int:
    """Return the lowest joint of the leg whose skin touches the detached foot's pivot, or -1."""
    for node in reversed(skeleton.below(hip)):
        skin = skeleton.vertex[skeleton.carrier == node]
        length = _path_length(skeleton, skeleton.path(hip, node))
        if len(skin) and length > 0.0:
            length += float(np.linalg.norm(skeleton.position[node] - skeleton.position[foot]))
            away = np.linalg.norm(skin - skeleton.position[foot], axis=1).min()
            if float(away) <= TOUCHING * length:
                return node
    return -1


def _detached(skeleton: Skeleton, named: int, chain: Chain) -> Limb:
    """Return the leg of a detached foot: the foot joint, and the chain's tip riding on it."""
    group = skeleton.below(chain.foot) + (skeleton.below(chain.tip) if chain.tip >= 0 else [])
    pivot = skeleton.position[chain.foot]
    joints = turning_joints(skeleton, chain.joints, pivot)
    chain_length = _chain_length(skeleton, joints, pivot)
    sole = find_sole(skeleton, group, joints[0], pivot, chain_length)
    rides = {chain.tip: chain.foot} if chain.tip >= 0 else {}
    length = chain_length + float(np.linalg.norm(sole.place - pivot))
    return Limb(
        joints[0], named, tuple(joints), chain.foot, pivot, sole, length, rides, chain.guesses
    )


def _attached(skeleton: Skeleton, chain: Chain) -> Limb:
    """Return the leg of a foot below its hip: an oriented foot, a pointed shank, or a mark."""
    foot, hip = chain.foot, chain.joints[0]
    if skeleton.weight[skeleton.below(foot)].sum() > 0.0:
        return _skinned_end(skeleton, chain.joints, foot, foot)
    # A mark without skin: the sole itself, unless it marks the toes of a flat foot.
    above = chain.joints
    if len(above) > 1:
        ends = _skinned_end(skeleton, above[:-1], above[-1], foot)
        if ends.foot_joint >= 0:
            return ends
    joints = turning_joints(skeleton, above, skeleton.position[foot])
    place = skeleton.position[foot]
    length = _chain_length(skeleton, joints, place)
    around = find_sole(skeleton, skeleton.below(joints[-1]), hip, place, length)
    sole = around.at_mark(place, length)
    drop = float(place[1] - sole.place[1])
    guesses = (LOWERED,) if drop > 0.03 * length else ()
    return Limb(hip, foot, tuple(joints), -1, sole.place, sole, length + drop, {}, guesses)


def _skinned_end(skeleton: Skeleton, above: list[int], last: int, named: int) -> Limb:
    """Return the leg whose last skinned joint is `last`: a flat foot, or a shank with a point."""
    hip, pivot = above[0], skeleton.position[last]
    chain_length = _chain_length(skeleton, above, pivot)
    toes = _toes_beside(skeleton, last, chain_length)
    group = [node for toe in (last, *toes) for node in skeleton.below(toe)]
    sole = find_sole(skeleton, group, hip, pivot, chain_length)
    length = chain_length + float(np.linalg.norm(sole.place - pivot))
    if is_flat_foot(sole, pivot, length):
        joints = turning_joints(skeleton, above, pivot)
        rides = dict.fromkeys(toes, last)
        return Limb(hip, named, tuple(joints), last, pivot, sole, length, rides)
    joints = turning_joints(skeleton, [*above, last], sole.place)
    return Limb(hip, named, tuple(joints), -1, sole.place, sole, length)


def _toes_beside(skeleton: Skeleton, foot: int, length: float) -> list[int]:
    """Return the joints that branch beside a foot at nearly its place: the foot's other toes."""
    beside = skeleton.children[skeleton.parent[foot]] if skeleton.parent[foot] >= 0 else ()
    return [
        node
        for node in beside
        if node != foot
        and skeleton.is_joint[node]
        and skeleton.weight[skeleton.below(node)].sum() > 0.0
        and np.linalg.norm(skeleton.position[node] - skeleton.position[foot]) <= TOE_SPREAD * length
    ]


def _chain_length(skeleton: Skeleton, joints: list[int], end: FloatArray) -> float:
    points = np.concatenate([skeleton.position[joints], end[None]])
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def turning_joints(skeleton: Skeleton, path: list[int], end: FloatArray) -> list[int]:
    """Return the joints of a path that bend the leg: no doubles at one place, no twist helpers.

    What is left out rides rigidly on the joint above it.
    """
    length = _chain_length(skeleton, path, end)
    kept = [path[0]]
    for node in path[1:]:
        gap = np.linalg.norm(skeleton.position[node] - skeleton.position[kept[-1]])
        if gap > 0.005 * length and not has_word(skeleton.name[node], "twist", "roll"):
            kept.append(node)
    while len(kept) > 1 and np.linalg.norm(skeleton.position[kept[-1]] - end) <= 0.005 * length:
        kept.pop()
    return kept
