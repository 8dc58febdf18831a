"""Half-planes and top planes of one solid, as `grown` rasterises them: what cells and feet add.

Footprint, foot and cell are convex, so "some foot centred in this cell touches the footprint" means
that the cell's centre lies in the Minkowski sum of the three. In a plane that sum is bounded by
half-planes along the normals of the three shapes' sides, each as far out as the three reach
together; a row of cells meets it in one span.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from polypod.compute import kernel
from polypod.environment.convex import ROUND_SAG, ROUND_SLACK
from polypod.environment.placing import turned
from polypod.environment.shapes import BOX, CYLINDER, SPHERE, VERTICAL
from polypod.environment.table import EnvironmentTable, FloatArray
from polypod.math.vec3 import Vec3, load_vec3, store_vec3

if TYPE_CHECKING:
    from polypod.environment.maps import LocalMap

# A row of LocalMap.sides: a normal (x, z), then how far along it a cell's centre may lie so that
GROWN = 2  # some foot in the cell touches the footprint
OVERLAP = 3  # the cell itself touches it
INSIDE = 4  # the cell lies in it
COVERED = 5  # every foot in the cell lies in it
SIDE_COLUMNS = 6

# A row of LocalMap.tops: a plane y = base + slope_x x + slope_z z; how much it rises from a cell's
# centre to the farthest point of the farthest foot in it; how much it falls, at most.
SLOPE_X, SLOPE_Z, BASE, SPREAD, FALL = 0, 1, 2, 3, 4
TOP_COLUMNS = 5


@kernel
def turn_rows(env: EnvironmentTable, window: LocalMap, o: int, yaw: float) -> None:
    """Write solid `o`'s corners, sides and planes, turned about its obstacle's pivot by `yaw`."""
    pivot = load_vec3(env.pivot[env.owner[o]])
    for v in range(env.footprint_count[o]):
        corner = Vec3(env.footprint[o, v, 0], 0.0, env.footprint[o, v, 1])
        corner = pivot + turned(corner - pivot, yaw)
        normal = Vec3(env.footprint_side[o, v, 0], 0.0, env.footprint_side[o, v, 1])
        normal = turned(normal, yaw)
        window.turned_corners[v, 0] = corner.x
        window.turned_corners[v, 1] = corner.z
        window.turned_sides[v, 0] = normal.x
        window.turned_sides[v, 1] = normal.z
        window.turned_sides[v, 2] = normal.x * corner.x + normal.z * corner.z
    for p in range(env.plane_count[o]):
        normal = load_vec3(env.planes[o, p])
        along = turned(normal, yaw)
        store_vec3(window.turned_planes[p], along)
        aside = (along.x - normal.x) * pivot.x + (along.z - normal.z) * pivot.z
        window.turned_planes[p, 3] = env.planes[o, p, 3] + aside


@kernel
def set_sides(
    env: EnvironmentTable,
    window: LocalMap,
    o: int,
    corners: FloatArray,
    own_sides: FloatArray,
    foot_half_x: float,
    foot_half_z: float,
    foot_yaw: float,
) -> int:
    """Write the half-planes that bound solid `o` grown by cell and foot; return how many.

    `corners` and `own_sides` are its footprint's, as it is turned now.
    """
    half = 0.5 * window.place[2]
    cosine = math.cos(foot_yaw)
    sine = math.sin(foot_yaw)
    # A round footprint is drawn around the circle: what lies surely in it is a little smaller.
    slack = 0.0 if env.kind[o] == BOX else ROUND_SLACK * env.half_size[o, 0]
    own = env.footprint_count[o]
    for k in range(own + 8):
        if k < own:
            normal_x = own_sides[k, 0]
            normal_z = own_sides[k, 1]
            reach = own_sides[k, 2]
        else:
            # The normals of the cell, then of the foot, each with its opposite.
            normal_x = 1.0 if k - own < 4 else cosine
            normal_z = 0.0 if k - own < 4 else -sine
            if (k - own) % 2 == 1:
                normal_x, normal_z = -normal_z, normal_x
            if (k - own) % 4 >= 2:
                normal_x, normal_z = -normal_x, -normal_z
            reach = _reach(corners, own, normal_x, normal_z)
        cell_reach = half * (abs(normal_x) + abs(normal_z))
        foot_reach = _foot_reach(normal_x, normal_z, cosine, sine, foot_half_x, foot_half_z)
        window.sides[k, 0] = normal_x
        window.sides[k, 1] = normal_z
        window.sides[k, GROWN] = reach + cell_reach + foot_reach
        window.sides[k, OVERLAP] = reach + cell_reach if k < own + 4 else math.inf
        window.sides[k, INSIDE] = reach - cell_reach - slack if k < own else math.inf
        window.sides[k, COVERED] = reach - cell_reach - foot_reach - slack if k < own else math.inf
    return int(own + 8)


@kernel
def _reach(corners: FloatArray, count: int, normal_x: float, normal_z: float) -> float:
    """Return how far a footprint reaches along a plan direction."""
    reach = -math.inf
    for v in range(count):
        reach = max(reach, float(normal_x * corners[v, 0] + normal_z * corners[v, 1]))
    return reach


@kernel
def _foot_reach(
    x: float, z: float, cosine: float, sine: float, foot_half_x: float, foot_half_z: float
) -> float:
    """Return how far the foot's rectangle reaches along a plan direction; times its size."""
    return foot_half_x * abs(x * cosine - z * sine) + foot_half_z * abs(x * sine + z * cosine)


@kernel
def span(sides: FloatArray, count: int, slack: float, z: float, column: int) -> tuple[float, float]:
    """Return the least and greatest x of a row inside all half-planes; (inf, -inf) for none."""
    least = -math.inf
    greatest = math.inf
    for k in range(count):
        normal_x = sides[k, 0]
        room = sides[k, column] - sides[k, 1] * z
        if normal_x > VERTICAL:
            greatest = min(greatest, room / normal_x)
        elif normal_x < -VERTICAL:
            least = max(least, room / normal_x)
        elif room < -slack:
            return math.inf, -math.inf
    return least, greatest


@kernel
def set_tops(
    env: EnvironmentTable,
    window: LocalMap,
    o: int,
    planes: FloatArray,
    foot_half_x: float,
    foot_half_z: float,
    foot_yaw: float,
) -> int:
    """Write those of solid `o`'s planes that face up; return how many, 0 for a sphere.

    `planes` are as it is turned now.
    A sphere writes the half sizes, along x and z, of the box around the feet in a cell, and in the
    second row its centre and its radius.
    """
    cosine = math.cos(foot_yaw)
    sine = math.sin(foot_yaw)
    half = 0.5 * window.place[2]
    if env.kind[o] == SPHERE:
        foot_x = _foot_reach(1.0, 0.0, cosine, sine, foot_half_x, foot_half_z)
        foot_z = _foot_reach(0.0, 1.0, cosine, sine, foot_half_x, foot_half_z)
        window.tops[0, 0] = half + foot_x
        window.tops[0, 1] = half + foot_z
        for axis in range(3):
            window.tops[1, axis] = env.position[o, axis]
        window.tops[1, 3] = env.half_size[o, 0]
        return 0
    count = 0
    for p in range(env.plane_count[o]):
        rise = planes[p, 1]
        if rise > VERTICAL:
            slope_x = -planes[p, 0] / rise
            slope_z = -planes[p, 2] / rise
            foot = _foot_reach(slope_x, slope_z, cosine, sine, foot_half_x, foot_half_z)
            window.tops[count, SLOPE_X] = slope_x
            window.tops[count, SLOPE_Z] = slope_z
            window.tops[count, BASE] = planes[p, 3] / rise
            spread = half * (abs(slope_x) + abs(slope_z)) + foot
            window.tops[count, SPREAD] = spread
            window.tops[count, FALL] = spread
            if env.kind[o] == CYLINDER and p < env.plane_count[o] - 2:
                # A side of the prism around a leaning cylinder: what surely holds lies further in.
                window.tops[count, FALL] = spread + ROUND_SAG * env.half_size[o, 0] / rise
            count += 1
    return count


@kernel
def tops_at(tops: FloatArray, count: int, x: float, z: float) -> tuple[float, float, bool]:
    """Return the highest and the lowest top of solid `o` under feet in the cell around (x, z).

    The lowest holds only where the third value is true and the feet are covered by the footprint.
    The top is the least of the planes that face up, so its minimum is the least of their minima;
    the least of their maxima is its maximum or a little above.
    """
    if count == 0:
        off_x = abs(x - tops[1, 0])
        off_z = abs(z - tops[1, 2])
        near = math.hypot(max(off_x - tops[0, 0], 0.0), max(off_z - tops[0, 1], 0.0))
        far = math.hypot(off_x + tops[0, 0], off_z + tops[0, 1])
        radius = tops[1, 3]
        high = tops[1, 1] + math.sqrt(max(radius * radius - near * near, 0.0))
        low = tops[1, 1] + math.sqrt(max(radius * radius - far * far, 0.0))
        return high, low, far < radius
    high = math.inf
    low = math.inf
    for k in range(count):
        middle = tops[k, BASE] + tops[k, SLOPE_X] * x + tops[k, SLOPE_Z] * z
        high = min(high, middle + tops[k, SPREAD])
        low = min(low, middle - tops[k, FALL])
    return high, low, True
