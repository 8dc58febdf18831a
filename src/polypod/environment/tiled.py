"""Ground without an end, or larger than memory: made tile by tile, where creatures are."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polypod.environment.lattice import BoolArray, FloatArray, IntArray, Lattice
from polypod.environment.obstacles import LARGEST, SMALLEST, Obstacle
from polypod.errors import SceneError

# Values [N] of samples, by their rows [N] and columns [N]; or of places, by their x [N] and z [N].
SampleFunction = Callable[[IntArray, IntArray], NDArray[Any]]
PlaceFunction = Callable[[FloatArray, FloatArray], NDArray[Any]]

ENDLESS = 1 << 40  # samples: beyond any place that a creature can be sent to
SMALLEST_TILE, LARGEST_TILE = 16, 1024  # patches along a side
LEAST_MEMORY, MOST_MEMORY = 1.0, 65536.0  # MiB
TILE = 64
MEMORY = 64.0
FEWEST_PAGES = 16


@dataclass(frozen=True, eq=False)
class TiledTerrain(Lattice):
    """A terrain whose samples are asked for when a creature comes near.

    Made by `Terrain.tiled` and its like. `samples_of` and `wet_of` give heights in metres, and
    what is water, by row and column; `tile` is the number of patches along the side of what is
    made at once, a power of two; `memory`, in MiB, is what all tiles together may take.
    """

    samples_of: SampleFunction
    cell: float
    origin: tuple[float, float] = (0.0, 0.0)
    bounds: tuple[int, int, int, int] = (-ENDLESS, -ENDLESS, ENDLESS, ENDLESS)
    wet_of: SampleFunction | None = None
    tile: int = TILE
    memory: float = MEMORY
    name: str = "the terrain"  # of the source, in errors
    parts: tuple[Obstacle, ...] = ()

    def __post_init__(self) -> None:
        """Judge the numbers; raise SceneError."""
        _judge(self.name, "cell", self.cell, SMALLEST, LARGEST, "metres between samples")
        _judge(self.name, "memory", self.memory, LEAST_MEMORY, MOST_MEMORY, "MiB for tiles")
        whole = isinstance(self.tile, int | np.integer) and not isinstance(self.tile, bool)
        if not (whole and SMALLEST_TILE <= self.tile <= LARGEST_TILE) or self.tile.bit_count() > 1:
            raise SceneError(
                f"{self.name} has tile = {self.tile!r}; it must be samples along a tile's side, "
                f"a power of two from {SMALLEST_TILE} to {LARGEST_TILE}"
            )
        judge_origin(self.name, self.origin)
        if self.bounds[2] <= self.bounds[0] or self.bounds[3] <= self.bounds[1]:
            raise SceneError(f"{self.name} has a single row of samples; it needs two at least")
        if self.page_count < FEWEST_PAGES:
            raise SceneError(
                f"{self.name} has memory = {self.memory:g} MiB for {self.page_count} tiles of "
                f"{self.tile} samples a side; it must be enough for {FEWEST_PAGES}: raise memory "
                "or lower tile"
            )

    @property
    def edge(self) -> tuple[int, int, int, int]:
        """First row, first column, last row and last column."""
        return self.bounds

    @property
    def wet(self) -> bool:
        """Whether there may be water anywhere."""
        return self.wet_of is not None

    @property
    def page_count(self) -> int:
        """How many tiles fit into the memory."""
        page = (self.tile + 1) ** 2 * (9 if self.wet else 8)
        return int(self.memory * 2**20) // page

    def samples_at(self, row: IntArray, column: IntArray) -> FloatArray:
        """Return the heights [N] of samples [N], m; raise SceneError where they are none."""
        given = self._asked(self.samples_of, "heights", row, column)
        if given.dtype.kind not in "fiu":
            raise SceneError(f"{self.name} gives {given.dtype} for heights; they must be numbers")
        heights = given.astype(np.float64)
        # Written so that NaN is refused too.
        bad = np.flatnonzero(~(np.abs(heights) <= LARGEST))
        if bad.size:
            x = self.origin[0] + self.cell * float(column[bad[0]])
            z = self.origin[1] + self.cell * float(row[bad[0]])
            raise SceneError(
                f"{self.name} has height {heights[bad[0]]:g} at x {x:g}, z {z:g}; "
                f"it must be a number within {LARGEST:g} m"
            )
        return heights

    def wet_at(self, row: IntArray, column: IntArray) -> BoolArray:
        """Return which samples [N] are water."""
        if self.wet_of is None:
            return np.zeros(len(row), np.bool_)
        given = self._asked(self.wet_of, "water", row, column)
        if given.dtype.kind not in "bfiu":
            raise SceneError(f"{self.name} gives {given.dtype} for water; it must be true or false")
        return np.asarray(given, np.bool_)

    def _asked(
        self, ask: SampleFunction, what: str, row: IntArray, column: IntArray
    ) -> NDArray[Any]:
        given = np.asarray(ask(row, column))
        if given.shape != row.shape:
            raise SceneError(
                f"{self.name} gives {what} of shape {list(given.shape)} for {len(row)} places; "
                "it must give one number for each"
            )
        return given


def from_function(
    height_of: PlaceFunction,
    cell: float,
    origin: Sequence[float] = (0.0, 0.0),
    water_of: PlaceFunction | None = None,
    tile: int = TILE,
    memory: float = MEMORY,
    name: str = "the terrain's function",
) -> TiledTerrain:
    """Return the terrain of functions of world places; see `Terrain.tiled`."""
    x0, z0 = origin

    def sampled(ask: PlaceFunction) -> SampleFunction:
        # The same numbers for a sample in whatever tile it is asked for: tiles meet exactly.
        return lambda row, column: ask(
            np.asarray(x0 + cell * column, np.float64), np.asarray(z0 + cell * row, np.float64)
        )

    for what, function in (("height_of", height_of), ("water_of", water_of)):
        if not (callable(function) or (function is None and what == "water_of")):
            raise SceneError(f"a tiled terrain has {what} = {function!r}; it must be a function")
    wet_of = None if water_of is None else sampled(water_of)
    terrain = TiledTerrain(
        sampled(height_of),
        cell,
        (float(x0), float(z0)),
        wet_of=wet_of,
        tile=tile,
        memory=memory,
        name=name,
    )
    # A function that gives nonsense is heard of here, and not in the middle of a walk.
    corners = np.array([0, 0, tile]), np.array([0, tile, 0])
    terrain.samples_at(*corners)
    terrain.wet_at(*corners)
    return terrain


def judge_origin(name: str, origin: Sequence[float]) -> None:
    """Refuse what is no place of a terrain's first sample; raise SceneError."""
    if len(origin) != 2 or not all(abs(o) <= LARGEST for o in origin):
        raise SceneError(
            f"{name} has origin = {list(origin)}; "
            f"it must be x and z of the first sample, within {LARGEST:g} m"
        )


def _judge(name: str, key: str, value: float, least: float, most: float, meaning: str) -> None:
    if not (isinstance(value, int | float | np.number) and least <= value <= most):
        raise SceneError(
            f"{name} has {key} = {value!r}; it must be {meaning}, from {least:g} to {most:g}"
        )
