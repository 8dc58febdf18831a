"""How long a stance may be: the way over the ground for which a leg reaches its standing foot.

A walking foot need not leave from as far behind its rest place as it landed ahead: a heel that
rises lets the leg reach farther back, and hips lie ahead of or behind the feet. So the middle of a
stance is where both its ends are reached. An animal that strides farther than its legs reach from
the height at which it stands carries its body lower: so does this.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from polypod.compute import kernel
from polypod.controller.roll import HEEL_RISE, stride_share
from polypod.ik.reach import direction_strain
from polypod.ik.table import STANCE_END, TRAVEL_STEP
from polypod.ik.types import IkTable
from polypod.math.vec3 import Vec3
from polypod.morphology.types import FloatArray, LegTable
from polypod.reference import by_reference

# A striding body is at most so much lower than it stands, hip heights.
DEEPEST_SINK = 0.07
# And takes so many cycles to sink or rise.
SINK_CYCLES = 1.0
# A heel is up when its foot lifts, and not much earlier: so much of its rise counts.
HEEL_COUNTED = 0.7
# A girdle is not turned as far as it gets at just the moment when a foot lands or lifts.
YAW_COUNTED = 0.95
# With more legs than these feet would come too near to each other, and stand low enough.
MOST_LEGS = 4


class StrideTable(NamedTuple):
    """What legs reach from the height at which the body stands, and from the lowest; S = 2."""

    travel: FloatArray  # [S, K] m, of the sole, forward
    centre: FloatArray  # [S, K] m, the stance's middle ahead of the rest place
    sideways: FloatArray  # [K] m, of the sole, whichever way the body goes
    yawed: FloatArray  # [K] m that a girdle which yaws by its feet adds to the way forward
    sink: float  # m by which the lowest height is lower


def make_stride_table(
    legs: LegTable, ik: IkTable, hip_height: float, girdle_yaw: float
) -> StrideTable:
    """Return how far the soles travel under a body that walks forward.

    `girdle_yaw` is how far the girdles of sprawling legs yaw to either side in a stride, rad.
    """
    count = len(legs.length)
    travel, centre = np.zeros((2, count)), np.zeros((2, count))
    kernel_ik = by_reference(ik)
    for k in range(count):
        risen = _heel_shift(legs, k)
        for row in range(2):
            deep = row * DEEPEST_SINK * hip_height if count <= MOST_LEGS else 0.0
            low = np.array([0.0, deep, 0.0])
            stance = ik.effector_stance[k] - ik.hip_rest[k] + low
            ahead = _reach_along(ik, kernel_ik, k, stance, 1.0)
            behind = _reach_along(ik, kernel_ik, k, stance + risen, -1.0)
            if count > MOST_LEGS:
                ahead = behind = min(ahead, behind)
            travel[row, k] = ahead + behind
            centre[row, k] = 0.5 * (ahead - behind)
    beside = np.where(legs.upright, 0.0, np.abs(legs.sole_stance[:, 0]))
    return StrideTable(
        travel,
        centre,
        ik.stance_travel_least,
        2.0 * YAW_COUNTED * math.sin(girdle_yaw) * beside,
        DEEPEST_SINK * hip_height,
    )


def _heel_shift(legs: LegTable, k: int) -> FloatArray:
    """Return the way [3] of a leg's effector when its heel has risen, body frame."""
    rise = HEEL_COUNTED * HEEL_RISE[int(legs.roll_kind[k])]
    y, z = (legs.point_rest[k, int(legs.joint_count[k])] - legs.roll_pivot[k])[1:]
    sine, cosine = math.sin(rise), math.cos(rise)
    return np.array([0.0, y * cosine - z * sine - y, y * sine + z * cosine - z])


def _reach_along(ik: IkTable, kernel_ik: IkTable, k: int, offset: FloatArray, sign: float) -> float:
    """Return how far an effector gets forward or backward from an offset from its hip, m."""
    step = TRAVEL_STEP * float(ik.chain_length[k])
    way = 0.0
    while _reaches(ik, kernel_ik, k, offset + np.array([0.0, 0.0, sign * (way + step)])):
        way += step
    return way


def _reaches(ik: IkTable, kernel_ik: IkTable, k: int, offset: FloatArray) -> bool:
    size = float(np.linalg.norm(offset))
    if not ik.shortest[k] <= size <= STANCE_END * ik.longest[k]:
        return False
    return bool(direction_strain(kernel_ik, k, Vec3(*offset.tolist())) <= 1.0)


@kernel
def travel_limit(row: int, direction: float, yaw: float, stride: Any) -> float:
    """Return how far every leg lets its foot travel under the body while it stands, m.

    From the height at which the body stands (`row` 0) or the lowest (1); `direction` is the
    travel's, rad from straight ahead, `yaw` how much girdles yaw by their feet, 1: as animals' do.
    """
    sideways = abs(math.sin(direction))
    limit = math.inf
    for k in range(stride.sideways.shape[0]):
        travel = stride.travel[row, k] + yaw * stride.yawed[k]
        travel += sideways * (stride.sideways[k] - travel)
        limit = min(limit, travel)
    return limit


@kernel
def stance_seconds(c: int, k: int, state: Any) -> float:
    """Return how long a foot will stand once it has landed; 0 where nobody walks."""
    if state.cycle_rate[c] <= 0.0:
        return 0.0
    return float((1.0 - state.goal_extent[c, k]) / state.cycle_rate[c])


@kernel
def stance_centre(c: int, k: int, way: float, state: Any, tables: Any) -> float:
    """Return how far ahead of the rest place the middle of a stance is, m.

    `way` is what the body goes forward meanwhile, m; who stands has its feet at their rest places.
    """
    low = state.sink[c] / tables.stride.sink
    high = tables.stride.centre[0, k]
    centre: float = high + low * (tables.stride.centre[1, k] - high)
    return centre * stride_share(way, tables.legs.length[k])
