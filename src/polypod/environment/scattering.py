"""Many boxes at random places, each resting on the terrain."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from polypod.environment.obstacles import LARGEST, SMALLEST, Obstacle, three_numbers
from polypod.errors import SceneError

if TYPE_CHECKING:
    from polypod.environment.lattice import Lattice


def scatter(
    terrain: Lattice,
    count: int,
    area: Sequence[float],
    size: Sequence[Sequence[float]],
    seed: int,
    forbidden_share: float = 0.0,
    name: str = "crate",
) -> tuple[Obstacle, ...]:
    """Return `count` boxes at random places and turns, each resting on the terrain.

    Args:
        terrain: what they stand on: a box goes down to the lowest ground under it.
        count: how many.
        area: x0, z0, x1, z1 in metres: where their centres lie.
        size: the least and the greatest size, each x, y, z in metres.
        seed: of the random numbers; the same seed gives the same boxes.
        forbidden_share: share of the boxes, in [0, 1], that are forbidden (rounded to a count).
        name: what comes before the number in each name.

    Raises:
        SceneError: a number is out of range, or the least is above the greatest.
    """
    x0, z0, x1, z1 = (float(value) for value in area)
    least, greatest = np.array(three_numbers(size[0])), np.array(three_numbers(size[1]))
    if count < 0 or not 0.0 <= forbidden_share <= 1.0:
        raise SceneError(
            f"scatter asks for {count} obstacles with a forbidden share of {forbidden_share:g}; "
            "the count must be at least 0 and the share from 0 to 1"
        )
    ordered = x0 <= x1 and z0 <= z1 and bool(np.all(least <= greatest))
    if not ordered or max(abs(x0), abs(x1), abs(z0), abs(z1)) > LARGEST or least.min() < SMALLEST:
        raise SceneError(
            "scatter needs area = [x0, z0, x1, z1] with x0 <= x1 and z0 <= z1, "
            f"and size = [least, greatest] in that order, each at least {SMALLEST:g}"
        )
    random = np.random.default_rng(seed)
    sizes = random.uniform(least, greatest, (count, 3))
    places = random.uniform((x0, z0), (x1, z1), (count, 2))
    yaws = random.uniform(0.0, 2.0 * math.pi, count)
    forbidden = random.permutation(count) < round(forbidden_share * count)
    made = []
    for i in range(count):
        here = (places[i, 0], 0.0, places[i, 1])
        box = Obstacle.box(sizes[i], here, yaws[i], bool(forbidden[i]), f"{name}-{i + 1}")
        height = terrain.lowest_in(box.footprint()) + 0.5 * sizes[i, 1]
        made.append(
            Obstacle.box(sizes[i], (here[0], height, here[2]), yaws[i], box.forbidden, box.name)
        )
    return tuple(made)
