"""Builds what inverse kinematics needs of each leg from its points at rest and its stance."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from polypod.ik.aim import hip_for, plane_frame, plane_normal
from polypod.ik.fold import fold_for_reach
from polypod.ik.hinges import Hinges, find_hinges, plan_direction
from polypod.ik.reach import direction_strain, reach_shift
from polypod.ik.solve import pose_leg
from polypod.ik.types import IkTable
from polypod.math.quat import load_quat, rotate
from polypod.math.vec3 import Vec3, load_vec3
from polypod.morphology.types import FloatArray, LegTable
from polypod.reference import by_reference

__all__ = ["IkTable", "build_ik_table", "guesses"]

BEND_MOST = math.radians(165.0)
HIP_LIMIT_ERECT = np.radians([90.0, 45.0, 45.0])
HIP_LIMIT_SPRAWLING = np.radians([90.0, 60.0, 60.0])
# Of the longest that the hinges allow: turns between frames grow fast beyond.
LONGEST = 0.97
COMFORTABLE = 0.94
# A target moved by a tenth of the leg's length may turn no joint more than 45 degrees: rad per leg
# length. The hip also turns with the target's heading and has less to spare.
HINGE_RATE_MOST = math.radians(450.0)
HIP_RATE_MOST = math.radians(250.0)
LEAN_MOST = 0.4
FOLD_SAMPLES = 2048
BISECTIONS = 44
REACH_CELLS = 128
TRAVEL_STEP = 0.01
TRAVEL_DIRECTIONS = 12


# At the ends of a stance a leg may be stretched to this share of its longest reach.
STANCE_END = 0.99


def build_ik_table(legs: LegTable, like: tuple[LegTable, IkTable] | None = None) -> IkTable:
    """Return the bones, hinges, limits, fold and reach of every leg.

    `like`: the same legs with other limits, and their table; those whose limits are the same are
    taken from there, which saves the most of the time.

    Overrides: `bend_limit` is a range about the rest bend, positive where the joint turns more;
    `hip_limit` the half ranges of flexion, sideways swing and twist about the stance. Angles in
    radians, lengths in metres, body frame.
    """
    ik = _empty_table(legs)
    # The same arrays, as the simulation's kernels take them: compiled once for both.
    kernel_ik = by_reference(ik)
    for leg in range(len(legs.joint_count)):
        if like is not None and _limited_alike(legs, like[0], leg):
            for mine, theirs in zip(ik, like[1], strict=True):
                mine[leg] = theirs[leg]
            continue
        _fill_leg(ik, legs, leg)
        _fill_stance(ik, kernel_ik, leg)
        _fill_travel(ik, kernel_ik, leg)
    return ik


def _limited_alike(legs: LegTable, others: LegTable, leg: int) -> bool:
    return all(
        np.array_equal(mine[leg], theirs[leg], equal_nan=True)
        for mine, theirs in (
            (legs.bend_limit, others.bend_limit), (legs.hip_limit, others.hip_limit)
        )
    )  # fmt: skip


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
    """Say where a joint's point goes when its hinge turns."""
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
        turn_base=per_joint.copy(),
        turn_slope=per_joint.copy(),
        turn_low=per_joint.copy(),
        turn_high=per_joint.copy(),
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
        shank_stance=np.tile([0.0, 0.0, 0.0, 1.0], (leg_count, 1)),
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
    ik.turn_base[leg, :count] = hinges.base - hinges.bend_rest
    ik.turn_slope[leg, :count] = hinges.slope
    ik.guessed[leg, :count] = hinges.guessed
    asked = np.sort(legs.bend_limit[leg, :count], axis=1)
    low = np.where(np.isnan(asked[:, 0]), np.minimum(-hinges.bend_rest, 0.0), asked[:, 0])
    high = np.where(
        np.isnan(asked[:, 1]), np.maximum(BEND_MOST - hinges.bend_rest, 0.0), asked[:, 1]
    )
    ik.turn_low[leg, 1:count] = low[1:]
    ik.turn_high[leg, 1:count] = high[1:]
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
    base = ik.turn_base[leg, :count]
    low = ik.turn_low[leg, :count]
    high = ik.turn_high[leg, :count]
    folding = hinges.slope > 0.0
    if not folding.any():
        unfolded = np.clip(base, low, high)
        reach = float(np.linalg.norm(sampled_chords(ik, leg, unfolded[None])[0]))
        ik.shortest[leg] = ik.longest[leg] = ik.comfortable[leg] = reach
        return
    folds = np.linspace(
        float(((low - base)[folding] / hinges.slope[folding]).min()),
        float(((high - base)[folding] / hinges.slope[folding]).max()),
        FOLD_SAMPLES,
    )
    turns = np.clip(base + folds[:, None] * hinges.slope, low, high)
    chords = sampled_chords(ik, leg, turns)
    reach = np.linalg.norm(chords, axis=1)
    first = int(np.flatnonzero(reach >= reach.max() * (1.0 - 1e-12))[-1])
    drop = -np.diff(reach[first:]) / length_all
    turned = np.abs(np.diff(turns[first:], axis=0)).max(axis=1)
    direction = chords[first:] / reach[first:, None]
    swing = np.linalg.norm(np.diff(direction, axis=0), axis=1)
    swing = np.hypot(swing, drop * length_all / reach[first + 1 :])
    # An effector far out of the leg's plane would spin the plane about the way to it.
    aslant = np.abs(direction[1:] @ hinges.normal) > LEAN_MOST
    # Near full stretch turns are fast too, but there the longest reach is what bounds them.
    stretched = reach[first + 1 :] > 0.75 * reach[first]
    slow = (turned <= HINGE_RATE_MOST * drop) & (swing <= HIP_RATE_MOST * drop) & ~aslant
    good = (drop > 0.0) & (stretched | slow)
    last = first + (int(np.argmin(good)) if not good.all() else len(good))
    longest = LONGEST * reach[first]
    ik.longest[leg] = longest
    ik.comfortable[leg] = COMFORTABLE * reach[first]
    ik.shortest[leg] = min(float(reach[last]), 0.999 * longest)
    wanted = np.linspace(float(ik.shortest[leg]), longest, REACH_CELLS + 1)
    place = np.searchsorted(-reach[first : last + 1], -wanted)
    long_end = folds[first + np.maximum(place - 1, 0)]
    short_end = folds[first + np.minimum(place, last - first)]
    for _ in range(BISECTIONS):
        middle = 0.5 * (long_end + short_end)
        turns = np.clip(base + middle[:, None] * hinges.slope, low, high)
        too_long = np.linalg.norm(sampled_chords(ik, leg, turns), axis=1) > wanted
        long_end = np.where(too_long, middle, long_end)
        short_end = np.where(too_long, short_end, middle)
    ik.fold_of_reach[leg] = 0.5 * (long_end + short_end)


def sampled_chords(ik: IkTable, leg: int, turns: FloatArray) -> FloatArray:
    """Return the ways [S, 3] from hip to effector for hinge turns [S, n], the hip not turned."""
    chord = np.tile(ik.bone_rest[leg, 0], (len(turns), 1))
    turned = np.tile(np.eye(3), (len(turns), 1, 1))
    for joint in range(1, turns.shape[1]):
        x, y, z = ik.axis[leg, joint]
        spin = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        angle = turns[:, joint, None, None]
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


def _fill_stance(ik: IkTable, kernel_ik: IkTable, leg: int) -> None:
    """Fill in the stance's pose, about which the hip's limits are centred."""
    offset = ik.effector_stance[leg] - ik.hip_rest[leg]
    size = float(np.linalg.norm(offset))
    if size < 1e-9 * ik.chain_length[leg]:
        offset, size = np.array([0.0, -1.0, 0.0]), 1.0
    direction = Vec3(*(offset / size))
    reach = min(max(size, float(ik.shortest[leg])), float(ik.longest[leg]))
    fold, chord = fold_for_reach(kernel_ik, leg, reach)
    frame = plane_frame(direction, plane_normal(kernel_ik, leg, direction * reach))
    ik.fold_stance[leg] = fold
    ik.hip_stance[leg] = hip_for(kernel_ik, leg, chord, direction)
    most = ik.bone_rest.shape[1]
    rotation = np.zeros((most, 4))
    hip = load_quat(ik.hip_stance[leg])
    pose_leg(kernel_ik, leg, hip, fold, rotation, np.zeros((most + 1, 3)))
    ik.shank_stance[leg] = rotation[ik.joint_count[leg] - 1]
    ik.limb_axis[leg] = direction
    ik.flexion_axis[leg] = rotate(frame, Vec3(0.0, 1.0, 0.0))


def _fill_travel(ik: IkTable, kernel_ik: IkTable, leg: int) -> None:
    """Fill in how far the effector may travel straight at the stance's height."""
    stance = load_vec3(ik.effector_stance[leg])
    centre = stance + reach_shift(kernel_ik, leg, stance)
    comfortable = float(ik.comfortable[leg])
    offset = np.subtract(centre, ik.hip_rest[leg])
    offset *= min(1.0, comfortable / max(float(np.linalg.norm(offset)), 1e-300))
    step = TRAVEL_STEP * float(ik.chain_length[leg])
    travel = []
    for i in range(TRAVEL_DIRECTIONS):
        angle = math.pi * i / TRAVEL_DIRECTIONS
        along = np.array([math.sin(angle), 0.0, math.cos(angle)])
        half = 0.0
        while _both_ends_reach(ik, kernel_ik, leg, offset, along * (half + step)):
            half += step
        travel.append(2.0 * half)
    ik.stance_travel[leg] = travel[0]
    ik.stance_travel_least[leg] = min(travel)


def _both_ends_reach(
    ik: IkTable, kernel_ik: IkTable, leg: int, centre: FloatArray, half: FloatArray
) -> bool:
    """Say whether both ends of a straight travel about an offset from the hip are within reach."""
    for offset in (centre + half, centre - half):
        size = float(np.linalg.norm(offset))
        if not ik.shortest[leg] <= size <= STANCE_END * ik.longest[leg]:
            return False
        if direction_strain(kernel_ik, leg, Vec3(*offset.tolist())) > 1.0:
            return False
    return True
