"""Squares of the plan, each with the solids that reach it: whatever is asked looks there first."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from polypod.compute import kernel

if TYPE_CHECKING:
    from polypod.environment.table import EnvironmentTable, FloatArray, IntArray


@kernel
def bucket_at(env: EnvironmentTable, x: float, z: float) -> int:
    """Return the bucket of a plan point, or -1 where there is none."""
    column = math.floor((x - env.bucket_place[0]) / env.bucket_place[2])
    row = math.floor((z - env.bucket_place[1]) / env.bucket_place[2])
    if row < 0 or column < 0 or row >= env.bucket_shape[0] or column >= env.bucket_shape[1]:
        return -1
    return int(row * env.bucket_shape[1] + column)


@kernel
def bucket_line(place: FloatArray, shape: IntArray, value: float, axis: int) -> int:
    """Return the column (axis 0, of x) or row (axis 1, of z), moved into the grid."""
    line = math.floor((value - place[axis]) / place[2])
    return int(min(max(line, 0.0), shape[1 - axis] - 1.0))


@kernel
def first_met(bucket_range: IntArray, o: int, row: int, column: int, top: int, left: int) -> bool:
    """Say whether bucket (row, column) is the first that lists `o` in a range that starts there.

    A range of buckets from (top, left) lists an obstacle many times; this picks one of them.
    """
    met_row = max(top, bucket_range[o, 0])
    met_column = max(left, bucket_range[o, 1])
    return bool(row == met_row and column == met_column)
