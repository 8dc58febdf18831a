"""Terrain made from a few numbers: hills, rocks, stairs, steps, a slope, trenches.

All lengths are metres and are keys, so that the same ground can be made for a fly or a dinosaur.
Everything climbs along +z, the way a creature faces, and lies about x = 0.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.environment.obstacles import LARGEST, SMALLEST, Obstacle
from polypod.environment.waves import waves
from polypod.errors import SceneError, choices

FloatArray = NDArray[np.float64]

MOST_SAMPLES_A_SIDE = 4096
MOST_BLOCKS = 20_000
STEEPEST = math.radians(80.0)


class Ground(NamedTuple):
    """What a generator makes: the parts of a `Terrain`."""

    heights: FloatArray  # [rows, columns]
    cell: float
    origin: tuple[float, float]
    parts: tuple[Obstacle, ...] = ()


class Endless(NamedTuple):
    """What a generator of ground without an end makes."""

    height_of: Callable[[FloatArray, FloatArray], FloatArray]  # of world x [N] and z [N], m
    cell: float


def hills(
    seed: int = 0, relief: float = 0.5, wavelength: float = 4.0, size: float = 64.0
) -> Ground:
    """Return smooth hills, a sum of cosines in random directions.

    Args:
        seed: of the random directions.
        relief: metres from the lowest to the highest point.
        wavelength: metres from hill to hill; the shortest waves are half as long.
        size: metres along each side, centred on the origin; samples lie wavelength / 20 apart.
    """
    cell = wavelength / 20.0
    axis = _axis("hills", size, cell)
    heights = waves(seed, wavelength, axis[None, :], axis[:, None])
    heights -= heights.min()
    return Ground(heights * (relief / max(float(heights.max()), 1e-300)), cell, (axis[0], axis[0]))


def endless_hills(seed: int = 0, relief: float = 0.5, wavelength: float = 4.0) -> Endless:
    """Return smooth hills without an end: those of `hills`, going on.

    Args:
        seed: of the random directions.
        relief: metres from the lowest to the highest point of a square of 16 wavelengths about the
            origin; farther off some are a little lower or higher.
        wavelength: metres from hill to hill; the shortest waves are half as long.
    """
    cell = wavelength / 20.0
    axis = _axis("endless-hills", 16.0 * wavelength, cell)
    heights = waves(seed, wavelength, axis[None, :], axis[:, None])
    lowest, share = float(heights.min()), relief / max(float(np.ptp(heights)), 1e-300)

    def height_of(x: FloatArray, z: FloatArray) -> FloatArray:
        return (waves(seed, wavelength, x, z) - lowest) * share

    return Endless(height_of, cell)


def rocks(
    seed: int = 0,
    diameter: float = 0.4,
    height: float = 0.08,
    share: float = 0.4,
    size: float = 16.0,
) -> Ground:
    """Return level ground strewn with smooth rounded rocks, half sunk in.

    Args:
        seed: of their places and sizes.
        diameter: metres, of the largest; the smallest have half of it.
        height: metres, of the highest; the lowest have half of it.
        share: in [0, 2], their summed area over the whole area.
        size: metres along each side, centred on the origin; samples lie diameter / 16 apart.
    """
    _within("rocks", "share", share, 0.0, 2.0)
    cell = diameter / 16.0
    axis = _axis("rocks", size, cell)
    count = round(share * size * size / (math.pi * (0.375 * diameter) ** 2))
    _within("rocks", "number of rocks", count, 0, MOST_BLOCKS)
    random = np.random.default_rng(seed)
    place = random.uniform(-0.5 * size, 0.5 * size, (count, 2))
    radius = 0.5 * diameter * random.uniform(0.5, 1.0, count)
    top = height * random.uniform(0.5, 1.0, count)
    heights = np.zeros((len(axis), len(axis)))
    for (x, z), reach, rise in zip(place, radius, top, strict=True):
        columns = slice(*np.searchsorted(axis, (x - reach, x + reach)))
        lines = slice(*np.searchsorted(axis, (z - reach, z + reach)))
        off = (axis[None, columns] - x) ** 2 + (axis[lines, None] - z) ** 2
        dome = rise * np.maximum(1.0 - off / (reach * reach), 0.0) ** 2
        heights[lines, columns] = np.maximum(heights[lines, columns], dome)
    return Ground(heights, cell, (axis[0], axis[0]))


def stairs(
    rise: float = 0.1,
    run: float = 0.3,
    count: int = 10,
    width: float = 6.0,
    start: float = 1.0,
    landing: float = 3.0,
    down: bool = False,
) -> Ground:
    """Return a flight of stairs of boxes, so that every riser is exactly vertical.

    Args:
        rise: metres, of each riser.
        run: metres, of each tread.
        count: risers.
        width: metres, across.
        start: z of the first riser, metres.
        landing: metres, length of the top step; behind it the ground stays at its height for ever.
        down: instead, as many steps lead down again behind the landing, to ground at 0.
    """
    _within("stairs", "count", count, 1, MOST_BLOCKS // 2)
    top = rise * count
    riser = start + run * (count - 1)
    # A box reaches on under the next one, so that a point behind a riser is deep inside something.
    spans = [(start + run * i, start + run * min(i + 2, count), i + 1) for i in range(count - 1)]
    spans.append((riser, riser + landing, count))
    if down:
        spans += [
            (2.0 * riser + landing - b, 2.0 * riser + landing - a, n) for a, b, n in spans[-2::-1]
        ]
    parts = []
    for i, (first, last, level) in enumerate(spans):
        size = (width, rise * (level + 1), last - first)
        centre = (0.0, 0.5 * rise * (level - 1), 0.5 * (first + last))
        parts.append(Obstacle.box(size, centre, name=f"stair-{i + 1}"))
    if down:
        return Ground(np.zeros((2, 2)), 1.0, (0.0, 0.0), tuple(parts))
    # The ground climbs hidden inside the landing.
    cell = landing / 3.0
    heights = np.array([[0.0, 0.0], [top, top]])
    return Ground(heights, cell, (0.0, riser + cell), tuple(parts))


def steps(
    seed: int = 0,
    rise: float = 0.1,
    run: float = 0.5,
    size: float = 8.0,
    start: float = 1.0,
) -> Ground:
    """Return a square pavement of upright blocks whose tops lie at random heights.

    Args:
        seed: of the heights.
        rise: metres, of the highest top above the ground around.
        run: metres, side of a block.
        size: metres along each side of the pavement, rounded to whole blocks.
        start: z where the pavement begins, metres.
    """
    count = max(1, round(size / run))
    _within("steps", "number of blocks", count * count, 1, MOST_BLOCKS)
    top = rise * np.random.default_rng(seed).uniform(0.0, 1.0, (count, count))
    parts = []
    for row in range(count):
        for column in range(count):
            centre = (
                run * (column + 0.5 - 0.5 * count),
                0.5 * (top[row, column] - rise),
                start + run * (row + 0.5),
            )
            box_size = (run, rise + top[row, column], run)
            parts.append(Obstacle.box(box_size, centre, name=f"block-{row + 1}-{column + 1}"))
    return Ground(np.zeros((2, 2)), 1.0, (0.0, 0.0), tuple(parts))


def slope(angle: float = 0.35, length: float = 20.0, start: float = 1.0) -> Ground:
    """Return level ground, an even slope up along +z, and level ground again for ever.

    Args:
        angle: radians, within 80 degrees; below zero it leads down.
        length: metres in plan.
        start: z where it begins, metres.
    """
    _within("slope", "angle", angle, -STEEPEST, STEEPEST)
    rise = math.tan(angle) * length
    return Ground(np.array([[0.0, 0.0], [rise, rise]]), length, (0.0, start))


def trenches(
    seed: int = 0,
    narrowest: float = 0.05,
    widest: float = 0.2,
    apart: float = 1.0,
    depth: float = 1.0,
    count: int = 10,
    width: float = 20.0,
    start: float = 1.0,
) -> Ground:
    """Return level ground cut by trenches across the way, with vertical sides.

    Args:
        seed: of their widths and distances.
        narrowest: metres, the least width of a trench.
        widest: metres, the greatest.
        apart: metres of ground between two trenches; the least is half of it.
        depth: metres, down to their floor, which also lies beside the ground's width.
        count: trenches.
        width: metres, across.
        start: z of the first trench, metres.
    """
    _within("trenches", "count", count, 1, MOST_BLOCKS)
    _within("trenches", "widest", widest, narrowest, LARGEST)
    random = np.random.default_rng(seed)
    gap = random.uniform(narrowest, widest, count)
    ground = random.uniform(0.5 * apart, apart, count)
    # Where each trench begins and ends, along z.
    first = start + np.concatenate([[0.0], np.cumsum(gap + ground)[:-1]])
    last = first + gap
    cell = 0.5 * (float(last[-1]) - start)
    # The floor climbs to the ground hidden inside the first and the last slab.
    near, far = start - 2.0 * cell, float(last[-1]) + 2.0 * cell
    begins, ends = [near, *last], [*first, far]
    parts = []
    for i, (begin, end) in enumerate(zip(begins, ends, strict=True)):
        centre = (0.0, -0.5 * depth, 0.5 * float(begin + end))
        box_size = (width, depth, float(end - begin))
        parts.append(Obstacle.box(box_size, centre, name=f"ground-{i + 1}"))
    floor = np.zeros((7, 2))
    floor[1:6] = -depth
    return Ground(floor, cell, (0.0, near), tuple(parts))


GENERATORS: dict[str, Callable[..., Ground | Endless]] = {
    "hills": hills,
    "endless-hills": endless_hills,
    "stairs": stairs,
    "steps": steps,
    "rocks": rocks,
    "slope": slope,
    "trenches": trenches,
}
_ANY_SIGN = ("start", "angle")


def generate(generator: str, keys: Mapping[str, Any]) -> Ground | Endless:
    """Call a generator by name; raise SceneError for a wrong name, key or value."""
    if generator not in GENERATORS:
        raise SceneError(
            f"there is no terrain generator {generator!r}; there are {choices(GENERATORS)}"
        )
    defaults = generator_keys(generator)
    for key, value in keys.items():
        if key not in defaults:
            raise SceneError(
                f"the terrain generator {generator} has no key {key!r}; it has {choices(defaults)}"
            )
        _judge(generator, key, value, defaults[key])
    return GENERATORS[generator](**keys)


def generator_keys(generator: str) -> dict[str, Any]:
    """Return a generator's keys and their defaults."""
    parameters = inspect.signature(GENERATORS[generator]).parameters
    return {name: parameter.default for name, parameter in parameters.items()}


def _judge(generator: str, key: str, value: Any, default: Any) -> None:
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if isinstance(default, bool):
        if not isinstance(value, bool):
            raise SceneError(
                f"the terrain generator {generator} has {key} = {value!r}; it is true or false"
            )
    elif isinstance(default, int):
        if not whole:
            raise SceneError(
                f"the terrain generator {generator} has {key} = {value!r}; it is a whole number"
            )
        _within(generator, key, value, 0, 2**63 - 1)
    elif not (whole or isinstance(value, float | np.floating)):
        raise SceneError(f"the terrain generator {generator} has {key} = {value!r}; it is a number")
    elif key in _ANY_SIGN:
        _within(generator, key, value, -LARGEST, LARGEST)
    else:
        _within(generator, key, value, 0.0 if key == "share" else SMALLEST, LARGEST)


def _within(generator: str, key: str, value: float, least: float, greatest: float) -> None:
    if not least <= value <= greatest:
        raise SceneError(
            f"the terrain generator {generator} has {key} = {value:g}; "
            f"it must be from {least:g} to {greatest:g}"
        )


def _axis(generator: str, size: float, cell: float) -> FloatArray:
    """Return the sample coordinates of one side of a square about the origin."""
    count = round(size / cell) + 1
    if not 2 <= count <= MOST_SAMPLES_A_SIDE:
        raise SceneError(
            f"the terrain generator {generator} has size = {size:g} with samples {cell:g} m apart; "
            f"a side must have 2 to {MOST_SAMPLES_A_SIDE} samples: change size or the other lengths"
        )
    return np.asarray(cell * (np.arange(count) - 0.5 * (count - 1)), dtype=np.float64)
