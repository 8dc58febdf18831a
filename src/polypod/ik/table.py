"""Builds what inverse kinematics needs of each leg from its points at rest and its stance."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from polypod.ik.hinges import Hinges, find_hinges, plan_direction
from polypod.ik.reach import reach_shift_within
from polypod.ik.solve import aimed_hip, fold_for_reach, folded_chord, plane_frame, plane_normal
from polypod.ik.types import IkTable
from polypod.math.quat import rotate
from polypod.math.vec3 import Vec3, length, load_vec3
from polypod.morphology.types import FloatArray, LegTable

__all__ = ["IkTable", "build_ik_table", "guesses"]

BEND_MOST = math.radians(165.0)
HIP_LIMIT_ERECT = np.radians([90.0, 45.0, 45.0])
HIP_LIMIT_SPRAWLING = np.radians([90.0, 60.0, 60.0])
# Of the longest that the hinges allow: turns between frames grow fast beyond.
LONGEST = 0.97
COMFORTABLE = 0.94
# A tenth of a leg's length may turn a joint 45 degrees at most: rad per leg length.
TURN_RATE_MOST = math.radians(450.0)
FOLD_SAMPLES = 2048
REACH_CELLS = 128
TRAVEL_STEP = 0.01
TRAVEL_DIRECTIONS = 12


def build_ik_table(legs: LegTable) -> IkTable:
    """Return the bones, hinges, limits, fold and reach of every leg.

    Overrides: `bend_limit` is a range about the rest bend, positive where the joint bends more;
    `hip_limit` the half ranges of flexion, sideways swing and twist about the stance. Angles in
    radians, lengths in metres, body frame.
    """
    ik = _empty_table(legs)
    for leg in range(len(legs.joint_count)):
        _fill_leg(ik, legs, leg)
        _fill_stance(ik, leg)
        _fill_travel(ik, leg)
    return ik


def guesses(ik: IkTable, foot_name: Sequence[str]) -> list[str]:
    """Return one sentence for each leg with a joint whose axis had to be guessed."""
    sentences = []
    for leg, name in enumerate(foot_name):
        joints = np.flatnonzero(ik.guessed[leg])
        if len(joints) == 0:
            continue
        kind = "an erect" if ik.upright[leg] else "a sprawling"
        which = " and ".join(str(j + 1) for j in joints)
        lean = ", ".join(_way(ik, leg, int(j)) for j in joints)
        sentences.append(
            f"The leg to {name} is straight at rest at joint {which} from the hip, "
            f"so as {kind} leg's the bend was guessed: {lean}."
        )
    return sentences


def _way(ik: IkTable, leg: int, joint: int) -> str:
    """Say where a joint's point goes when its hinge bends."""
    bone = ik.bone_rest[leg, joint]
    x, y, z = -np.cross(ik.axis[leg, joint], bone)
    size = np.abs([x, y, z])
    names = (("left", "right"), ("up", "down"), ("forward", "back"))
    pair = names[int(np.argmax(size))]
    return pair[0] if (x, y, z)[int(np.argmax(size))] > 0 else pair[1]


def _empty_table(legs: LegTable) -> IkTable:
    """Return a table of the right shapes with what needs no thought filled in."""
    leg_count, joint_most = legs.joint.shape
    per_leg = np.zeros(leg_count)
    per_joint = np.zeros((leg_count, joint_most))
    vectors = np.zeros((leg_count, joint_most, 3))
    effector_rest = legs.point_rest[np.arange(leg_count), legs.joint_count]
    return IkTable(
        joint_count=legs.joint_count.astype(np.int64),
        hip_rest=np.ascontiguousarray(legs.point_rest[:, 0], dtype=np.float64),
        bone_rest=vectors.copy(),
        axis=vectors.copy(),
        bend_rest=per_joint.copy(),
        bend_base=per_joint.copy(),
        bend_slope=per_joint.copy(),
        bend_low=per_joint.copy(),
        bend_high=per_joint.copy(),
        guessed=np.zeros((leg_count, joint_most), dtype=np.bool_),
        chain_length=per_leg.copy(),
        shortest=per_leg.copy(),
        longest=per_leg.copy(),
        comfortable=per_leg.copy(),
        fold_of_reach=np.zeros((leg_count, REACH_CELLS + 1)),
        turns_with_heading=~legs.upright.astype(np.bool_),
        normal_rest=np.zeros((leg_count, 3)),
        normal_stance=np.zeros((leg_count, 3)),
        plan_stance=np.zeros((leg_count, 2)),
        # The foot keeps its rest orientation in stance.
        effector_stance=legs.sole_stance - legs.sole_rest + effector_rest,
        fold_stance=per_leg.copy(),
        hip_stance=np.tile([0.0, 0.0, 0.0, 1.0], (leg_count, 1)),
        limb_axis=np.zeros((leg_count, 3)),
        flexion_axis=np.zeros((leg_count, 3)),
        hip_limit=np.zeros((leg_count, 3)),
        upright=legs.upright.astype(np.bool_),
        stance_travel=per_leg.copy(),
        stance_travel_least=per_leg.copy(),
    )


def _fill_leg(ik: IkTable, legs: LegTable, leg: int) -> None:
    """Fill in bones, hinges, limits, fold and reach of one leg, and its plane at rest."""
    count = int(legs.joint_count[leg])
    bones = np.diff(legs.point_rest[leg, : count + 1], axis=0)
    hinges = find_hinges(legs, leg)
    ik.bone_rest[leg, :count] = bones
    ik.axis[leg, :count] = hinges.axis
    ik.bend_rest[leg, :count] = hinges.bend_rest
    ik.bend_base[leg, :count] = hinges.base
    ik.bend_slope[leg, :count] = hinges.slope
    ik.guessed[leg, :count] = hinges.guessed
    low = np.minimum(0.0, hinges.bend_rest)
    high = np.maximum(BEND_MOST, hinges.bend_rest)
    asked = hinges.bend_rest[:, None] + np.sort(legs.bend_limit[leg, :count], axis=1)
    low = np.where(np.isnan(asked[:, 0]), low, asked[:, 0])
    high = np.where(np.isnan(asked[:, 1]), high, asked[:, 1])
    low[0] = high[0] = 0.0
    ik.bend_low[leg, :count] = low
    ik.bend_high[leg, :count] = high
    default = HIP_LIMIT_ERECT if legs.upright[leg] else HIP_LIMIT_SPRAWLING
    ik.hip_limit[leg] = np.where(np.isnan(legs.hip_limit[leg]), default, legs.hip_limit[leg])
    ik.chain_length[leg] = np.linalg.norm(bones, axis=1).sum()
    ik.normal_rest[leg] = hinges.normal
    _fill_reach(ik, leg, hinges)
    _fill_plane(ik, legs, leg)


def _fill_reach(ik: IkTable, leg: int, hinges: Hinges) -> None:
    """Sample the fold from its longest on, as long as folding shortens, and invert it."""
    count = int(ik.joint_count[leg])
    length_all = float(ik.chain_length[leg])
    low = ik.bend_low[leg, :count]
    high = ik.bend_high[leg, :count]
    folding = hinges.slope > 0.0
    if not folding.any():
        reach = float(np.linalg.norm(sampled_chords(ik, leg, np.zeros((1, count)))[0]))
        ik.shortest[leg] = ik.longest[leg] = ik.comfortable[leg] = reach
        return
    folds = np.linspace(
        float(((low - hinges.base)[folding] / hinges.slope[folding]).min()),
        float(((high - hinges.base)[folding] / hinges.slope[folding]).max()),
        FOLD_SAMPLES,
    )
    bends = np.clip(hinges.base + folds[:, None] * hinges.slope, low, high)
    chords = sampled_chords(ik, leg, bends)
    reach = np.linalg.norm(chords, axis=1)
    first = int(np.flatnonzero(reach >= reach.max() * (1.0 - 1e-12))[-1])
    drop = -np.diff(reach[first:]) / length_all
    turned = np.abs(np.diff(bends[first:], axis=0)).max(axis=1)
    direction = chords[first:] / reach[first:, None]
    swing = np.linalg.norm(np.diff(direction, axis=0), axis=1)
    swing = np.hypot(swing, drop * length_all / reach[first + 1 :])
    # Near full stretch turns are fast too, but there the longest reach is what bounds them.
    stretched = reach[first + 1 :] > 0.75 * reach[first]
    good = (drop > 0.0) & (stretched | (np.maximum(turned, swing) <= TURN_RATE_MOST * drop))
    last = first + (int(np.argmin(good)) if not good.all() else len(good))
    longest = LONGEST * reach[first]
    ik.longest[leg] = longest
    ik.comfortable[leg] = COMFORTABLE * reach[first]
    ik.shortest[leg] = min(float(reach[last]), 0.999 * longest)
    wanted = np.linspace(float(ik.shortest[leg]), longest, REACH_CELLS + 1)
    ik.fold_of_reach[leg] = np.interp(
        wanted, reach[first : last + 1][::-1], folds[first : last + 1][::-1]
    )


def sampled_chords(ik: IkTable, leg: int, bends: FloatArray) -> FloatArray:
    """Return the ways [S, 3] from hip to effector for bends [S, n], the hip not turned."""
    chord = np.tile(ik.bone_rest[leg, 0], (len(bends), 1))
    turned = np.tile(np.eye(3), (len(bends), 1, 1))
    for joint in range(1, bends.shape[1]):
        x, y, z = ik.axis[leg, joint]
        spin = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        angle = (bends[:, joint] - ik.bend_rest[leg, joint])[:, None, None]
        turned = turned @ (np.eye(3) + np.sin(angle) * spin + (1.0 - np.cos(angle)) * (spin @ spin))
        chord = chord + turned @ ik.bone_rest[leg, joint]
    return chord


def _fill_plane(ik: IkTable, legs: LegTable, leg: int) -> None:
    """Fill in the stance's direction in plan and the leg plane's normal carried there."""
    offset = ik.effector_stance[leg] - ik.hip_rest[leg]
    rest = plan_direction(legs, leg)
    plan = np.array([offset[0], 0.0, offset[2]])
    size = float(np.linalg.norm(plan))
    # A stance straight under the hip has no direction in plan: the rest's is taken.
    plan = plan / size if size > 0.1 * ik.chain_length[leg] else rest
    ik.plan_stance[leg] = plan[[0, 2]]
    normal = ik.normal_rest[leg]
    if ik.turns_with_heading[leg]:
        cosine = float(rest @ plan)
        sine = float(plan[0] * rest[2] - plan[2] * rest[0])
        normal = np.array(
            [
                normal[0] * cosine + normal[2] * sine,
                normal[1],
                normal[2] * cosine - normal[0] * sine,
            ]
        )
    ik.normal_stance[leg] = normal


def _fill_stance(ik: IkTable, leg: int) -> None:
    """Fill in the stance's pose, about which the hip's limits are centred."""
    offset = ik.effector_stance[leg] - ik.hip_rest[leg]
    size = float(np.linalg.norm(offset))
    if size < 1e-9 * ik.chain_length[leg]:
        offset, size = np.array([0.0, -1.0, 0.0]), 1.0
    direction = Vec3(*(offset / size))
    reach = min(max(size, float(ik.shortest[leg])), float(ik.longest[leg]))
    fold = fold_for_reach(ik, leg, reach)
    frame = plane_frame(direction, plane_normal(ik, leg, direction))
    ik.fold_stance[leg] = fold
    ik.hip_stance[leg] = aimed_hip(ik, leg, folded_chord(ik, leg, fold), direction)
    ik.limb_axis[leg] = direction
    ik.flexion_axis[leg] = rotate(frame, Vec3(0.0, 1.0, 0.0))


def _fill_travel(ik: IkTable, leg: int) -> None:
    """Fill in how far the effector may travel straight at the stance's height."""
    stance = load_vec3(ik.effector_stance[leg])
    comfortable = float(ik.comfortable[leg])
    centre = stance + reach_shift_within(ik, leg, stance, comfortable)
    step = TRAVEL_STEP * float(ik.chain_length[leg])
    travel = []
    for i in range(TRAVEL_DIRECTIONS):
        angle = math.pi * i / TRAVEL_DIRECTIONS
        along = Vec3(math.sin(angle), 0.0, math.cos(angle))
        half = 0.0
        while _reaches(ik, leg, centre, along, half + step, comfortable):
            half += step
        travel.append(2.0 * half)
    ik.stance_travel[leg] = travel[0]
    ik.stance_travel_least[leg] = min(travel)


def _reaches(
    ik: IkTable, leg: int, centre: Vec3, along: Vec3, half: float, comfortable: float
) -> bool:
    """Say whether both ends of a straight travel about a place are within reach and limits."""
    slack = 1e-6 * float(ik.chain_length[leg])
    for sign in (half, -half):
        shift = reach_shift_within(ik, leg, centre + along * sign, comfortable)
        if length(shift) > slack:
            return False
    return True
