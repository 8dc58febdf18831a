"""The path of a swinging foot: a 3D Hermite curve over its arc length, and the time profile on it.

P1 section 4 ends with "a 3D Hermite curve: this curve represents our 3D trajectory"; P1 section 5.2
moves the foot on it "at a constant speed". Real swings are bell-shaped, so both profiles are here.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.compute import kernel
from polypod.config import PROFILE_CONSTANT
from polypod.footprints.settings import StepRequest
from polypod.math.hermite import hermite, hermite_slope
from polypod.math.vec3 import Vec3, load_vec3

PATH_KNOTS = 32
HALVINGS = 8  # of the swing's time
# Above this start speed the bell would have to run backwards before it rests.
LARGEST_START_SPEED = 2.5


class PathRow(NamedTuple):
    """One foot's path, or (with leading axes) the paths of many; N is PATH_KNOTS.

    `progress` runs from 0 to 1 in proportion to arc length.
    """

    point: NDArray[np.float64]  # [..., N, 3] world, m
    tangent: NDArray[np.float64]  # [..., N, 3] world, m per unit of progress
    fraction: NDArray[np.float64]  # [..., N] progress at the knot, from 0 to 1
    count: NDArray[np.int64]  # type: ignore[assignment]  # [..., 1] knots in use, 0: no path
    length: NDArray[np.float64]  # [..., 1] m, arc length


def path_store(*shape: int) -> PathRow:
    """Return empty paths with the leading axes given: `path_store(creatures, feet)`."""
    return PathRow(
        np.zeros((*shape, PATH_KNOTS, 3)),
        np.zeros((*shape, PATH_KNOTS, 3)),
        np.zeros((*shape, PATH_KNOTS)),
        np.zeros((*shape, 1), dtype=np.int64),
        np.zeros((*shape, 1)),
    )


@kernel
def path_row(store: PathRow, creature: int, foot: int) -> PathRow:
    """Return one foot's path out of a store with axes [creature, foot]."""
    return PathRow(
        store.point[creature, foot],
        store.tangent[creature, foot],
        store.fraction[creature, foot],
        store.count[creature, foot],
        store.length[creature, foot],
    )


@kernel
def knot_before(fraction: Any, count: int, progress: float) -> int:
    """Return the knot that begins the piece holding `progress`, from 0 to count - 2."""
    low = 0
    high = count - 1
    while high - low > 1:
        middle = (low + high) // 2
        if fraction[middle] <= progress:
            low = middle
        else:
            high = middle
    return low


@kernel
def path_point(point: Any, tangent: Any, fraction: Any, count: int, progress: float) -> Vec3:
    """Return the point at `progress` in [0, 1] of arc length, exact at both ends; world, m."""
    if progress <= 0.0 or count < 2:
        return load_vec3(point[0])
    if progress >= 1.0:
        return load_vec3(point[count - 1])
    k = knot_before(fraction, count, progress)
    span = fraction[k + 1] - fraction[k]
    if span <= 0.0:
        return load_vec3(point[k])
    return hermite(
        load_vec3(point[k]),
        load_vec3(tangent[k]) * span,
        load_vec3(point[k + 1]),
        load_vec3(tangent[k + 1]) * span,
        (progress - fraction[k]) / span,
    )


@kernel
def path_velocity(point: Any, tangent: Any, fraction: Any, count: int, progress: float) -> Vec3:
    """Return the derivative with respect to progress; world, m per unit of progress."""
    if progress <= 0.0 or count < 2:
        return load_vec3(tangent[0])
    if progress >= 1.0:
        return load_vec3(tangent[count - 1])
    k = knot_before(fraction, count, progress)
    span = fraction[k + 1] - fraction[k]
    if span <= 0.0:
        return load_vec3(tangent[k])
    slope = hermite_slope(
        load_vec3(point[k]),
        load_vec3(tangent[k]) * span,
        load_vec3(point[k + 1]),
        load_vec3(tangent[k + 1]) * span,
        (progress - fraction[k]) / span,
    )
    return slope * (1.0 / span)


@kernel
def swing_progress(profile: int, time: float, start_speed: float) -> tuple[float, float]:
    """Return the progress at `time` of a swing, and its rate; both times and rates per swing.

    `start_speed` is the rate at time 0: 0 for a normal lift-off; after a replan, what keeps the
    velocity continuous. The bell is the quintic that starts with this rate and ends at rest, with
    no acceleration at either end; rates above 2.5 are taken as 2.5. P1's constant profile ignores
    it.
    """
    u = min(max(time, 0.0), 1.0)
    if profile == PROFILE_CONSTANT:
        return u, 1.0
    v = min(max(start_speed, 0.0), LARGEST_START_SPEED)
    c3 = 10.0 - 6.0 * v
    c4 = 8.0 * v - 15.0
    c5 = 6.0 - 3.0 * v
    progress = u * (v + u * u * (c3 + u * (c4 + u * c5)))
    rate = v + u * u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5))
    return progress, rate


@kernel
def swing_time(profile: int, progress: float, start_speed: float) -> float:
    """Return the time at which a swing has come so far; both are shares."""
    low = 0.0
    high = 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        reached, _ = swing_progress(profile, middle, start_speed)
        if reached < progress:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@kernel
def seconds_ahead(request: StepRequest, progress: float) -> float:
    """Return how many seconds from now a foot is at a share of its path, for what moves there.

    Obstacles are already where they are at the end of this frame, and feet where they were before.
    """
    time = swing_time(request.profile, progress, request.launch) * request.swing_seconds
    return max(time - request.frame_seconds, 0.0)


@kernel
def copy_path(source: PathRow, target: PathRow) -> None:
    """Write one path over another."""
    for k in range(PATH_KNOTS):
        for axis in range(3):
            target.point[k, axis] = source.point[k, axis]
            target.tangent[k, axis] = source.tangent[k, axis]
        target.fraction[k] = source.fraction[k]
    target.count[0] = source.count[0]
    target.length[0] = source.length[0]
