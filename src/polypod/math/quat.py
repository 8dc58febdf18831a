"""Unit quaternions x, y, z, w as a named tuple."""

from __future__ import annotations

import math
import operator
from typing import Any, NamedTuple

from numba import types
from numba.extending import overload

from polypod.compute import kernel
from polypod.math.vec3 import Vec3, cross, dot, length


class Quat(NamedTuple):
    """A rotation; `a * b` turns by `b` first, then by `a`."""

    x: float
    y: float
    z: float
    w: float

    def __mul__(self, other: Quat) -> Quat:  # type: ignore[override]
        """Return the rotation by `other`, then by this one."""
        return Quat(*quaternion_product(self, other))


@kernel
def quaternion_product(a: Quat, b: Quat) -> Quat:
    """Return the rotation by `b`, then by `a`."""
    return Quat(
        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
    )


def _is_quat(value: Any) -> bool:
    kinds = types.NamedTuple | types.NamedUniTuple
    return isinstance(value, kinds) and value.instance_class is Quat


@overload(operator.mul, strict=False)
def _mul(a: Any, b: Any) -> Any:
    if _is_quat(a) and _is_quat(b):
        return lambda a, b: quaternion_product(a, b)
    return None


IDENTITY = Quat(0.0, 0.0, 0.0, 1.0)


@kernel
def conjugate(q: Quat) -> Quat:
    """Return the inverse rotation."""
    return Quat(-q.x, -q.y, -q.z, q.w)


@kernel
def rotate(q: Quat, v: Vec3) -> Vec3:
    """Return the vector turned by the rotation."""
    axis = Vec3(q.x, q.y, q.z)
    twice = cross(axis, v) * 2.0
    return v + twice * q.w + cross(axis, twice)


@kernel
def unrotate(q: Quat, v: Vec3) -> Vec3:
    """Return the vector turned by the inverse rotation."""
    return rotate(conjugate(q), v)


@kernel
def from_axis_angle(axis: Vec3, angle: float) -> Quat:
    """Return the rotation by `angle` radians about the unit `axis`."""
    sine = math.sin(0.5 * angle)
    return Quat(axis.x * sine, axis.y * sine, axis.z * sine, math.cos(0.5 * angle))


@kernel
def from_heading(heading: float) -> Quat:
    """Return the turn about +Y from +Z toward +X by `heading` radians."""
    return Quat(0.0, math.sin(0.5 * heading), 0.0, math.cos(0.5 * heading))


@kernel
def unit(q: Quat) -> Quat:
    """Return the quaternion scaled to length one."""
    size = math.sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w)
    return Quat(q.x / size, q.y / size, q.z / size, q.w / size)


@kernel
def between(a: Vec3, b: Vec3) -> Quat:
    """Return the shortest rotation that turns the direction of `a` to that of `b`.

    Opposite directions turn half way round about some axis at right angles to `a`.
    """
    size = length(a) * length(b)
    if size < 1e-300:
        return Quat(0.0, 0.0, 0.0, 1.0)
    cosine = dot(a, b) / size
    if cosine < -0.999999999:
        side = cross(a, Vec3(1.0, 0.0, 0.0))
        if length(side) < 1e-6 * length(a):
            side = cross(a, Vec3(0.0, 0.0, 1.0))
        side = side * (1.0 / length(side))
        return Quat(side.x, side.y, side.z, 0.0)
    axis = cross(a, b) * (1.0 / size)
    return unit(Quat(axis.x, axis.y, axis.z, 1.0 + cosine))


@kernel
def angle_of(q: Quat) -> float:
    """Return the angle of the rotation, radians in [0, pi]."""
    sine = math.sqrt(q.x * q.x + q.y * q.y + q.z * q.z)
    return 2.0 * math.atan2(sine, abs(q.w))


@kernel
def slerp(a: Quat, b: Quat, weight: float) -> Quat:
    """Return the rotation at `weight` on the shortest way from `a` (0) to `b` (1)."""
    cosine = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w
    sign = 1.0
    if cosine < 0.0:
        sign = -1.0
        cosine = -cosine
    share_a = 1.0 - weight
    share_b = weight
    if cosine < 0.9995:
        angle = math.acos(cosine)
        sine = math.sin(angle)
        share_a = math.sin(share_a * angle) / sine
        share_b = math.sin(share_b * angle) / sine
    share_b *= sign
    return unit(
        Quat(
            a.x * share_a + b.x * share_b,
            a.y * share_a + b.y * share_b,
            a.z * share_a + b.z * share_b,
            a.w * share_a + b.w * share_b,
        )
    )


@kernel
def load_quat(row: Any) -> Quat:
    """Return the four numbers of an array row as a quaternion."""
    return Quat(row[0], row[1], row[2], row[3])


@kernel
def store_quat(row: Any, value: Quat) -> None:
    """Write a quaternion into an array row of four numbers."""
    row[0] = value.x
    row[1] = value.y
    row[2] = value.z
    row[3] = value.w
