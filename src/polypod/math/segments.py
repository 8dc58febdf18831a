"""Distances between straight pieces in space."""

from __future__ import annotations

from polypod.compute import kernel
from polypod.math.vec3 import Vec3, distance, dot, mix


@kernel
def segment_gap(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> float:
    """Return the least distance between the segments from `a` to `b` and from `c` to `d`.

    The nearest points of the lines, each in turn brought back onto its segment (Ericson, Real-Time
    Collision Detection, 5.1.9); segments may be points.
    """
    first = b - a
    second = d - c
    between = a - c
    first_square = dot(first, first)
    second_square = dot(second, second)
    along = dot(first, second)
    on_first = dot(first, between)
    on_second = dot(second, between)
    spread = first_square * second_square - along * along
    s = 0.0
    # Parallel segments: any place on the first will do, the second answers to it.
    if spread > 1e-12 * first_square * second_square:
        s = min(max((along * on_second - on_first * second_square) / spread, 0.0), 1.0)
    t = 0.0
    if second_square > 0.0:
        t = (along * s + on_second) / second_square
    if t < 0.0 or t > 1.0 or second_square == 0.0:
        t = min(max(t, 0.0), 1.0)
        s = 0.0
        if first_square > 0.0:
            s = min(max((along * t - on_first) / first_square, 0.0), 1.0)
    return distance(mix(a, b, s), mix(c, d, t))
