"""About what a foot rolls: the place that stays on the ground while its heel rises.

A foot of one piece rolls over the front of its sole; one with a joint for its toes rolls about that
joint while the toes stay flat. Either way the sole, the point that is planned and recorded, is put
where nothing moves while the foot rolls: no stance slips by it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from polypod.morphology.layout import Layout
from polypod.morphology.limb import Limb
from polypod.morphology.skeleton import Skeleton

FloatArray = NDArray[np.float64]

FLAT = 0  # it stands and swings as it is turned, and does not roll
TOE_FIRST = 1  # paws and hooves: toes first at touchdown
HEEL_FIRST = 2  # long soles with a heel behind the ankle: heel first

# A sole this long that reaches so far behind its ankle has a heel, leg lengths.
HEELED_LENGTH = 0.22
HEEL = 0.03
# The front of the sole is where a foot may roll by so much without its skin sinking deeper, rad and
# leg lengths.
STEEPEST_ROLL = math.radians(45.0)
SUNK = 0.004
# A joint for the toes is lower than this share of the ankle's height, and ahead of the sole's
# middle; its toes are part of what stands.
TOE_HEIGHT = 0.6


@dataclass(frozen=True)
class Roll:
    """How a foot rolls; places in the skeleton's frame, m."""

    kind: int  # FLAT, TOE_FIRST or HEEL_FIRST
    forward: float  # from the middle of the sole's shape to the sole itself
    toe_joint: int  # node whose toes stay flat, -1 where there is none


STIFF = Roll(FLAT, 0.0, -1)


def find_rolls(
    skeleton: Skeleton, limbs: list[Limb], upright: NDArray[np.bool_], layout: Layout
) -> list[Roll]:
    """Return how each foot rolls, partners alike whatever their skins' small differences."""
    rolls = [
        find_roll(skeleton, limb, bool(stands)) for limb, stands in zip(limbs, upright, strict=True)
    ]
    for k, other in enumerate(layout.partner):
        if other <= k or FLAT in (rolls[k].kind, rolls[other].kind):
            continue
        kind = max(rolls[k].kind, rolls[other].kind)
        forward = max(rolls[k].forward, rolls[other].forward)
        for leg in (k, int(other)):
            own = rolls[leg].forward if rolls[leg].toe_joint >= 0 else forward
            rolls[leg] = replace(rolls[leg], kind=kind, forward=own)
    return rolls


def find_roll(skeleton: Skeleton, limb: Limb, upright: bool) -> Roll:
    """Return how a leg's foot rolls; only feet under their hips that skin tells the sole of do."""
    sole = limb.sole
    if limb.foot_joint < 0 or not upright or sole.stretched or sole.source != "skin":
        return STIFF
    heel = float(limb.effector[2] - sole.place[2] + sole.half_size[1])
    heeled = 2.0 * float(sole.half_size[1]) >= HEELED_LENGTH * limb.length
    kind = HEEL_FIRST if heeled and heel >= HEEL * limb.length else TOE_FIRST
    toes = list(_toe_joints(skeleton, limb))
    if len(toes) == 1:
        return Roll(kind, float(skeleton.position[toes[0], 2] - sole.place[2]), toes[0])
    group = [node for top in (limb.foot_joint, *limb.rides) for node in skeleton.below(top)]
    skin = skeleton.vertex[skeleton.share(group) >= 0.5]
    ahead = skin[:, 2] - sole.place[2]
    above = skin[:, 1] - sole.place[1]
    room = above / math.tan(STEEPEST_ROLL) + SUNK * limb.length / math.sin(STEEPEST_ROLL)
    front = float(np.clip((ahead - room).max(), 0.0, sole.half_size[1]))
    return Roll(kind, front, -1)


def _toe_joints(skeleton: Skeleton, limb: Limb) -> Iterator[int]:
    """Yield the joints in a foot that carry skin of the sole ahead of its middle."""
    sole, ankle = limb.sole, limb.effector
    height = TOE_HEIGHT * float(ankle[1] - sole.place[1])
    for node in skeleton.children[limb.foot_joint]:
        place = skeleton.position[node] - sole.place
        if not skeleton.is_joint[node] or not 0.0 <= place[1] <= height:
            continue
        if 0.0 < place[2] < sole.half_size[1] and skeleton.weight[skeleton.below(node)].sum() > 0.0:
            yield node
