"""Three-vectors as a named tuple with operators, in kernels and in plain Python alike."""

from __future__ import annotations

import math
import operator
from typing import Any, NamedTuple

from numba import types
from numba.extending import overload

from polypod.compute import kernel


class Vec3(NamedTuple):
    """A point or a direction; units and frame are the name's business (`foot_world`)."""

    x: float
    y: float
    z: float

    def __add__(self, other: Vec3) -> Vec3:  # type: ignore[override]
        """Return the sum."""
        return Vec3(self.x + other.x, self.y + other.y, self.z + other.z)

    def __sub__(self, other: Vec3) -> Vec3:
        """Return the difference."""
        return Vec3(self.x - other.x, self.y - other.y, self.z - other.z)

    def __mul__(self, scale: float) -> Vec3:  # type: ignore[override]
        """Return the vector scaled."""
        return Vec3(self.x * scale, self.y * scale, self.z * scale)

    def __neg__(self) -> Vec3:
        """Return the vector reversed."""
        return Vec3(-self.x, -self.y, -self.z)


def _is_vec3(value: Any) -> bool:
    kinds = types.NamedTuple | types.NamedUniTuple
    return isinstance(value, kinds) and value.instance_class is Vec3


@overload(operator.add, strict=False)
def _add(a: Any, b: Any) -> Any:
    if _is_vec3(a) and _is_vec3(b):
        return lambda a, b: Vec3(a.x + b.x, a.y + b.y, a.z + b.z)
    return None


@overload(operator.sub, strict=False)
def _sub(a: Any, b: Any) -> Any:
    if _is_vec3(a) and _is_vec3(b):
        return lambda a, b: Vec3(a.x - b.x, a.y - b.y, a.z - b.z)
    return None


@overload(operator.mul, strict=False)
def _mul(a: Any, b: Any) -> Any:
    if _is_vec3(a) and isinstance(b, types.Float | types.Integer):
        return lambda a, b: Vec3(a.x * b, a.y * b, a.z * b)
    return None


@overload(operator.neg, strict=False)
def _neg(a: Any) -> Any:
    if _is_vec3(a):
        return lambda a: Vec3(-a.x, -a.y, -a.z)
    return None


@kernel
def dot(a: Vec3, b: Vec3) -> float:
    """Return the scalar product."""
    return a.x * b.x + a.y * b.y + a.z * b.z


@kernel
def cross(a: Vec3, b: Vec3) -> Vec3:
    """Return the vector product, right-handed."""
    return Vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)


@kernel
def length(a: Vec3) -> float:
    """Return the Euclidean length."""
    return math.sqrt(a.x * a.x + a.y * a.y + a.z * a.z)


@kernel
def length_plan(a: Vec3) -> float:
    """Return the length of the projection on the ground plane."""
    return math.sqrt(a.x * a.x + a.z * a.z)


@kernel
def distance(a: Vec3, b: Vec3) -> float:
    """Return the distance between two points."""
    return length(a - b)


@kernel
def normalized(a: Vec3, fallback: Vec3) -> Vec3:
    """Return the unit vector along `a`, or `fallback` where `a` has no direction."""
    size = length(a)
    if size < 1e-12:
        return fallback
    return a * (1.0 / size)


@kernel
def mix(a: Vec3, b: Vec3, weight: float) -> Vec3:
    """Return the point at `weight` on the way from `a` (0) to `b` (1)."""
    return a * (1.0 - weight) + b * weight


@kernel
def load_vec3(row: Any) -> Vec3:
    """Return the three numbers of an array row as a vector."""
    return Vec3(row[0], row[1], row[2])


@kernel
def store_vec3(row: Any, value: Vec3) -> None:
    """Write a vector into an array row of three numbers."""
    row[0] = value.x
    row[1] = value.y
    row[2] = value.z
