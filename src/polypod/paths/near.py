"""Which solids are near enough to be asked at all."""

from __future__ import annotations

from typing import Any

from polypod.compute import kernel
from polypod.environment.buckets import bucket_line, first_met
from polypod.environment.table import EnvironmentTable


@kernel
def obstacles_near(
    env: EnvironmentTable, x0: float, z0: float, x1: float, z1: float, above: float, near: Any
) -> int:
    """List the solids whose bounds meet a rectangle in plan; return how many there are.

    Only those count that are forbidden or reach higher than `above` (m). As many as fit are written
    to `near`; the count goes on.
    """
    if env.bucket_shape[0] == 0:
        return 0
    left = bucket_line(env.bucket_place, env.bucket_shape, x0, 0)
    right = bucket_line(env.bucket_place, env.bucket_shape, x1, 0)
    top = bucket_line(env.bucket_place, env.bucket_shape, z0, 1)
    bottom = bucket_line(env.bucket_place, env.bucket_shape, z1, 1)
    count = 0
    for row in range(top, bottom + 1):
        for column in range(left, right + 1):
            bucket = row * env.bucket_shape[1] + column
            for i in range(env.bucket_start[bucket], env.bucket_start[bucket + 1]):
                o = env.bucket_item[i]
                if (
                    env.swept[o, 0] <= x1
                    and env.swept[o, 3] >= x0
                    and env.swept[o, 2] <= z1
                    and env.swept[o, 5] >= z0
                    and (env.forbidden[o] or env.swept[o, 4] > above)
                    and first_met(env.bucket_range, o, row, column, top, left)
                ):
                    if count < near.shape[0]:
                        near[count] = o
                    count += 1
    return count


@kernel
def meets_near(
    env: EnvironmentTable, near: Any, count: int, x: float, z: float, margin: float, height: float
) -> int:
    """Return 0 where no listed solid can matter to a foot at a place, 2 for a forbidden one.

    1 for others: within `margin` (m) of the bounds of its way in plan, and higher than `height`.
    """
    found = 0
    for i in range(count):
        o = near[i]
        if (
            x + margin >= env.swept[o, 0]
            and x - margin <= env.swept[o, 3]
            and z + margin >= env.swept[o, 2]
            and z - margin <= env.swept[o, 5]
        ):
            if env.forbidden[o]:
                return 2
            if env.swept[o, 4] > height:
                found = 1
    return found
