"""What a creature file says over what was derived: limits, foot shapes and weights."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from polypod.errors import RigError, choices
from polypod.morphology.creature import Creature
from polypod.morphology.names import find_node
from polypod.morphology.skeleton import Skeleton
from polypod.morphology.types import Morphology

HIP_KEYS = ("flexion", "sideways", "twist")


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
        RigError: it names no joint of a leg, or gives a hip's angles to another joint.
    """
    if not creature.limit:
        return morphology
    legs = morphology.legs
    bend, hip = legs.bend_limit.copy(), legs.hip_limit.copy()
    place_of = {
        int(morphology.joint_node[legs.joint[k, m]]): (k, m)
        for k in range(len(legs.length))
        for m in range(int(legs.joint_count[k]))
    }
    for name, limits in creature.limit.items():
        node = find_node(skeleton, name, f'{creature.file}: limit."{name}"')
        if node not in place_of:
            joints = choices(skeleton.label(joint) for joint in place_of)
            raise RigError(
                f'{creature.file}: limit."{name}": is no joint that turns in a leg; '
                f"these are {joints}"
            )
        k, m = place_of[node]
        wrong = set(limits) & ({"bend"} if m == 0 else set(HIP_KEYS))
        if wrong:
            valid = HIP_KEYS if m == 0 else ("bend",)
            raise RigError(
                f'{creature.file}: limit."{name}".{sorted(wrong)[0]}: is not for '
                f"{'the first joint' if m == 0 else 'this joint'} of a leg; "
                f"valid is {choices(valid)}"
            )
        if m == 0:
            hip[k] = [limits[key][0] if key in limits else np.nan for key in HIP_KEYS]
        else:
            bend[k, m] = limits["bend"]
    return replace(morphology, legs=legs._replace(bend_limit=bend, hip_limit=hip))
