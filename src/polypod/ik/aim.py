"""Aim: turn a folded leg to its target, its plane's normal as near the rest's as can be."""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.ik.types import IkTable
from polypod.math.quat import Quat, conjugate, load_quat, unit
from polypod.math.vec3 import Vec3, cross, dot, length, load_vec3, normalized

# Nearer than twice this to the vertical line under the hip, in leg lengths, the heading of a leg's
# plane is held back: straight under the hip a heading means nothing and would spin the leg.
HEADING_FLOOR = 0.25


@kernel
def from_axes(x: Vec3, y: Vec3, z: Vec3) -> Quat:
    """Return the rotation that turns the unit axes to `x`, `y` and `z`, of either sign."""
    trace = x.x + y.y + z.z
    if trace > 0.0:
        q = Quat(y.z - z.y, z.x - x.z, x.y - y.x, 1.0 + trace)
    elif x.x >= y.y and x.x >= z.z:
        q = Quat(1.0 + x.x - y.y - z.z, x.y + y.x, z.x + x.z, y.z - z.y)
    elif y.y >= z.z:
        q = Quat(x.y + y.x, 1.0 + y.y - x.x - z.z, y.z + z.y, z.x - x.z)
    else:
        q = Quat(z.x + x.z, y.z + z.y, 1.0 + z.z - x.x - y.y, x.y - y.x)
    return unit(q)


@kernel
def plane_frame(direction: Vec3, normal: Vec3) -> Quat:
    """Return the frame whose x is `direction` (unit) and whose y is as near `normal` as can be."""
    across = normalized(normal - direction * dot(normal, direction), Vec3(0.0, 1.0, 0.0))
    return from_axes(direction, across, cross(direction, across))


@kernel
def plane_normal(ik: IkTable, leg: int, offset: Vec3) -> Vec3:
    """Return the normal that the leg's plane should have for an effector at `offset` from the hip.

    An erect leg keeps its rest normal. A sprawler's is carried about Y with the target's heading,
    which fades where the target nears the vertical line under the hip or passes behind it.
    """
    normal = load_vec3(ik.normal_stance[leg])
    if not ik.turns_with_heading[leg]:
        return normal
    plan_x = ik.plan_stance[leg, 0]
    plan_z = ik.plan_stance[leg, 1]
    outward = offset.x * plan_x + offset.z * plan_z
    sideways = offset.x * plan_z - offset.z * plan_x
    floor = HEADING_FLOOR * ik.chain_length[leg]
    if outward < 2.0 * floor:
        rising = max(outward, 0.0)
        outward = floor + rising * rising / (4.0 * floor)
    size = math.sqrt(outward * outward + sideways * sideways)
    cosine = outward / size
    sine = sideways / size
    return Vec3(normal.x * cosine + normal.z * sine, normal.y, normal.z * cosine - normal.x * sine)


@kernel
def aimed_hip(chord: Vec3, normal_rest: Vec3, direction: Vec3, normal: Vec3) -> Quat:
    """Return the hip's rotation that turns the folded leg's `chord` to the unit `direction`.

    The plane's normal goes from `normal_rest` to as near `normal` as the direction allows.
    """
    chord_frame = plane_frame(normalized(chord, direction), normal_rest)
    return plane_frame(direction, normal) * conjugate(chord_frame)


@kernel
def hip_for(ik: IkTable, leg: int, chord: Vec3, direction: Vec3) -> Quat:
    """Return the hip's rotation that brings a folded leg's end where it is wanted.

    `chord` is the way from hip to effector while the hip is not turned, m; `direction` the unit
    direction in which that way should lead.
    """
    normal = plane_normal(ik, leg, direction * length(chord))
    aimed = aimed_hip(chord, load_vec3(ik.normal_rest[leg]), direction, normal)
    # Of its two signs the one nearer to the stance, so that components change smoothly too.
    stance = load_quat(ik.hip_stance[leg])
    near = aimed.x * stance.x + aimed.y * stance.y + aimed.z * stance.z + aimed.w * stance.w
    if near < 0.0:
        aimed = Quat(-aimed.x, -aimed.y, -aimed.z, -aimed.w)
    return aimed
