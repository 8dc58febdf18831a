"""The terrain under a foot's whole shape, exactly: how far it is from a plane, and water.

Over a patch between four samples the ground is bilinear, so where it is cut by the foot's outline
it is extreme on the outline or at a sample, and nowhere else.
"""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.environment.pages import stored
from polypod.environment.table import EnvironmentTable, ground_height
from polypod.footprints.settings import Tread


@kernel
def terrain_spread(env: EnvironmentTable, tread: Tread) -> tuple[float, float]:
    """Return how far, least and most, the terrain is above the tread's plane under its shape; m."""
    least = math.inf
    most = -math.inf
    if env.terrain_range[0] == env.terrain_range[1]:
        tilt = abs(tread.slope_a) * tread.half_a + abs(tread.slope_b) * tread.half_b
        level = env.terrain_range[0] - tread.y
        return level - tilt, level + tilt
    x0 = env.terrain_place[0]
    z0 = env.terrain_place[1]
    cell = env.terrain_place[2]
    reach_x = tread.half_a * abs(tread.cosine) + tread.half_b * abs(tread.sine)
    reach_z = tread.half_a * abs(tread.sine) + tread.half_b * abs(tread.cosine)
    left = _patch_of((tread.x - reach_x - x0) / cell, env.first_column, env.last_column)
    right = _patch_of((tread.x + reach_x - x0) / cell, env.first_column, env.last_column)
    top = _patch_of((tread.z - reach_z - z0) / cell, env.first_row, env.last_row)
    bottom = _patch_of((tread.z + reach_z - z0) / cell, env.first_row, env.last_row)
    for row in range(top, bottom + 1):
        for column in range(left, right + 1):
            if row >= env.first_row and column >= env.first_column:
                off_x = x0 + column * cell - tread.x
                off_z = z0 + row * cell - tread.z
                a = off_x * tread.cosine - off_z * tread.sine
                b = off_x * tread.sine + off_z * tread.cosine
                if abs(a) <= tread.half_a and abs(b) <= tread.half_b:
                    at_row, at_column = stored(env, row, column)
                    gap = env.heights[at_row, at_column] - _plane(tread, a, b)
                    least = min(least, gap)
                    most = max(most, gap)
            # Beyond the edge the outermost patches go on for ever.
            low_x = x0 + column * cell if column >= env.first_column else -math.inf
            high_x = x0 + (column + 1) * cell if column < env.last_column else math.inf
            low_z = z0 + row * cell if row >= env.first_row else -math.inf
            high_z = z0 + (row + 1) * cell if row < env.last_row else math.inf
            for side in range(4):
                low, high = _along_side(env, tread, side, low_x, high_x, low_z, high_z)
                least = min(least, low)
                most = max(most, high)
    return least, most


@kernel
def _patch_of(line: float, first: int, last: int) -> int:
    """Return the patch of a coordinate in cells; `first` - 1 and `last` lie beyond the edge."""
    return min(max(math.floor(line), first - 1), last)


@kernel
def _plane(tread: Tread, a: float, b: float) -> float:
    """Return the height of the tread's plane."""
    return tread.y + tread.slope_a * a + tread.slope_b * b


@kernel
def _along_side(
    env: EnvironmentTable,
    tread: Tread,
    side: int,
    low_x: float,
    high_x: float,
    low_z: float,
    high_z: float,
) -> tuple[float, float]:
    """Return the terrain's least and greatest gap to the plane along the part of a side in a patch.

    Where there is none: (inf, -inf).
    """
    # Side 0 and 1 at +a and -a, 2 and 3 at +b and -b; u goes along it from -1 to 1.
    sign = 1.0 if side % 2 == 0 else -1.0
    a0 = sign * tread.half_a if side < 2 else 0.0
    b0 = 0.0 if side < 2 else sign * tread.half_b
    a1 = 0.0 if side < 2 else tread.half_a
    b1 = tread.half_b if side < 2 else 0.0
    x = tread.x + a0 * tread.cosine + b0 * tread.sine
    z = tread.z - a0 * tread.sine + b0 * tread.cosine
    along_x = a1 * tread.cosine + b1 * tread.sine
    along_z = -a1 * tread.sine + b1 * tread.cosine
    first, last = _clipped(x, along_x, low_x, high_x, -1.0, 1.0)
    first, last = _clipped(z, along_z, low_z, high_z, first, last)
    if first > last:
        return math.inf, -math.inf
    middle = 0.5 * (first + last)
    start = ground_height(env, x + along_x * first, z + along_z * first)
    half = ground_height(env, x + along_x * middle, z + along_z * middle)
    end = ground_height(env, x + along_x * last, z + along_z * last)
    start -= _plane(tread, a0 + a1 * first, b0 + b1 * first)
    half -= _plane(tread, a0 + a1 * middle, b0 + b1 * middle)
    end -= _plane(tread, a0 + a1 * last, b0 + b1 * last)
    least = min(start, end)
    most = max(start, end)
    # A parabola through the three: its vertex, where that is between the ends.
    bend = start + end - 2.0 * half
    if abs(end - start) < 2.0 * abs(bend):
        vertex = half - (end - start) * (end - start) / (8.0 * bend)
        least = min(least, vertex)
        most = max(most, vertex)
    return least, most


@kernel
def _clipped(
    start: float, along: float, low: float, high: float, first: float, last: float
) -> tuple[float, float]:
    """Return the part of [first, last] in which start + u along is from `low` to `high`."""
    if abs(along) < 1e-12:
        return (first, last) if low <= start <= high else (1.0, -1.0)
    one = (low - start) / along
    two = (high - start) / along
    return max(first, min(one, two)), min(last, max(one, two))


@kernel
def is_tread_wet(env: EnvironmentTable, tread: Tread) -> bool:
    """Say whether any of the foot's shape lies in water: each sample stands for a square cell."""
    if env.water.shape[0] == 0:
        return False
    cell = env.terrain_place[2]
    middle_x = (tread.x - env.terrain_place[0]) / cell
    middle_z = (tread.z - env.terrain_place[1]) / cell
    sine = abs(tread.sine)
    cosine = abs(tread.cosine)
    half_a = tread.half_a / cell
    half_b = tread.half_b / cell
    reach_x = half_a * cosine + half_b * sine
    reach_z = half_a * sine + half_b * cosine
    corner = 0.5 * (cosine + sine)
    for row in range(
        math.floor(middle_z - reach_z + 0.5), math.floor(middle_z + reach_z + 0.5) + 1
    ):
        for column in range(
            math.floor(middle_x - reach_x + 0.5), math.floor(middle_x + reach_x + 0.5) + 1
        ):
            at_row, at_column = stored(
                env,
                min(max(row, env.first_row), env.last_row),
                min(max(column, env.first_column), env.last_column),
            )
            if not env.water[at_row, at_column]:
                continue
            off_x = column - middle_x
            off_z = row - middle_z
            a = abs(off_x * tread.cosine - off_z * tread.sine)
            b = abs(off_x * tread.sine + off_z * tread.cosine)
            if a < half_a + corner and b < half_b + corner:
                return True
    return False
