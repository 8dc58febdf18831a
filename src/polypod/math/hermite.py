"""Cubic Hermite pieces: two points, the derivatives there, and a parameter from 0 to 1."""

from __future__ import annotations

from polypod.compute import kernel
from polypod.math.vec3 import Vec3


@kernel
def hermite_weights(u: float) -> tuple[float, float, float, float]:
    """Return the weights of first point, first derivative, last point, last derivative at `u`."""
    rest = 1.0 - u
    return (
        rest * rest * (1.0 + 2.0 * u),
        rest * rest * u,
        u * u * (1.0 + 2.0 * rest),
        -u * u * rest,
    )


@kernel
def hermite_slope_weights(u: float) -> tuple[float, float, float, float]:
    """Return the derivatives with respect to `u` of the four weights."""
    rest = 1.0 - u
    return (-6.0 * u * rest, rest * (1.0 - 3.0 * u), 6.0 * u * rest, u * (3.0 * u - 2.0))


@kernel
def hermite(p0: Vec3, m0: Vec3, p1: Vec3, m1: Vec3, u: float) -> Vec3:
    """Return the point at `u`; `m0` and `m1` are derivatives with respect to `u`."""
    a, b, c, d = hermite_weights(u)
    return p0 * a + m0 * b + p1 * c + m1 * d


@kernel
def hermite_slope(p0: Vec3, m0: Vec3, p1: Vec3, m1: Vec3, u: float) -> Vec3:
    """Return the derivative with respect to `u` at `u`."""
    a, b, c, d = hermite_slope_weights(u)
    return p0 * a + m0 * b + p1 * c + m1 * d
