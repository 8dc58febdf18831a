"""Finds the legs of a rig whose legs nobody named.

A *limb* is a branch of the skeleton that stays on one side of the middle plane. A limb whose skin
reaches the ground at its far end is a leg, if it has a mirror image; a limb at whose root another
limb's tip lies is a detached foot and belongs to that limb. Names only break ties.

Frame: metres, facing +Z, origin where the file has it, rest pose.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from polypod.errors import RigError, choices
from polypod.morphology.facing import mirror_misfit
from polypod.morphology.limb import COINCIDENT, build_limb, touched_by
from polypod.morphology.names import has_word
from polypod.morphology.skeleton import Skeleton
from polypod.morphology.sole import find_sole, is_flat_foot

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

OFF_MIDDLE = 0.02  # of the creature's width
TOUCHES = 0.12  # of a limb's length: so near the ground its end stands
FOOT_HEIGHT = 0.2  # of a limb's length: a foot's pivot is no higher
LOW = 0.3  # of a hip's height: a foot that hangs nowhere is no higher
LIKE_ITS_IMAGE = 0.2  # of a limb's length, between a leg and its mirrored partner
LEAST_LENGTH = 0.3  # of the longest leg
SIDEWAYS = 0.7  # of a girdle's bone, along x
GIRDLE_LENGTH = 0.35  # of the leg's
NEVER_A_LEG = ("tail", "wing", "ear", "hair", "antenna", "tongue", "skirt", "cape", "cloth", "fin")
GIRDLE_NAMES = ("clavicle", "collar", "scapula", "girdle")


@dataclass(frozen=True)
class Candidate:
    """A limb that may be a leg."""

    path: tuple[int, ...]  # from the limb's root to its lowest end
    foot: int
    hip: int
    place: FloatArray  # [3] its sole
    length: float  # m, hip to sole


def detect_legs(skeleton: Skeleton) -> tuple[list[tuple[int, int]], list[str]]:
    """Find the legs.

    Args:
        skeleton: the rig, metres, facing +Z.

    Returns:
        pairs of hip and foot nodes, and sentences about what was guessed.

    Raises:
        RigError: no limb reaches the ground.
    """
    middle = _middle(skeleton)
    roots = _limb_roots(skeleton, middle)
    candidates = _candidates(skeleton, roots)
    legs, left_out = _with_mirror_image(candidates, middle)
    legs += _in_the_middle(skeleton, middle, legs)
    if not legs:
        joints = [skeleton.label(n) for n in range(len(skeleton.name)) if skeleton.is_joint[n]]
        raise RigError(
            f"{skeleton.document.name}: no legs were found, for no limb with skin reaches the "
            f"ground at rest; name them with --leg HIP:FOOT, from {choices(joints)}"
        )
    named = ", ".join(f"{skeleton.label(leg.hip)}:{skeleton.label(leg.foot)}" for leg in legs)
    guesses = [f"its legs were detected: {named}; --leg HIP:FOOT names others"]
    guesses += [
        f'"{skeleton.label(leg.foot)}" reaches the ground but has no mirror image, so it was taken '
        "for no leg; --leg HIP:FOOT names all legs"
        for leg in left_out
    ]
    return [(leg.hip, leg.foot) for leg in legs], guesses


def _middle(skeleton: Skeleton) -> float:
    """Return x of the middle plane."""
    points = skeleton.position[skeleton.is_joint & (skeleton.weight > 0.0)]
    return mirror_misfit(points, 0)[1]


def _limb_roots(skeleton: Skeleton, middle: float) -> list[int]:
    """Return the topmost nodes whose whole branch is on one side, and which carry skin."""
    tolerance = OFF_MIDDLE * float(np.ptp(skeleton.vertex[:, 0]))
    across = skeleton.position[:, 0] - middle
    side = np.where(np.abs(across) > tolerance, np.sign(across), 0.0)
    one_sided = np.array(
        [
            bool(side[node] != 0.0 and np.all(side[skeleton.below(node)] == side[node]))
            for node in range(len(side))
        ]
    )
    return [
        node
        for node in range(len(side))
        if one_sided[node]
        and (skeleton.parent[node] < 0 or not one_sided[skeleton.parent[node]])
        and skeleton.weight[skeleton.below(node)].sum() > 0.0
    ]


def _candidates(skeleton: Skeleton, roots: list[int]) -> list[Candidate]:
    """Return the limbs that stand, detached feet joined to the limbs they belong to."""
    ends = {root: _lowest_end(skeleton, root) for root in roots}
    standing = [root for root in roots if _touches(skeleton, ends[root])]
    candidates = []
    taken: set[int] = set()
    for root in sorted(standing, key=lambda node: len(ends[node])):
        others = [other for other in roots if other != root]
        host, tip = _host(skeleton, root, others)
        if host < 0 and len(ends[root]) <= 2:
            host, tip = _shank(skeleton, root, others)
        if host < 0:
            continue
        taken.update((root, host))
        candidates.append(_candidate(skeleton, skeleton.path(host, tip), foot=root))
    for root in standing:
        if root not in taken and len(ends[root]) > 1:
            candidates.append(_candidate(skeleton, ends[root]))
    found = [candidate for candidate in candidates if candidate is not None]
    longest = max((leg.length for leg in found), default=0.0)
    return [leg for leg in found if leg.length >= LEAST_LENGTH * longest]


def _lowest_end(skeleton: Skeleton, root: int) -> list[int]:
    """Return the path from a limb's root to the foot of its lowest end.

    Toes that stand together end the path at the foot from which they branch.
    """
    nodes = skeleton.below(root)
    low = _lowest_skin(skeleton, nodes)
    leaves = [node for node in nodes if not skeleton.children[node]]
    # A leaf without skin stands for the skin of the joint that it marks the end of.
    heights = {leaf: _height_at(skeleton, leaf, root, low) for leaf in leaves}
    lowest = min(leaves, key=lambda leaf: (heights[leaf], leaf))
    path = skeleton.path(root, lowest)
    reach = _length(skeleton, path)
    near = [leaf for leaf in leaves if heights[leaf] <= heights[lowest] + 0.5 * TOUCHES * reach]
    while len(path) > 1 and len(near) > 1:
        shared = set(skeleton.path(root, near[0]))
        for leaf in near[1:]:
            shared &= set(skeleton.path(root, leaf))
        fork = max(shared, key=lambda node: len(skeleton.path(root, node)))
        if skeleton.position[fork, 1] - heights[lowest] > 0.3 * reach:
            break
        return skeleton.path(root, fork)
    return path


def _lowest_skin(skeleton: Skeleton, nodes: list[int]) -> dict[int, float]:
    """Return the height of the lowest vertex that each node carries, infinite for none."""
    lowest = np.full(len(skeleton.parent), np.inf)
    np.minimum.at(lowest, skeleton.carrier, skeleton.vertex[:, 1])
    return {node: float(lowest[node]) for node in nodes}


def _height_at(skeleton: Skeleton, leaf: int, root: int, low: dict[int, float]) -> float:
    for node in reversed(skeleton.path(root, leaf)):
        if np.isfinite(low[node]):
            return low[node]
    return float("inf")


def _length(skeleton: Skeleton, path: list[int]) -> float:
    return float(np.linalg.norm(np.diff(skeleton.position[path], axis=0), axis=1).sum())


def _touches(skeleton: Skeleton, path: list[int]) -> bool:
    """Tell whether the far end of a limb is on the ground."""
    if any(has_word(skeleton.name[node], *NEVER_A_LEG) for node in path):
        return False
    skin = skeleton.vertex[skeleton.share(_end_group(skeleton, path)) >= 0.5]
    if not len(skin):
        return False
    reach = _length(skeleton, path)
    reach += float(np.linalg.norm(skin - skeleton.position[path[-1]], axis=1).max())
    return float(skin[:, 1].min()) - skeleton.ground <= TOUCHES * reach


def _end_group(skeleton: Skeleton, path: list[int]) -> list[int]:
    """Return the nodes at and below the last node of a path that carries skin."""
    for node in reversed(path):
        below = skeleton.below(node)
        if skeleton.weight[below].sum() > 0.0:
            return below
    return [path[-1]]


def _host(skeleton: Skeleton, root: int, others: list[int]) -> tuple[int, int]:
    """Return the limb whose tip is where a detached foot hangs, and that tip; -1 for none."""
    best: tuple[float, int, int] = (np.inf, -1, -1)
    for other in others:
        for tip in skeleton.below(other)[1:]:
            length = _length(skeleton, skeleton.path(other, tip))
            away = float(np.linalg.norm(skeleton.position[tip] - skeleton.position[root]))
            if away <= COINCIDENT * length:
                best = min(best, (away / length, other, tip))
    return best[1], best[2]


def _shank(skeleton: Skeleton, root: int, others: list[int]) -> tuple[int, int]:
    """Return the limb whose skin touches a low foot that hangs nowhere, and the joint it is on."""
    for other in others:
        rise = float(skeleton.position[other, 1]) - skeleton.ground
        if float(skeleton.position[root, 1]) - skeleton.ground <= LOW * rise:
            joint = touched_by(skeleton, other, root)
            if joint >= 0 and joint != other:
                return other, joint
    return -1, -1


def _candidate(skeleton: Skeleton, path: list[int], foot: int = -1) -> Candidate | None:
    """Return the leg along a path: its foot where none is given, its hip without the girdle."""
    if foot < 0:
        foot = _choose_foot(skeleton, path)
        path = skeleton.path(path[0], foot)
    if len(path) < 2:
        return None
    limb = build_limb(skeleton, path[0], foot)
    hip = limb.joints[_girdle(skeleton, list(limb.joints), limb.sole.place, limb.length)]
    limb = build_limb(skeleton, hip, foot)
    return Candidate(tuple(path), foot, hip, limb.sole.place, limb.length)


def _choose_foot(skeleton: Skeleton, path: list[int]) -> int:
    """Return the topmost joint of a path that is a flat foot; else its last node with skin.

    A last node without skin marks the sole itself, as robots' rigs do.
    """
    length = _length(skeleton, path)
    for place, node in enumerate(path[2:], start=2):
        if skeleton.weight[skeleton.below(node)].sum() <= 0.0:
            break
        pivot = skeleton.position[node]
        chain = _length(skeleton, path[: place + 1])
        sole = find_sole(skeleton, skeleton.below(node), path[0], pivot, chain)
        reach = max(length, chain + float(np.linalg.norm(sole.place - pivot)))
        low_enough = pivot[1] - sole.place[1] <= FOOT_HEIGHT * reach
        if low_enough and is_flat_foot(sole, pivot, reach):
            return node
    return path[-1]


def _girdle(skeleton: Skeleton, joints: list[int], sole: FloatArray, length: float) -> int:
    """Return how many leading joints are a girdle, which is no part of the leg: 0 or 1.

    A girdle's bone leads sideways to a hip that stands above its sole, or is named so.
    """
    if len(joints) < 3:
        return 0
    bone = skeleton.position[joints[1]] - skeleton.position[joints[0]]
    size = float(np.linalg.norm(bone))
    away = sole - skeleton.position[joints[1]]
    upright = np.hypot(away[0], away[2]) < -0.6 * away[1]
    sideways = abs(bone[0]) >= SIDEWAYS * size and size < GIRDLE_LENGTH * length
    if upright and sideways:
        return 1
    first, second = (skeleton.name[joint] for joint in joints[:2])
    named = has_word(first, *GIRDLE_NAMES) or (
        has_word(first, "shoulder") and has_word(second, "upper", "arm", "humerus")
    )
    return int(named)


def _with_mirror_image(
    candidates: list[Candidate], middle: float
) -> tuple[list[Candidate], list[Candidate]]:
    """Return the candidates that have a partner across the middle plane, and those without."""
    legs: list[Candidate] = []
    rest: list[Candidate] = []
    for leg in candidates:
        image = leg.place * np.array([-1.0, 1.0, 1.0]) + np.array([2.0 * middle, 0.0, 0.0])
        away = [
            float(np.linalg.norm(other.place - image)) + abs(other.length - leg.length)
            for other in candidates
            if other is not leg
        ]
        near = min(away, default=np.inf) <= LIKE_ITS_IMAGE * leg.length
        (legs if near else rest).append(leg)
    return (legs, rest) if legs else (rest, [])


def _in_the_middle(skeleton: Skeleton, middle: float, legs: list[Candidate]) -> list[Candidate]:
    """Return legs on the middle plane: like the others, or the only ones."""
    tolerance = OFF_MIDDLE * float(np.ptp(skeleton.vertex[:, 0]))
    central = np.abs(skeleton.position[:, 0] - middle) <= tolerance
    found = []
    for leaf in range(len(skeleton.parent)):
        if skeleton.children[leaf] or not central[leaf]:
            continue
        path = [leaf]
        # Up to where another branch with skin joins: that is the trunk.
        while True:
            parent = int(skeleton.parent[path[0]])
            if parent < 0 or not central[parent] or skeleton.weight[parent] <= 0.0:
                break
            others = [child for child in skeleton.children[parent] if child != path[0]]
            if any(skeleton.weight[skeleton.below(child)].sum() > 0.0 for child in others):
                break
            path.insert(0, parent)
        above = int(skeleton.parent[path[0]])
        if len(path) > 2 and (above < 0 or skeleton.weight[above] <= 0.0):
            path.pop(0)  # nothing else can be the trunk
        if len(path) < 2 or not _touches(skeleton, path):
            continue
        leg = _candidate(skeleton, path)
        if leg is None:
            continue
        like = [abs(leg.length - other.length) < 0.25 * other.length for other in legs]
        if all(like):
            found.append(leg)
    return found
