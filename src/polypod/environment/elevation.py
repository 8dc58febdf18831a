"""The terrain's part of the maps: least and greatest height in each cell, exactly; water.

Between samples the ground is straight along x and along z, so over a cell it is extreme where the
cell's sides and the sample lines cross each other or themselves, and nowhere else.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from polypod.compute import kernel
from polypod.environment.pages import stored
from polypod.environment.table import EnvironmentTable, FloatArray, IntArray

if TYPE_CHECKING:
    from polypod.environment.maps import LocalMap

# Bare terrain is an edge where it differs by more than this many cells within one: an even slope is
# none up to about 45 degrees.
TERRAIN_JUMP = 1.5


@kernel
def fill_terrain(env: EnvironmentTable, window: LocalMap) -> None:
    """Set highest and lowest from the terrain alone, and clear what later phases mark."""
    n = window.size[0]
    cell = window.place[2]
    level = env.terrain_range[0] == env.terrain_range[1]
    for i in range(n):
        for j in range(n):
            window.highest[i, j] = env.terrain_range[1] if level else -math.inf
            window.lowest[i, j] = env.terrain_range[0] if level else math.inf
            window.forbidden[i, j] = False
            window.wet[i, j] = False
            window.kind[i, j] = 0
            window.jump[i, j] = TERRAIN_JUMP * cell
    if level:
        return
    for j in range(n + 1):
        u = (window.place[0] + j * cell - env.terrain_place[0]) / env.terrain_place[2]
        u = min(max(u, float(env.first_column)), float(env.last_column))
        window.column[j] = min(math.floor(u), env.last_column - 1)
        window.fraction[j] = u - window.column[j]
    last_row = 0
    for i in range(n + 1):
        v = (window.place[1] + i * cell - env.terrain_place[1]) / env.terrain_place[2]
        v = min(max(v, float(env.first_row)), float(env.last_row))
        row = min(math.floor(v), env.last_row - 1)
        # Sample rows inside the map's row that has just ended, then the line between two map rows.
        if i > 0:
            for inner in range(last_row + 1, row + 1):
                _scan_line(env, window.column, window.fraction, window.line, n, inner, 0.0)
                _take_line(window.highest, window.lowest, window.line, n, i - 1)
        last_row = row
        _scan_line(env, window.column, window.fraction, window.line, n, row, v - row)
        if i > 0:
            _take_line(window.highest, window.lowest, window.line, n, i - 1)
        if i < n:
            _take_line(window.highest, window.lowest, window.line, n, i)


@kernel
def _scan_line(
    env: EnvironmentTable,
    first: IntArray,
    share: FloatArray,
    line: FloatArray,
    n: int,
    row: int,
    fraction: float,
) -> None:
    """Set for each map column the ground's extremes along a line of constant z.

    Map column j goes from place `share[j]` in patch `first[j]` to `share[j + 1]` in `first[j + 1]`.
    """
    heights = env.heights
    here = 1.0 - fraction
    column = first[0]
    i, k = stored(env, row, column)
    near = heights[i, k] * here + heights[i + 1, k] * fraction
    far = heights[i, k + 1] * here + heights[i + 1, k + 1] * fraction
    height = near + (far - near) * share[0]
    for j in range(n):
        greatest = height
        least = height
        while column < first[j + 1]:
            # The sample line between this patch and the next.
            greatest = max(greatest, far)
            least = min(least, far)
            column += 1
            near = far
            i, k = stored(env, row, column)
            far = heights[i, k + 1] * here + heights[i + 1, k + 1] * fraction
        height = near + (far - near) * share[j + 1]
        line[0, j] = max(greatest, height)
        line[1, j] = min(least, height)


@kernel
def _take_line(highest: FloatArray, lowest: FloatArray, line: FloatArray, n: int, i: int) -> None:
    """Widen the extremes of map row `i` by those of the scanned line."""
    for j in range(n):
        highest[i, j] = max(highest[i, j], line[0, j])
        lowest[i, j] = min(lowest[i, j], line[1, j])


@kernel
def fill_water(
    env: EnvironmentTable,
    window: LocalMap,
    foot_half_x: float,
    foot_half_z: float,
    foot_yaw: float,
) -> None:
    """Mark the cells in which the box around some foot overlaps water."""
    n = window.size[0]
    sample = env.terrain_place[2]
    cosine = abs(math.cos(foot_yaw))
    sine = abs(math.sin(foot_yaw))
    reach_x = foot_half_x * cosine + foot_half_z * sine
    reach_z = foot_half_x * sine + foot_half_z * cosine
    for i in range(n):
        z = window.place[1] + i * window.place[2] - env.terrain_place[1]
        top = _nearest_sample((z - reach_z) / sample, env.first_row, env.last_row)
        bottom = _nearest_sample(
            (z + window.place[2] + reach_z) / sample, env.first_row, env.last_row
        )
        for j in range(n):
            x = window.place[0] + j * window.place[2] - env.terrain_place[0]
            left = _nearest_sample((x - reach_x) / sample, env.first_column, env.last_column)
            right = _nearest_sample(
                (x + window.place[2] + reach_x) / sample, env.first_column, env.last_column
            )
            for row in range(top, bottom + 1):
                for column in range(left, right + 1):
                    at_row, at_column = stored(env, row, column)
                    if env.water[at_row, at_column]:
                        window.wet[i, j] = True


@kernel
def _nearest_sample(place: float, first: int, last: int) -> int:
    return min(max(math.floor(place + 0.5), first), last)
