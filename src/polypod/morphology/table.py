"""The tables that kernels read, from legs found in a skeleton."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from polypod.morphology.girth import section_radii
from polypod.morphology.layout import Layout
from polypod.morphology.limb import Limb
from polypod.morphology.roll import Roll
from polypod.morphology.skeleton import Skeleton
from polypod.morphology.types import LegTable

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# An upright leg's sole is this much nearer to its hip in plan than below it.
UPRIGHT = 0.6


def joint_rows(skeleton: Skeleton, limbs: list[Limb]) -> tuple[list[int], IntArray]:
    """Return the nodes of the joint table, parents first, and each row's parent row (-1: body).

    A joint rides on its nearest ancestor in the table; what a leg says rides on its foot, does.
    """
    wanted = {int(node) for node in np.flatnonzero(skeleton.is_joint)}
    rides: dict[int, int] = {}
    for limb in limbs:
        wanted.update(limb.joints, [limb.foot, limb.sole_node])
        wanted.update(skeleton.path(limb.joints[0], limb.foot))
        rides.update(limb.rides)
    carrier: dict[int, int] = {}
    for node in wanted:
        carrier[node] = rides.get(
            node, next((above for above in skeleton.above(node) if above in wanted), -1)
        )
    rows: list[int] = []
    row_of: dict[int, int] = {-1: -1}
    for node in sorted(wanted):
        branch = [node]
        while branch[-1] not in row_of:
            branch.append(carrier[branch[-1]])
        for other in reversed(branch[:-1]):
            row_of[other] = len(rows)
            rows.append(other)
    return rows, np.array([row_of[carrier[node]] for node in rows], np.int64)


def stand_upright(
    skeleton: Skeleton, limbs: list[Limb], middle_stance: FloatArray
) -> NDArray[np.bool_]:
    """Return which legs [K] stand with the middle of their foot below their hip."""
    away = middle_stance - skeleton.position[[limb.joints[0] for limb in limbs]]
    return np.asarray(np.hypot(away[:, 0], away[:, 2]) < -UPRIGHT * away[:, 1])


def leg_table(
    skeleton: Skeleton,
    limbs: list[Limb],
    rolls: list[Roll],
    layout: Layout,
    middle_stance: FloatArray,
    rows: list[int],
    centre: FloatArray,
) -> LegTable:
    """Return the legs in the body frame; limits are NaN, for the default.

    Args:
        skeleton: metres, facing +Z.
        limbs: K legs.
        rolls: how their feet roll.
        layout: their sides and rows.
        middle_stance: [K, 3] the middles of the feet's shapes, in the skeleton's frame.
        rows: nodes of the joint table.
        centre: [3] the body centre in the skeleton's frame.
    """
    row_of = {node: row for row, node in enumerate(rows)}
    count, most = len(limbs), max(len(limb.joints) for limb in limbs)
    joint = np.full((count, most), -1, np.int64)
    point = np.zeros((count, most + 1, 3))
    for k, limb in enumerate(limbs):
        turned = len(limb.joints)
        joint[k, :turned] = [row_of[node] for node in limb.joints]
        point[k, :turned] = skeleton.position[list(limb.joints)] - centre
        # Unused places repeat the effector, so that they are finite and far from nothing.
        point[k, turned:] = limb.effector - centre
    forward = np.array([[0.0, 0.0, roll.forward] for roll in rolls])
    sole_rest = np.array([limb.sole.place for limb in limbs]) + forward - centre
    pivot = sole_rest.copy()
    for k, roll in enumerate(rolls):
        if roll.toe_joint >= 0:
            pivot[k] = skeleton.position[roll.toe_joint] - centre
    radius = np.zeros((count, most + 1))
    for k, of_sections in enumerate(section_radii(skeleton, limbs)):
        radius[k, : len(of_sections)] = of_sections
    return LegTable(
        joint_count=np.array([len(limb.joints) for limb in limbs], np.int64),
        joint=joint,
        foot_joint=np.array([row_of.get(limb.foot_joint, -1) for limb in limbs], np.int64),
        point_rest=point,
        sole_rest=sole_rest,
        sole_stance=middle_stance + forward - centre,
        length=np.array([limb.length for limb in limbs]),
        foot_half_size=np.array([limb.sole.half_size for limb in limbs]),
        foot_behind=forward[:, 2].copy(),
        roll_kind=np.array([roll.kind for roll in rolls], np.int64),
        roll_pivot=pivot,
        toe_joint=np.array([row_of.get(roll.toe_joint, -1) for roll in rolls], np.int64),
        section_radius=radius,
        weight=np.full(count, 1.0 / count),
        side=layout.side,
        row=layout.row,
        upright=stand_upright(skeleton, limbs, middle_stance),
        bend_limit=np.full((count, most, 2), np.nan),
        hip_limit=np.full((count, 3), np.nan),
    )
