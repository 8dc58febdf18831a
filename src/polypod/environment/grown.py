"""The obstacles' part of the maps: footprints grown by the foot, rasterised exactly (P1 Figure 12).

`halfplanes` bounds where a solid grown by cell and foot reaches; here that is written into cells.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from polypod.compute import kernel
from polypod.environment.buckets import bucket_line, first_met
from polypod.environment.halfplanes import (
    BASE,
    COVERED,
    GROWN,
    INSIDE,
    OVERLAP,
    SPREAD,
    set_sides,
    set_tops,
    span,
    tops_at,
    turn_rows,
)
from polypod.environment.placing import shift_of, yaw_of
from polypod.environment.shapes import BOX
from polypod.environment.table import EnvironmentTable

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


@kernel
def fill_obstacles(
    env: EnvironmentTable,
    window: LocalMap,
    foot_half_x: float,
    foot_half_z: float,
    foot_yaw: float,
    ahead: float,
) -> None:
    """Raise the cells that solids near the window reach, and mark the forbidden ones.

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
    """Write solid `o` into every cell that it reaches on its way; a still one once.

    Cells are shifted, not the solid: its rows stay where they are; a turned one is copied.
    """
    i = env.owner[o]
    moves = env.velocity[i, 0] != 0.0 or env.velocity[i, 1] != 0.0 or env.velocity[i, 2] != 0.0
    moves = moves or env.yaw_rate[i] != 0.0
    times = MOVING_TIMES if moves and ahead > 0.0 else 1
    corner_x = window.place[0]
    corner_z = window.place[1]
    for k in range(times):
        later = ahead * k / max(times - 1, 1)
        shift = shift_of(env, i, later)
        window.place[0] = corner_x - shift.x
        window.place[1] = corner_z - shift.z
        yaw = yaw_of(env, i, later)
        if yaw != 0.0:
            turn_rows(env, window, o, yaw)
        turns = yaw != 0.0
        _raise_cells(env, window, o, turns, foot_half_x, foot_half_z, foot_yaw, shift.y)
    window.place[0] = corner_x
    window.place[1] = corner_z


@kernel
def _raise_cells(
    env: EnvironmentTable,
    window: LocalMap,
    o: int,
    turns: bool,
    foot_half_x: float,
    foot_half_z: float,
    foot_yaw: float,
    rise: float,
) -> None:
    """Write solid `o`, `rise` metres above its rows, into every cell that it reaches.

    Where it `turns`, the window has its corners, sides and planes.
    """
    n = window.size[0]
    cell = window.place[2]
    corners = window.turned_corners if turns else env.footprint[o]
    own_sides = window.turned_sides if turns else env.footprint_side[o]
    planes = window.turned_planes if turns else env.planes[o]
    least_z = env.bounds[o, 2]
    greatest_z = env.bounds[o, 5]
    for v in range(env.footprint_count[o] if turns else 0):
        least_z = corners[v, 1] if v == 0 else min(least_z, corners[v, 1])
        greatest_z = corners[v, 1] if v == 0 else max(greatest_z, corners[v, 1])
    count = set_sides(env, window, o, corners, own_sides, foot_half_x, foot_half_z, foot_yaw)
    tops = set_tops(env, window, o, planes, foot_half_x, foot_half_z, foot_yaw)
    level = tops == 1 and window.tops[0, SPREAD] == 0.0
    forbidden = env.forbidden[o]
    slack = ROUNDING * cell
    kind_level = KIND_FORBIDDEN if forbidden else KIND_GROUND
    reach = math.hypot(foot_half_x, foot_half_z) + cell
    first = _cell_at((least_z - reach - window.place[1]) / cell, n)
    last = _cell_at((greatest_z + reach - window.place[1]) / cell, n)
    high = window.tops[0, BASE] + rise
    low = high
    covered = True
    for i in range(first, last + 1):
        z = window.place[1] + (i + 0.5) * cell
        least, greatest = span(window.sides, count, slack, z, GROWN)
        if least > greatest + slack:
            continue
        overlap_least, overlap_greatest = span(window.sides, count, slack, z, OVERLAP)
        inside_least, inside_greatest = span(window.sides, count, slack, z, INSIDE)
        covered_least, covered_greatest = span(window.sides, count, slack, z, COVERED)
        left = math.ceil(max((least - window.place[0]) / cell - 0.5 - ROUNDING, 0.0))
        right = math.floor(min((greatest - window.place[0]) / cell - 0.5 + ROUNDING, n - 1.0))
        for j in range(left, right + 1):
            x = window.place[0] + (j + 0.5) * cell
            if not level:
                high, low, covered = tops_at(window.tops, tops, x, z)
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
    for v in range(env.footprint_count[o] if env.kind[o] == BOX else 0):
        j = math.floor((corners[v, 0] - window.place[0]) / cell)
        i = math.floor((corners[v, 1] - window.place[1]) / cell)
        if min(i, j) >= 0 and max(i, j) < n and window.kind[i, j] == KIND_EDGE:
            window.kind[i, j] = KIND_CORNER


@kernel
def _cell_at(place: float, n: int) -> int:
    return math.floor(min(max(place, 0.0), n - 1.0))
