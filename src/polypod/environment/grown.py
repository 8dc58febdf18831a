"""The obstacles' part of the maps: footprints grown by the foot, rasterised exactly (P1 Figure 12).

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
from polypod.environment.shapes import BOX, CYLINDER, SPHERE, VERTICAL
from polypod.environment.table import (
    EnvironmentTable,
    FloatArray,
    bucket_line,
    first_met,
    shift_of,
)

if TYPE_CHECKING:
    from polypod.environment.maps import LocalMap

# What a cell holds, the colours of P1 Figure 11; where several hold, the last.
KIND_GROUND = 0
KIND_GROWN = 1  # only the growth by the foot reaches it
KIND_EDGE = 2
KIND_CORNER = 3
KIND_INSIDE = 4
KIND_FORBIDDEN = 5

# Where the side of an obstacle crosses a cell, this many cells of height make an edge.
OBSTACLE_JUMP = 0.25
# What moves is drawn at so many moments from now to touchdown.
MOVING_TIMES = 4
ROUNDING = 1e-9  # in cells: a touch counts, whichever way it is rounded

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
def fill_obstacles(
    env: EnvironmentTable,
    window: LocalMap,
    foot_half_x: float,
    foot_half_z: float,
    foot_yaw: float,
    ahead: float,
) -> None:
    """Raise the cells that obstacles near the window reach, and mark the forbidden ones.

    What moves is drawn where it is, where it will be `ahead` seconds from now, and between.
    """
    side = window.size[0] * window.place[2]
    reach = math.hypot(foot_half_x, foot_half_z)
    least_x = window.place[0] - reach
    least_z = window.place[1] - reach
    greatest_x = window.place[0] + side + reach
    greatest_z = window.place[1] + side + reach
    left = bucket_line(env.bucket_place, env.bucket_shape, least_x, 0)
    right = bucket_line(env.bucket_place, env.bucket_shape, greatest_x, 0)
    top = bucket_line(env.bucket_place, env.bucket_shape, least_z, 1)
    bottom = bucket_line(env.bucket_place, env.bucket_shape, greatest_z, 1)
    for row in range(top, bottom + 1):
        for column in range(left, right + 1):
            bucket = row * env.bucket_shape[1] + column
            for i in range(env.bucket_start[bucket], env.bucket_start[bucket + 1]):
                o = env.bucket_item[i]
                if (
                    first_met(env.bucket_range, o, row, column, top, left)
                    and env.swept[o, 0] <= greatest_x
                    and env.swept[o, 3] >= least_x
                    and env.swept[o, 2] <= greatest_z
                    and env.swept[o, 5] >= least_z
                ):
                    _raise_moved(env, window, o, foot_half_x, foot_half_z, foot_yaw, ahead)


@kernel
def _raise_moved(
    env: EnvironmentTable,
    window: LocalMap,
    o: int,
    foot_half_x: float,
    foot_half_z: float,
    foot_yaw: float,
    ahead: float,
) -> None:
    """Write obstacle `o` into every cell that it reaches on its way; a still one once.

    Cells are shifted, not the obstacle: its rows stay where they are.
    """
    moves = env.velocity[o, 0] != 0.0 or env.velocity[o, 1] != 0.0 or env.velocity[o, 2] != 0.0
    times = MOVING_TIMES if moves and ahead > 0.0 else 1
    corner_x = window.place[0]
    corner_z = window.place[1]
    for k in range(times):
        shift = shift_of(env, o, ahead * k / max(times - 1, 1))
        window.place[0] = corner_x - shift.x
        window.place[1] = corner_z - shift.z
        _raise_cells(env, window, o, foot_half_x, foot_half_z, foot_yaw, shift.y)
    window.place[0] = corner_x
    window.place[1] = corner_z


@kernel
def _raise_cells(
    env: EnvironmentTable,
    window: LocalMap,
    o: int,
    foot_half_x: float,
    foot_half_z: float,
    foot_yaw: float,
    rise: float,
) -> None:
    """Write obstacle `o`, `rise` metres above its rows, into every cell that it reaches."""
    n = window.size[0]
    cell = window.place[2]
    count = _set_sides(env, window, o, foot_half_x, foot_half_z, foot_yaw)
    tops = _set_tops(env, window, o, foot_half_x, foot_half_z, foot_yaw)
    level = tops == 1 and window.tops[0, SPREAD] == 0.0
    forbidden = env.forbidden[o]
    slack = ROUNDING * cell
    kind_level = KIND_FORBIDDEN if forbidden else KIND_GROUND
    reach = math.hypot(foot_half_x, foot_half_z) + cell
    first = _cell_at((env.bounds[o, 2] - reach - window.place[1]) / cell, n)
    last = _cell_at((env.bounds[o, 5] + reach - window.place[1]) / cell, n)
    high = window.tops[0, BASE] + rise
    low = high
    covered = True
    for i in range(first, last + 1):
        z = window.place[1] + (i + 0.5) * cell
        least, greatest = _span(window.sides, count, slack, z, GROWN)
        if least > greatest + slack:
            continue
        overlap_least, overlap_greatest = _span(window.sides, count, slack, z, OVERLAP)
        inside_least, inside_greatest = _span(window.sides, count, slack, z, INSIDE)
        covered_least, covered_greatest = _span(window.sides, count, slack, z, COVERED)
        left = math.ceil(max((least - window.place[0]) / cell - 0.5 - ROUNDING, 0.0))
        right = math.floor(min((greatest - window.place[0]) / cell - 0.5 + ROUNDING, n - 1.0))
        for j in range(left, right + 1):
            x = window.place[0] + (j + 0.5) * cell
            if not level:
                high, low, covered = _tops(window.tops, tops, x, z)
                high = min(high, env.bounds[o, 4]) + rise
                low += rise
            if high <= window.lowest[i, j] and not forbidden:
                continue
            kind = KIND_GROWN
            if inside_least <= x <= inside_greatest:
                kind = KIND_INSIDE
            elif overlap_least <= x <= overlap_greatest:
                kind = KIND_EDGE
            window.kind[i, j] = max(window.kind[i, j], max(kind, kind_level))
            window.forbidden[i, j] |= forbidden
            window.highest[i, j] = max(window.highest[i, j], high)
            if covered and covered_least <= x <= covered_greatest:
                window.lowest[i, j] = max(window.lowest[i, j], low)
            else:
                window.jump[i, j] = OBSTACLE_JUMP * cell
    corners = env.footprint_count[o] if env.kind[o] == BOX else 0
    for v in range(corners):
        j = math.floor((env.footprint[o, v, 0] - window.place[0]) / cell)
        i = math.floor((env.footprint[o, v, 1] - window.place[1]) / cell)
        if min(i, j) >= 0 and max(i, j) < n and window.kind[i, j] == KIND_EDGE:
            window.kind[i, j] = KIND_CORNER


@kernel
def _cell_at(place: float, n: int) -> int:
    return math.floor(min(max(place, 0.0), n - 1.0))


@kernel
def _set_sides(
    env: EnvironmentTable,
    window: LocalMap,
    o: int,
    foot_half_x: float,
    foot_half_z: float,
    foot_yaw: float,
) -> int:
    """Write the half-planes that bound obstacle `o` grown by cell and foot; return how many."""
    half = 0.5 * window.place[2]
    cosine = math.cos(foot_yaw)
    sine = math.sin(foot_yaw)
    # A round footprint is drawn around the circle: what lies surely in it is a little smaller.
    slack = 0.0 if env.kind[o] == BOX else ROUND_SLACK * env.half_size[o, 0]
    own = env.footprint_count[o]
    for k in range(own + 8):
        if k < own:
            normal_x = env.footprint_side[o, k, 0]
            normal_z = env.footprint_side[o, k, 1]
            reach = env.footprint_side[o, k, 2]
        else:
            # The normals of the cell, then of the foot, each with its opposite.
            normal_x = 1.0 if k - own < 4 else cosine
            normal_z = 0.0 if k - own < 4 else -sine
            if (k - own) % 2 == 1:
                normal_x, normal_z = -normal_z, normal_x
            if (k - own) % 4 >= 2:
                normal_x, normal_z = -normal_x, -normal_z
            reach = _reach(env.footprint[o], own, normal_x, normal_z)
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
def _span(
    sides: FloatArray, count: int, slack: float, z: float, column: int
) -> tuple[float, float]:
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
def _set_tops(
    env: EnvironmentTable,
    window: LocalMap,
    o: int,
    foot_half_x: float,
    foot_half_z: float,
    foot_yaw: float,
) -> int:
    """Write the planes of obstacle `o` that face up; return how many, 0 for a sphere.

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
        rise = env.planes[o, p, 1]
        if rise > VERTICAL:
            slope_x = -env.planes[o, p, 0] / rise
            slope_z = -env.planes[o, p, 2] / rise
            foot = _foot_reach(slope_x, slope_z, cosine, sine, foot_half_x, foot_half_z)
            window.tops[count, SLOPE_X] = slope_x
            window.tops[count, SLOPE_Z] = slope_z
            window.tops[count, BASE] = env.planes[o, p, 3] / rise
            spread = half * (abs(slope_x) + abs(slope_z)) + foot
            window.tops[count, SPREAD] = spread
            window.tops[count, FALL] = spread
            if env.kind[o] == CYLINDER and p < env.plane_count[o] - 2:
                # A side of the prism around a leaning cylinder: what surely holds lies further in.
                window.tops[count, FALL] = spread + ROUND_SAG * env.half_size[o, 0] / rise
            count += 1
    return count


@kernel
def _tops(tops: FloatArray, count: int, x: float, z: float) -> tuple[float, float, bool]:
    """Return the highest and the lowest top of obstacle `o` under feet in the cell around (x, z).

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
