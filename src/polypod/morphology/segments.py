"""The table of a spine's segments, from the chains of joints found or named in a skeleton."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from polypod.errors import choices
from polypod.morphology.chains import Chains
from polypod.morphology.flexibility import default_limits, tail_limits
from polypod.morphology.girdles import Girdles
from polypod.morphology.skeleton import Skeleton
from polypod.morphology.spine import SpineTable, rigid_trunk
from polypod.morphology.types import FloatArray, IntArray, LegTable

# Of a leg's length:
SHORTEST = 0.02  # a segment is longer, and in the trunk leads so far forward
BESIDE = 0.35  # a leg is believed to hang on the segment that its file says when no farther from it
BEGIN_BEHIND = 0.1  # the first segment is at least so long, where no joint says where it begins
LEANS = 0.7  # cosine: a bone that leans more against the spine's way says nothing of its begin
AHEAD = 0.15  # the first segment begins no farther ahead of the hips
FRONT = 98.0  # per cent of the skin: where a head ends, without single hairs


@dataclass(frozen=True)
class Trunk:
    """What the table is made from: a rig, its joint table and its legs in the body frame."""

    skeleton: Skeleton
    centre: FloatArray  # [3] the body centre in the skeleton's frame
    rows: list[int]  # [J] node of each joint
    parent: IntArray  # [J] row of the joint it rides on, -1: the body
    legs: LegTable
    girdles: Girdles

    def place(self, node: int) -> FloatArray:
        """Return where a node is at rest [3], body frame.

        Off the middle plane where the file has it so, by a little: else the joints of a record
        would not stay as far apart as they are.
        """
        return np.asarray(self.skeleton.position[node] - self.centre)

    def skin(self, node: int) -> FloatArray:
        """Return the skin [V, 3] that a node carries more than any other does, body frame."""
        return np.asarray(self.skeleton.vertex[self.skeleton.carrier == node] - self.centre)


def build_spine(trunk: Trunk, chains: Chains | None) -> tuple[SpineTable, list[str]]:
    """Return the table, and what was guessed; a rigid trunk where fewer than two segments are left.

    What lies behind the hindmost girdle becomes part of the tail, and a joint from which the spine
    would not go on is left out: it rides on its neighbour.

    Args:
        trunk: the rig.
        chains: joints of spine and tail; None where the trunk is not to bend.
    """
    legs, girdles, leg_length = trunk.legs, trunk.girdles, float(trunk.legs.length.mean())
    places = range(len(girdles.place))
    girdle_rest = np.array(
        [legs.point_rest[girdles.of_leg == g, 0].mean(axis=0) for g in places]
    ).reshape(-1, 3)
    nodes, behind = (list(chains.spine), list(chains.tail)) if chains else ([], [])
    while len(nodes) > 1:
        pivot = _pivots(trunk, nodes, girdle_rest[0], leg_length)
        by_tree = [_by_tree(trunk, nodes, pivot, g, BESIDE * leg_length) for g in places]
        nearest = [nearest_bone(pivot[:-1], place) for place in girdle_rest]
        said = [a if a >= 0 else b for a, b in zip(by_tree, nearest, strict=True)]
        of_girdle = np.maximum.accumulate(np.array(said, np.int64))
        if of_girdle[0] > 0:
            nodes, behind = nodes[of_girdle[0] :], nodes[: of_girdle[0]][::-1] + behind
            continue
        fault = _does_not_go_on(pivot, of_girdle, SHORTEST * leg_length)
        if fault < 0:
            table = _table(trunk, nodes, behind, pivot, of_girdle, girdle_rest)
            return table, _guesses(trunk, nodes, of_girdle, by_tree)
        nodes.pop(fault - 1 if fault == len(nodes) - 1 else fault)
    return rigid_trunk(len(legs.length), len(trunk.rows), len(girdles.place)), []


def _table(
    trunk: Trunk,
    nodes: list[int],
    behind: list[int],
    pivot: FloatArray,
    of_girdle: IntArray,
    girdle_rest: FloatArray,
) -> SpineTable:
    """Return the table of a spine with its girdles in their places, and of the tail behind it."""
    legs, leg_length = trunk.legs, float(trunk.legs.length.mean())
    row_of = {node: row for row, node in enumerate(trunk.rows)}
    length = np.linalg.norm(np.diff(pivot, axis=0), axis=1)
    tail_pivot, behind = _tail_pivots(trunk, nodes[0], behind, SHORTEST * leg_length)
    tail_length = np.linalg.norm(np.diff(tail_pivot, axis=0), axis=1)
    of_leg = of_girdle[trunk.girdles.of_leg]
    neck = int(of_girdle[-1]) + 1
    upright = bool(np.mean(legs.upright) > 0.5)
    return SpineTable(
        joint=np.array([row_of[node] for node in nodes], np.int64),
        pivot_rest=pivot,
        bone_length=length,
        limit=default_limits(length, of_girdle, upright, leg_length),
        hinge=_hinges(trunk, nodes),
        of_girdle=of_girdle,
        of_leg=of_leg,
        of_joint=_seat_joints(trunk, nodes, behind, pivot, tail_pivot, of_leg),
        girdle_rest=girdle_rest,
        head=len(nodes) - 1 if neck < len(nodes) else -1,
        neck=neck,
        tail_joint=np.array([row_of[node] for node in behind], np.int64),
        tail_pivot_rest=tail_pivot,
        tail_length=tail_length,
        tail_limit=tail_limits(tail_length),
    )


def _pivots(trunk: Trunk, nodes: list[int], hips: FloatArray, leg_length: float) -> FloatArray:
    """Return [S + 1, 3] where each segment begins, and where the last ends."""
    between = [_pivot(trunk, a, b) for a, b in pairwise(nodes)]
    begin, along = trunk.place(nodes[0]), trunk.place(nodes[-1]) - trunk.place(nodes[0])
    bone = between[0] - begin
    size = float(np.linalg.norm(bone) * np.linalg.norm(along))
    ahead = begin[2] > hips[2] + AHEAD * leg_length
    if not bone @ along > LEANS * size or ahead:
        # Its joint lies at its fore end, or above the hips: these say where the spine begins.
        back = min(float(hips[2]), float(between[0][2]) - BEGIN_BEHIND * leg_length)
        begin = np.array([*between[0][:2], back])
    return np.array([begin, *between, _front(trunk, nodes[-1], between[-1])])


def _pivot(trunk: Trunk, a: int, b: int) -> FloatArray:
    """Return where the segments of two joints of a chain meet: at the pivot of the one below.

    Where neither hangs on the other, at the pivot nearer to the seam of their skins.
    """
    skeleton = trunk.skeleton
    if a in skeleton.above(b):
        return trunk.place(b)
    if b in skeleton.above(a):
        return trunk.place(a)
    shared = np.minimum(skeleton.share([a]), skeleton.share([b]))
    if not shared.any():
        return trunk.place(b)
    seam = shared @ (skeleton.vertex - trunk.centre) / shared.sum()
    return min((trunk.place(b), trunk.place(a)), key=lambda place: abs(float(place[2] - seam[2])))


def _front(trunk: Trunk, node: int, pivot: FloatArray) -> FloatArray:
    """Return where the last segment ends [3]: the front of its skin."""
    skin = trunk.skin(node)
    ahead = skin[skin[:, 2] > pivot[2]]
    if not len(ahead):
        length = float(np.ptp(trunk.skeleton.vertex[:, 2]))
        return np.array([*pivot[:2], pivot[2] + 2.0 * SHORTEST * length])
    front = float(np.percentile(ahead[:, 2], FRONT))
    nose = ahead[ahead[:, 2] > pivot[2] + 0.7 * (front - pivot[2])]
    return np.array([pivot[0], float(nose[:, 1].mean()), front])


def _by_tree(trunk: Trunk, nodes: list[int], pivot: FloatArray, girdle: int, far: float) -> int:
    """Return the segment on which the file's tree hangs most legs of a girdle, -1: on none.

    A tree that hangs all legs on one root says nothing about girdles: their segment is near.
    """
    segment_of = {node: s for s, node in enumerate(nodes)}
    above = []
    for k in np.flatnonzero(trunk.girdles.of_leg == girdle):
        joints = trunk.skeleton.above(trunk.rows[int(trunk.legs.joint[k, 0])])
        above.extend([segment_of[node] for node in joints if node in segment_of][:1])
    said = max(sorted(set(above)), key=above.count, default=-1)
    if said >= 0:
        low, high = sorted(pivot[said : said + 2, 2])
        if not low - far <= trunk.girdles.place[girdle] <= high + far:
            return -1
    return said


def _guesses(trunk: Trunk, nodes: list[int], of_girdle: IntArray, by_tree: list[int]) -> list[str]:
    """Return what was guessed about what rides where."""
    label = trunk.skeleton.label
    found = []
    for g, segment in enumerate(of_girdle):
        if by_tree[g] != segment:
            hips = trunk.legs.joint[trunk.girdles.of_leg == g, 0]
            legs = choices((label(trunk.rows[int(row)]) for row in hips), 6)
            near = label(nodes[segment])
            found.append(
                f'{legs}: hang on no joint of the spine, so they go with "{near}", near them'
            )
        if g > 0 and segment == of_girdle[g - 1]:
            found.append(
                f'its trunk has no joint between its girdles but "{label(nodes[segment])}", so it '
                "does not bend there"
            )
    return found


def nearest_bone(pivot: FloatArray, place: FloatArray) -> int:
    """Return which bone of a chain with pivots [S + 1, 3] is nearest to a place [3] from aside."""
    side = pivot[:, 1:]
    start, bone, seen = side[:-1], np.diff(side, axis=0), place[1:]
    square = np.maximum(np.einsum("si,si->s", bone, bone), 1e-300)
    along = np.einsum("si,si->s", seen - start, bone) / square
    away = np.linalg.norm(start + np.clip(along, 0.0, 1.0)[:, None] * bone - seen, axis=1)
    return int(np.argmin(away))


def _does_not_go_on(pivot: FloatArray, of_girdle: IntArray, least: float) -> int:
    """Return the first segment that is too short, or leads backward within the trunk; -1: none."""
    step = np.diff(pivot, axis=0)
    bad = np.linalg.norm(step, axis=1) < least
    if len(of_girdle) > 1:
        in_trunk = np.arange(len(step)) <= of_girdle[-1]
        bad |= in_trunk & (step[:, 2] < least)
    return int(np.argmax(bad)) if bad.any() else -1


def _hinges(trunk: Trunk, nodes: list[int]) -> IntArray:
    """Return [S] before which segment the joint's own turn is: behind its own, or ahead of it."""
    hinge = np.arange(len(nodes))
    for s in range(len(nodes) - 1):
        if nodes[s + 1] in trunk.skeleton.above(nodes[s]):
            hinge[s] = s + 1
    return hinge


def _tail_pivots(
    trunk: Trunk, root: int, tail: list[int], least: float
) -> tuple[FloatArray, list[int]]:
    """Return [T + 1, 3] where each segment of the tail begins and the tip, and the joints kept."""
    kept: list[int] = []
    pivot: list[FloatArray] = []
    for node in tail:
        place = _pivot(trunk, kept[-1] if kept else root, node)
        if not pivot or float(np.linalg.norm(place - pivot[-1])) >= least:
            kept.append(node)
            pivot.append(place)
    if not kept:
        return np.zeros((1, 3)), []
    skin = trunk.skin(kept[-1])
    away = np.linalg.norm(skin - pivot[-1], axis=1)
    tip = pivot[-1] - [0.0, 0.0, 2.0 * least]
    if len(skin) and float(away.max()) > least:
        tip = np.array([pivot[-1][0], *skin[int(away.argmax()), 1:]])
    return np.array([*pivot, tip]), kept


def _seat_joints(
    trunk: Trunk,
    spine: list[int],
    tail: list[int],
    pivot: FloatArray,
    tail_pivot: FloatArray,
    of_leg: IntArray,
) -> IntArray:
    """Return [J] the segment on which each joint rides that no leg carries, -1 for others.

    By the file's tree where that leads to the spine or the tail, else by the nearest bone to its
    skin. What carries nothing and hangs on nothing, as the root of a rig, rides on the body.
    """
    skeleton, legs = trunk.skeleton, trunk.legs
    seat = np.full(len(trunk.rows), -1, np.int64)
    chain = {node: s for s, node in enumerate([*spine, *tail])}
    driven = {int(row) for table in (legs.joint, legs.foot_joint, legs.toe_joint)
              for row in table.ravel() if row >= 0}  # fmt: skip
    hips = {trunk.rows[int(legs.joint[k, 0])]: k for k in range(len(legs.length))}
    on_leg = np.zeros(len(trunk.rows), np.bool_)
    for row, node in enumerate(trunk.rows):
        parent = int(trunk.parent[row])
        on_leg[row] = row in driven or (parent >= 0 and on_leg[parent])
        if node in chain:
            seat[row] = chain[node]
        elif not on_leg[row]:
            below = set(skeleton.below(node))
            carried = {int(of_leg[k]) for hip, k in hips.items() if hip in below}
            if len(carried) == 1 and not below & set(chain):
                seat[row] = carried.pop()  # a shoulder goes with its leg
            elif parent >= 0 and seat[parent] >= 0:
                seat[row] = seat[parent]
            elif skeleton.weight[node] > 0.0:
                seat[row] = _nearest_segment(pivot, tail_pivot, trunk.skin(node), trunk.place(node))
    return seat


def _nearest_segment(
    pivot: FloatArray, tail_pivot: FloatArray, skin: FloatArray, place: FloatArray
) -> int:
    """Return the segment of spine or tail nearest to the middle of some skin, or to a place."""
    middle = skin.mean(axis=0) if len(skin) else place
    bones = [*pairwise(pivot), *pairwise(tail_pivot)]
    return int(np.argmin([_away(np.array(bone), middle) for bone in bones]))


def _away(bone: FloatArray, place: FloatArray) -> float:
    """Return the distance from a place [3] to a bone [2, 3]."""
    way = bone[1] - bone[0]
    along = np.clip((place - bone[0]) @ way / max(float(way @ way), 1e-300), 0.0, 1.0)
    return float(np.linalg.norm(bone[0] + along * way - place))
