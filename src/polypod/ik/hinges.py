"""About which axis each joint of a leg bends: read from the rest pose, guessed where straight.

Below 7 degrees the bend at rest is a modeller's noise. Guesses: erect legs bend about the
left-right axis, knees forward, the elbows of fore legs back, further joints in turn the other way;
sprawling legs bend with the knee up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from polypod.morphology.types import BoolArray, FloatArray, LegTable

NOISE = math.radians(7.0)
# A sprawling leg stretched out at rest shows no fold: any one joint's bend is noise up to more than
# that. An erect leg is always near to straight, and a small bend still tells wrist from elbow.
STRETCHED = 0.98
NOISE_STRETCHED = math.radians(20.0)
# An erect leg's small bend in the frontal plane is a splayed stance, not the knee's hinge.
SPLAY = math.radians(25.0)
# A straight joint's share of the fold: of its bent neighbours' mean, or all alike where none is.
SHARE = 0.35
SHARE_ALONE = math.radians(30.0)
# A hinge whose axis leans this far out of the leg's plane does not fold the leg.
LEAST_AGREEMENT = 0.5
# A fore leg's only hinge below this share of the hip's height is a wrist, which bends as a knee.
WRIST_HEIGHT = 0.42
UP = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True)
class Hinges:
    """The hinges of one leg with n joints; row 0 is the hip and stays zero.

    Attributes:
        axis: [n, 3] unit.
        bend_rest: [n] rad about the axis.
        base: [n] rad, bend at fold 0 before clipping.
        slope: [n] rad per unit of fold.
        guessed: [n].
        normal: [3] unit, of the leg's plane.
    """

    axis: FloatArray
    bend_rest: FloatArray
    base: FloatArray
    slope: FloatArray
    guessed: BoolArray
    normal: FloatArray


def unit(vector: FloatArray, fallback: FloatArray) -> FloatArray:
    """Return the vector's direction, or `fallback` where it has none."""
    size = float(np.linalg.norm(vector))
    return vector / size if size > 1e-12 else fallback


def plan_direction(legs: LegTable, leg: int) -> FloatArray:
    """Return the horizontal unit direction [3] in which a leg leads away from its hip.

    From the rest where that leads sideways, else from the stance, else from the side.
    """
    count = int(legs.joint_count[leg])
    hip = legs.point_rest[leg, 0]
    length = float(legs.length[leg])
    hip_plan = np.array([hip[0], 0.0, hip[2]])
    for end in (legs.point_rest[leg, count], legs.sole_rest[leg], legs.sole_stance[leg]):
        plan = np.array([end[0] - hip[0], 0.0, end[2] - hip[2]])
        if np.linalg.norm(plan) > 0.2 * length:
            return plan / float(np.linalg.norm(plan))
    if legs.side[leg] != 0:
        return np.array([float(legs.side[leg]), 0.0, 0.0])
    return unit(hip_plan, np.array([0.0, 0.0, 1.0]))


def bone_directions(bones: FloatArray) -> FloatArray:
    """Return the bones' unit directions [n, 3]; a bone without length takes its neighbour's."""
    sizes = np.linalg.norm(bones, axis=1)
    known = np.flatnonzero(sizes > 1e-6 * sizes.sum())
    directions = np.empty_like(bones)
    for i in range(len(bones)):
        nearest = known[np.argmin(np.abs(known - i))]
        directions[i] = bones[nearest] / sizes[nearest]
    return directions


def guessed_axis(legs: LegTable, leg: int, joint: int) -> FloatArray:
    """Return the axis [3] guessed for a hinge of a leg that is straight throughout.

    A turn about it by the right hand bends the joint.
    """
    if not legs.upright[leg]:
        return np.cross(UP, plan_direction(legs, leg))
    forward = 1.0 if joint % 2 == 1 else -1.0
    if legs.row[leg] == legs.row.max() and legs.row[leg] > 0:
        hip = legs.point_rest[leg, 0, 1]
        ground = legs.sole_rest[leg, 1]
        height = (legs.point_rest[leg, joint, 1] - ground) / max(hip - ground, 1e-12)
        alone = legs.joint_count[leg] == 2
        if not (alone and height < WRIST_HEIGHT):
            forward = -forward
    return np.array([forward, 0.0, 0.0])


def is_splay(legs: LegTable, leg: int, axis: FloatArray, bend: float) -> bool:
    """Say whether a bend at rest is how an erect leg is spread, not how its joint bends."""
    return bool(legs.upright[leg]) and bend < SPLAY and abs(axis[0]) < LEAST_AGREEMENT


def find_hinges(legs: LegTable, leg: int) -> Hinges:
    """Return the hinges of one leg."""
    count = int(legs.joint_count[leg])
    bones = np.diff(legs.point_rest[leg, : count + 1], axis=0)
    sizes = np.linalg.norm(bones, axis=1)
    directions = bone_directions(bones)
    axis = np.zeros((count, 3))
    bend = np.zeros(count)
    weight = np.zeros(count)
    reach = float(np.linalg.norm(bones.sum(axis=0)))
    stretched = not legs.upright[leg] and reach >= STRETCHED * float(sizes.sum())
    noise = NOISE_STRETCHED if stretched else NOISE
    for j in range(1, count):
        across = np.cross(directions[j - 1], directions[j])
        bend[j] = math.atan2(
            float(np.linalg.norm(across)), float(directions[j - 1] @ directions[j])
        )
        axis[j] = unit(across, axis[j])
        if bend[j] >= noise and not is_splay(legs, leg, axis[j], bend[j]):
            weight[j] = math.sin(bend[j]) * min(sizes[j - 1], sizes[j])
    real = weight > 0.0
    normal = _mean_normal(axis, weight) if real.any() else guessed_axis(legs, leg, 1)
    held = real & (np.abs(axis @ normal) < LEAST_AGREEMENT)
    slope = np.where(real & ~held, bend, 0.0)
    guessed = np.zeros(count, dtype=np.bool_)
    bent = real & ~held
    for j in range(1, count):
        if real[j] or min(sizes[j - 1], sizes[j]) <= 1e-6 * sizes.sum():
            continue
        guessed[j] = True
        axis[j] = _straight_axis(legs, leg, j, axis, bent, directions)
        slope[j] = SHARE * float(bend[bent].mean()) if bent.any() else SHARE_ALONE
        along = float(axis[j] @ np.cross(directions[j - 1], directions[j]))
        bend[j] = math.atan2(along, float(directions[j - 1] @ directions[j]))
    # Where anything is bent, fold 1 is the rest pose itself; an all but straight leg starts at 0.
    base = bend - slope if real.any() else np.zeros(count)
    return Hinges(axis, bend, base, slope, guessed, unit(normal, np.array([1.0, 0.0, 0.0])))


def _mean_normal(axis: FloatArray, weight: FloatArray) -> FloatArray:
    """Return the normal of the plane in which a leg is bent, signed as its strongest hinge."""
    strongest = axis[int(np.argmax(weight))]
    agreement = axis @ strongest
    signs = np.where(np.abs(agreement) >= LEAST_AGREEMENT, np.sign(agreement), 0.0)
    return unit((axis * (signs * weight)[:, None]).sum(axis=0), strongest)


def _straight_axis(
    legs: LegTable,
    leg: int,
    joint: int,
    axis: FloatArray,
    bent: BoolArray,
    directions: FloatArray,
) -> FloatArray:
    """Return the axis [3] of a straight hinge: from its nearest bent neighbour, or guessed."""
    neighbours = np.flatnonzero(bent)
    if len(neighbours) > 0:
        nearest = int(neighbours[np.argmin(np.abs(neighbours - joint))])
        sign = -1.0 if legs.upright[leg] and (joint - nearest) % 2 == 1 else 1.0
        wanted = sign * axis[nearest]
    else:
        wanted = guessed_axis(legs, leg, joint)
    along = unit(directions[joint - 1] + directions[joint], directions[joint])
    return unit(wanted - along * float(wanted @ along), wanted)
