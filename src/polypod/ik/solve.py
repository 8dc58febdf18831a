"""Joint rotations that bring a leg's effector to a target: fold, aim, then CCD as polish.

P1 section 3 and P2 section 3 solve a leg by Cyclic Coordinate Descent inside joint limits. Alone it
leaves a tenth to half of the targets unmet and its pose depends on history, so here it only
finishes a pose that is a pure function of the target: *fold* the leg by one number until it is as
long as the target is far, *aim* it there in a stated plane, and let CCD work where the hip's limits
forbid that pose.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.ik.aim import hip_for
from polypod.ik.fold import fold_for_reach, hinge_turn
from polypod.ik.hip import hip_strain, limited_hip
from polypod.ik.types import IkTable
from polypod.math.quat import (
    Quat,
    between,
    conjugate,
    from_axis_angle,
    load_quat,
    rotate,
    store_quat,
    unit,
)
from polypod.math.vec3 import Vec3, cross, dot, length, load_vec3, normalized, store_vec3

# Few rounds of small turns: enough near the limits, and no step so large that poses jump.
POLISH_STEPS = 4
POLISH_TURN = 0.1  # rad


@kernel
def pose_leg(
    ik: IkTable, leg: int, hip: Quat, fold: float, rotation_out: Any, point_out: Any
) -> None:
    """Write the pose of a leg from its hip's rotation and its fold: forward kinematics."""
    rotation = hip
    point = load_vec3(ik.hip_rest[leg])
    for joint in range(ik.joint_count[leg]):
        if joint > 0:
            turn = hinge_turn(
                ik.turn_base[leg, joint],
                ik.turn_slope[leg, joint],
                fold,
                ik.turn_low[leg, joint],
                ik.turn_high[leg, joint],
            )
            rotation = rotation * from_axis_angle(load_vec3(ik.axis[leg, joint]), turn)
        store_quat(rotation_out[joint], rotation)
        store_vec3(point_out[joint], point)
        point = point + rotate(rotation, load_vec3(ik.bone_rest[leg, joint]))
    store_vec3(point_out[ik.joint_count[leg]], point)


@kernel
def turn_from(
    ik: IkTable, leg: int, first: int, turn: Quat, rotation_out: Any, point_out: Any
) -> None:
    """Turn a posed leg from joint `first` outward about that joint's pivot."""
    count = ik.joint_count[leg]
    point = load_vec3(point_out[first])
    for joint in range(first, count):
        rotation = unit(turn * load_quat(rotation_out[joint]))
        store_quat(rotation_out[joint], rotation)
        point = point + rotate(rotation, load_vec3(ik.bone_rest[leg, joint]))
        store_vec3(point_out[joint + 1], point)


@kernel
def polish(ik: IkTable, leg: int, target: Vec3, rotation_out: Any, point_out: Any) -> None:
    """Bring the effector nearer to `target` by Cyclic Coordinate Descent inside the limits.

    P2 section 3: joints in turn, from the effector's end; each turns as far as helps and its range
    allows, so no step takes the effector farther away.
    """
    count = ik.joint_count[leg]
    for _ in range(POLISH_STEPS):
        for joint in range(count - 1, 0, -1):
            before = load_quat(rotation_out[joint - 1])
            own = conjugate(before) * load_quat(rotation_out[joint])
            axis = load_vec3(ik.axis[leg, joint])
            sine = own.x * axis.x + own.y * axis.y + own.z * axis.z
            turn = 2.0 * math.atan2(sine, own.w)
            axis = rotate(before, axis)
            pivot = load_vec3(point_out[joint])
            reached = load_vec3(point_out[count]) - pivot
            wanted = target - pivot
            reached = reached - axis * dot(reached, axis)
            wanted = wanted - axis * dot(wanted, axis)
            more = math.atan2(dot(cross(reached, wanted), axis), dot(reached, wanted))
            more = min(max(more, -POLISH_TURN), POLISH_TURN)
            best = min(max(turn + more, ik.turn_low[leg, joint]), ik.turn_high[leg, joint])
            turn_from(ik, leg, joint, from_axis_angle(axis, best - turn), rotation_out, point_out)
        pivot = load_vec3(point_out[0])
        reached = load_vec3(point_out[count])
        hip = load_quat(rotation_out[0])
        turned = limited_hip(ik, leg, between(reached - pivot, target - pivot) * hip)
        swung = pivot + rotate(turned * conjugate(hip), reached - pivot)
        if length(swung - target) <= length(reached - target):
            turn_from(ik, leg, 0, turned * conjugate(hip), rotation_out, point_out)


@kernel
def offset_from_hip(effector_body: Vec3, hip_body: Vec3, chain_length: float) -> Vec3:
    """Return the way from the hip to a target, a far one drawn in so that no square overflows."""
    far = 1e9 * chain_length
    return Vec3(
        min(max(effector_body.x - hip_body.x, -far), far),
        min(max(effector_body.y - hip_body.y, -far), far),
        min(max(effector_body.z - hip_body.z, -far), far),
    )


@kernel
def solve_leg(
    ik: IkTable, leg: int, effector_body: Vec3, rotation_out: Any, point_out: Any
) -> float:
    """Pose a leg so that its effector is at a target, or as near as limits allow.

    A pure function of the target: it knows no history. Targets beyond the leg's shortest and
    longest reach are drawn in. No limit of a joint is ever exceeded.

    Args:
        ik: the legs.
        leg: row of the leg.
        effector_body: the target, body frame, m.
        rotation_out: [M, 4] written: each joint's rotation relative to the rest, body frame.
        point_out: [M + 1, 3] written: the pivots and, at joint_count, the effector reached.

    Returns:
        The distance from the effector to the target, m.
    """
    hip = load_vec3(ik.hip_rest[leg])
    offset = offset_from_hip(effector_body, hip, ik.chain_length[leg])
    direction = normalized(offset, load_vec3(ik.limb_axis[leg]))
    reach = min(max(length(offset), ik.shortest[leg]), ik.longest[leg])
    fold, chord = fold_for_reach(ik, leg, reach)
    aimed = hip_for(ik, leg, chord, direction)
    if hip_strain(ik, leg, aimed) <= 1.0:
        pose_leg(ik, leg, aimed, fold, rotation_out, point_out)
    else:
        pose_leg(ik, leg, limited_hip(ik, leg, aimed), fold, rotation_out, point_out)
        polish(ik, leg, hip + direction * reach, rotation_out, point_out)
    return length(load_vec3(point_out[ik.joint_count[leg]]) - effector_body)
