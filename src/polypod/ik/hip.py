"""The hip's limits: a swing-twist cone, centred on the stance."""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.ik.types import IkTable
from polypod.math.quat import Quat, conjugate, from_axis_angle, load_quat
from polypod.math.vec3 import Vec3, cross, dot, length, load_vec3, normalized


@kernel
def hip_angles(ik: IkTable, leg: int, hip: Quat) -> Vec3:
    """Return flexion, sideways swing and twist of the hip away from the stance, radians.

    Swing is a rotation vector at right angles to the limb (flexion about the leg plane's normal),
    twist the turn about the limb that comes before it.
    """
    turned = hip * conjugate(load_quat(ik.hip_stance[leg]))
    if turned.w < 0.0:
        turned = Quat(-turned.x, -turned.y, -turned.z, -turned.w)
    limb = load_vec3(ik.limb_axis[leg])
    flexion = load_vec3(ik.flexion_axis[leg])
    along = turned.x * limb.x + turned.y * limb.y + turned.z * limb.z
    size = math.sqrt(along * along + turned.w * turned.w)
    twist = Quat(0.0, 0.0, 0.0, 1.0)
    if size > 1e-9:
        twist = Quat(
            limb.x * along / size, limb.y * along / size, limb.z * along / size, turned.w / size
        )
    swing = turned * conjugate(twist)
    vector = Vec3(swing.x, swing.y, swing.z)
    sine = length(vector)
    scale = 2.0
    if sine > 1e-9:
        scale = 2.0 * math.atan2(sine, swing.w) / sine
    return Vec3(
        scale * dot(vector, flexion),
        scale * dot(vector, cross(limb, flexion)),
        2.0 * math.atan2(along, turned.w),
    )


@kernel
def hip_strain(ik: IkTable, leg: int, hip: Quat) -> float:
    """Return how much of the hip's range a rotation takes: above 1 it is outside the limits.

    The swing's limit is an ellipse of flexion and sideways swing; the twist has its own.
    """
    angles = hip_angles(ik, leg, hip)
    flexion = angles.x / ik.hip_limit[leg, 0]
    sideways = angles.y / ik.hip_limit[leg, 1]
    swing = math.sqrt(flexion * flexion + sideways * sideways)
    return max(swing, abs(angles.z) / ik.hip_limit[leg, 2])


@kernel
def limited_hip(ik: IkTable, leg: int, hip: Quat) -> Quat:
    """Return the hip's rotation with swing and twist brought inside their limits."""
    angles = hip_angles(ik, leg, hip)
    limit = load_vec3(ik.hip_limit[leg])
    flexion = angles.x / limit.x
    sideways = angles.y / limit.y
    strain = math.sqrt(flexion * flexion + sideways * sideways)
    if strain <= 1.0 and abs(angles.z) <= limit.z:
        return hip
    limb = load_vec3(ik.limb_axis[leg])
    axis = load_vec3(ik.flexion_axis[leg])
    shrink = 1.0 / max(strain, 1.0)
    swing = axis * (angles.x * shrink) + cross(limb, axis) * (angles.y * shrink)
    angle = length(swing)
    twist = from_axis_angle(limb, min(max(angles.z, -limit.z), limit.z))
    turned = from_axis_angle(normalized(swing, axis), angle) * twist
    return turned * load_quat(ik.hip_stance[leg])
