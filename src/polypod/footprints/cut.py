"""One solid in a foot's own axes: a across, b along, from its middle.

Over the foot's shape a solid's top is the least of its planes. So where it is higher than some
plane is a convex polygon in a and b, an intersection of half-planes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from polypod.compute import kernel
from polypod.environment.placing import own_point, turned, yaw_of
from polypod.environment.shapes import VERTICAL
from polypod.environment.table import EnvironmentTable
from polypod.footprints.settings import Tread
from polypod.math.vec3 import Vec3

ANYWHERE = -1e300  # a level that everything is above


class Cut(NamedTuple):
    """A foot's place as it lies to one solid's rows: its middle and its axes; m."""

    middle: Vec3  # y: what the rows are lower than in the world
    a_x: float
    a_z: float
    b_x: float
    b_z: float


@kernel
def cut_of(env: EnvironmentTable, tread: Tread, o: int) -> Cut:
    """Return a foot's place as it will lie to solid `o`."""
    i = env.owner[o]
    middle = own_point(env, i, Vec3(tread.x, 0.0, tread.z), tread.ahead)
    yaw = yaw_of(env, i, tread.ahead)
    a = turned(Vec3(tread.cosine, 0.0, -tread.sine), -yaw)
    b = turned(Vec3(tread.sine, 0.0, tread.cosine), -yaw)
    return Cut(middle, a.x, a.z, b.x, b.z)


@kernel
def bound(
    env: EnvironmentTable, tread: Tread, cut: Cut, o: int, k: int, level: float
) -> tuple[float, float, float]:
    """Return g, h, r: one of the half-planes g a + h b <= r of the polygon where `o` is so high.

    `level` (m) is counted from the tread's plane. The first are the footprint's sides, the others
    the planes that face up.
    """
    sides = env.footprint_count[o]
    if k < sides:
        x = env.footprint_side[o, k, 0]
        z = env.footprint_side[o, k, 1]
        room = env.footprint_side[o, k, 2] - x * cut.middle.x - z * cut.middle.z
        return x * cut.a_x + z * cut.a_z, x * cut.b_x + z * cut.b_z, room
    rise = env.planes[o, k - sides, 1]
    if rise <= VERTICAL or level == ANYWHERE:
        return 0.0, 0.0, math.inf
    x = env.planes[o, k - sides, 0] / rise
    z = env.planes[o, k - sides, 2] / rise
    top = env.planes[o, k - sides, 3] / rise - x * cut.middle.x - z * cut.middle.z - cut.middle.y
    return (
        x * cut.a_x + z * cut.a_z + tread.slope_a,
        x * cut.b_x + z * cut.b_z + tread.slope_b,
        top - tread.y - level,
    )
