"""The segments of a spine, and what rides on them (P2 5): static data."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polypod.morphology.girdles import Girdles
from polypod.morphology.types import FloatArray, IntArray, Morphology


class SpineTable(NamedTuple):
    """The S segments of a spine, from back to head, the T of a tail, and what rides on them."""

    joint: IntArray  # [S] row of the joint table of each segment's own joint, -1: none in the rig
    pivot_rest: FloatArray  # [S + 1, 3] body frame, m: where each begins, and the last one's end
    bone_length: FloatArray  # [S] m, constant between consecutive pivots
    limit: FloatArray  # [S, 3] rad: yaw, pitch, roll against the one behind it
    of_girdle: IntArray  # [G] the segment on which each girdle sits, -1: the body itself
    of_leg: IntArray  # [K] the segment on which each leg hangs, -1: the body itself
    of_joint: IntArray  # [J] the segment on which a joint that is no leg's rides, -1: the body
    head: int  # segment of the head, -1: there is none
    neck: int  # first segment ahead of the foremost girdle
    tail_joint: IntArray  # [T] row of the joint table, from the root to the tip
    tail_pivot_rest: FloatArray  # [T + 1, 3]
    tail_limit: FloatArray  # [T, 3] rad: yaw, pitch, roll against the one nearer the root


def make_spine(morphology: Morphology, girdles: Girdles) -> SpineTable:
    """Return the spine of a morphology as kernels read it."""
    legs = morphology.legs
    joints = len(morphology.joint_node)
    chain = list(morphology.spine) if len(girdles.place) > 1 else []
    count = len(chain)
    place = morphology.joint_rest[chain].reshape(count, 3)
    pivot = np.zeros((count + 1, 3))
    pivot[:count] = place
    if count:
        pivot[count] = place[-1] + (place[-1] - place[-2])
    of_girdle = np.full(len(girdles.place), -1, np.int64)
    for g, z in enumerate(girdles.place):
        if count:
            of_girdle[g] = max(0, int(np.searchsorted(place[:, 2], z + 0.07) - 1))
    of_leg = of_girdle[girdles.of_leg] if count else np.full(len(legs.row), -1, np.int64)
    of_joint = np.full(joints, -1, np.int64)
    driven = {int(j) for j in legs.joint.ravel() if j >= 0}
    driven |= {int(j) for j in (*legs.foot_joint, *legs.toe_joint) if j >= 0}
    on_leg = set(driven)
    tail: list[int] = []
    for j in range(joints):
        parent = int(morphology.joint_parent[j])
        if j in on_leg or parent in on_leg:
            on_leg.add(j)
            continue
        if j in chain:
            of_joint[j] = chain.index(j)
        elif count and morphology.joint_name[j].startswith("Tail"):
            tail.append(j)
            of_joint[j] = count + len(tail) - 1
        elif parent >= 0:
            of_joint[j] = of_joint[parent]
    tail_pivot = np.zeros((len(tail) + 1, 3))
    if tail:
        tail_pivot[:-1] = morphology.joint_rest[tail]
        tail_pivot[-1] = 2.0 * tail_pivot[-2] - tail_pivot[-3]
    limit = np.tile([0.3, 0.25, 0.1], (count, 1))
    return SpineTable(
        joint=np.array(chain, np.int64),
        pivot_rest=pivot,
        bone_length=np.linalg.norm(np.diff(pivot, axis=0), axis=1),
        limit=limit,
        of_girdle=of_girdle,
        of_leg=np.ascontiguousarray(of_leg),
        of_joint=of_joint,
        head=count - 1,
        neck=int(of_girdle[-1]) + 1 if count else -1,
        tail_joint=np.array(tail, np.int64),
        tail_pivot_rest=tail_pivot,
        tail_limit=np.tile([0.3, 0.2, 0.1], (len(tail), 1)),
    )
