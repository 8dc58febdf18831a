"""What a creature file says over what was derived: limits, foot shapes and weights."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from polypod.errors import RigError, choices
from polypod.morphology.creature import HIP_KEYS, SPINE_KEYS, Creature
from polypod.morphology.names import find_node
from polypod.morphology.skeleton import Skeleton
from polypod.morphology.spine import SpineTable
from polypod.morphology.types import FloatArray, LegTable, Morphology


def override_feet(morphology: Morphology, skeleton: Skeleton, creature: Creature) -> Morphology:
    """Return the morphology with the foot shapes and weights that the creature file gives.

    Raises:
        RigError: it names no foot.
    """
    half_size = morphology.legs.foot_half_size.copy()
    for name, size in creature.foot_half_size.items():
        half_size[_row_of_foot(name, morphology, skeleton, creature)] = size
    weight = np.ones(len(morphology.foot_name))
    for name, share in creature.foot_weight.items():
        weight[_row_of_foot(name, morphology, skeleton, creature)] = share
    legs = morphology.legs._replace(foot_half_size=half_size, weight=weight / weight.sum())
    return replace(morphology, legs=legs)


def _row_of_foot(name: str, morphology: Morphology, skeleton: Skeleton, creature: Creature) -> int:
    place = f'{creature.file}: foot."{name}"'
    label = skeleton.label(find_node(skeleton, name, place))
    if label not in morphology.foot_name:
        raise RigError(f"{place}: is no foot; feet are {choices(morphology.foot_name)}")
    return morphology.foot_name.index(label)


def override_limits(morphology: Morphology, skeleton: Skeleton, creature: Creature) -> Morphology:
    """Return the morphology with the joint limits that the creature file gives.

    Raises:
        RigError: it names no joint that turns, or gives a joint angles that are not its own.
    """
    if not creature.limit:
        return morphology
    legs, spine = morphology.legs, morphology.segments
    legs = legs._replace(bend_limit=legs.bend_limit.copy(), hip_limit=legs.hip_limit.copy())
    spine = spine._replace(limit=spine.limit.copy(), tail_limit=spine.tail_limit.copy())
    in_leg = {
        int(morphology.joint_node[legs.joint[k, m]]): (k, m)
        for k in range(len(legs.length))
        for m in range(int(legs.joint_count[k]))
    }
    in_spine = _rows_of_limits(morphology, spine)
    said: dict[int, str] = {}
    for name, limits in creature.limit.items():
        place = f'{creature.file}: limit."{name}"'
        node = find_node(skeleton, name, place)
        if node in said:
            raise RigError(f'{place}: is the joint of limit."{said[node]}" too; leave one out')
        said[node] = name
        if node in in_leg:
            first = in_leg[node][1] == 0
            what = "the first joint of a leg" if first else "this joint of a leg"
            _judge_keys(place, limits, what, HIP_KEYS if first else ("bend",))
            _limit_leg(legs, *in_leg[node], limits)
        elif node in in_spine:
            _judge_keys(place, limits, "a joint of spine or tail", SPINE_KEYS)
            row = in_spine[node]
            row[:] = [
                limits[key][0] if key in limits else row[i] for i, key in enumerate(SPINE_KEYS)
            ]
        else:
            joints = choices(skeleton.label(joint) for joint in (*in_leg, *in_spine))
            raise RigError(
                f"{place}: is no joint that turns in a leg, spine or tail; these are {joints}"
            )
    return replace(morphology, legs=legs, segments=spine)


def _rows_of_limits(morphology: Morphology, spine: SpineTable) -> dict[int, FloatArray]:
    """Return by its node where the limits [3] of each joint of spine and tail are.

    A joint at the very end turns against nothing and has none.
    """
    found = {}
    for joint, hinge in zip(spine.joint, spine.hinge, strict=True):
        if hinge > 0:
            found[int(morphology.joint_node[joint])] = spine.limit[hinge]
    for t, joint in enumerate(spine.tail_joint):
        found[int(morphology.joint_node[joint])] = spine.tail_limit[t]
    return found


def _judge_keys(
    place: str, limits: Mapping[str, tuple[float, ...]], what: str, valid: Sequence[str]
) -> None:
    wrong = sorted(set(limits) - set(valid))
    if wrong:
        raise RigError(f"{place}.{wrong[0]}: is not for {what}; valid is {choices(valid)}")


def _limit_leg(
    legs: LegTable, leg: int, joint: int, limits: Mapping[str, tuple[float, ...]]
) -> None:
    """Write what is said of a leg's joint."""
    if joint == 0:
        legs.hip_limit[leg] = [limits[key][0] if key in limits else np.nan for key in HIP_KEYS]
    elif "bend" in limits:
        legs.bend_limit[leg, joint] = limits["bend"]
