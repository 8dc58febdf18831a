"""The ground: a heightmap, bilinear between its samples, that goes on for ever at its edges.

A heightmap cannot hold a vertical face: between two samples it slopes. So the generators with
vertical faces (`stairs`, `steps`, `trenches`) put exact boxes on the ground: they are obstacles of
the terrain's own, listed in `parts`, and a foot beside a riser is beside a truly vertical face.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polypod.environment import generators, geotiff, heightmaps, surfaces, tile_files
from polypod.environment.heightmaps import MOST_SAMPLES
from polypod.environment.lattice import BoolArray, FloatArray, IntArray, Lattice
from polypod.environment.obstacles import LARGEST, Obstacle
from polypod.environment.tiled import (
    MEMORY,
    TILE,
    PlaceFunction,
    TiledTerrain,
    from_function,
    judge_origin,
)
from polypod.errors import SceneError


@dataclass(frozen=True, eq=False)
class Terrain(Lattice):
    """Heights in metres at the points of a square lattice.

    `heights` [rows, columns]: columns run along +x, rows along +z; `origin` is x, z of sample
    [0, 0] and `cell` the metres between samples. `water` [rows, columns] marks samples about which
    no foot may stand (each stands for the square of one cell around it), or is None. `parts` are
    solid pieces of the terrain with vertical faces.
    """

    heights: FloatArray
    cell: float
    origin: tuple[float, float] = (0.0, 0.0)
    water: BoolArray | None = None
    parts: tuple[Obstacle, ...] = ()

    def __post_init__(self) -> None:
        """Judge the numbers and make the arrays read-only; raise SceneError."""
        try:
            heights = np.array(self.heights, dtype=np.float64, order="C")
        except (TypeError, ValueError):
            raise SceneError("a terrain needs heights that are numbers") from None
        if heights.ndim != 2 or heights.size == 0:
            raise SceneError(
                f"a terrain needs heights of shape [rows, columns], not {list(heights.shape)}"
            )
        if heights.size > MOST_SAMPLES:
            raise SceneError(
                f"a terrain of {heights.shape[0]} x {heights.shape[1]} samples is too large; "
                f"the most is {MOST_SAMPLES} samples"
            )
        if not np.all(np.isfinite(heights)) or np.max(np.abs(heights)) > LARGEST:
            raise SceneError(
                f"a terrain has a height that is no number or not within {LARGEST:g} m"
            )
        if not (1e-6 <= self.cell <= LARGEST):
            raise SceneError(
                f"a terrain has cell = {self.cell:g}; "
                f"it must be the metres between samples, from 1e-06 to {LARGEST:g}"
            )
        judge_origin("a terrain", self.origin)
        heights.flags.writeable = False
        object.__setattr__(self, "heights", heights)
        if self.water is not None:
            water = np.array(self.water, dtype=np.bool_, order="C")
            if water.shape != heights.shape:
                raise SceneError(
                    f"a water mask of {' x '.join(map(str, water.shape))} samples does not fit a "
                    f"terrain of {heights.shape[0]} x {heights.shape[1]}: make them equal"
                )
            water.flags.writeable = False
            object.__setattr__(self, "water", water)

    @classmethod
    def flat(cls, height: float = 0.0) -> Terrain:
        """Return level ground that goes on for ever."""
        return cls(np.full((2, 2), height), 1.0)

    @classmethod
    def tiled(
        cls,
        height_of: PlaceFunction,
        cell: float,
        tile: int = TILE,
        *,
        origin: Sequence[float] = (0.0, 0.0),
        water_of: PlaceFunction | None = None,
        memory: float = MEMORY,
    ) -> TiledTerrain:
        """Return ground without an end, made tile by tile where creatures are.

        Args:
            height_of: from x [N] and z [N], world m, to heights [N], m. Each must follow from its
                own x and z alone: neighbouring tiles ask for the samples between them both.
            cell: metres between samples.
            tile: samples along the side of what is made at once, a power of two.
            origin: x, z of a sample.
            water_of: from x [N] and z [N] to where no foot may stand, [N].
            memory: MiB that all tiles together may take; who was not near for longest goes first.

        Raises:
            SceneError: a number is out of range, or what the function gives are no heights.
        """
        return from_function(height_of, cell, origin, water_of, tile, memory)

    @classmethod
    def from_tiles(
        cls,
        pattern: str | Path,
        cell: float,
        origin: Sequence[float] = (0.0, 0.0),
        shared: bool = True,
        water: str | Path | None = None,
        memory: float = MEMORY,
    ) -> TiledTerrain:
        """Return the terrain of many .npy files of heights in metres, read where creatures are.

        `pattern` is the files' path with `{column}` and `{row}` in the name: whole numbers, columns
        along +x and rows along +z; together they fill a rectangle. Sample [0, 0] of tile 0, 0 is
        at `origin`. With `shared`, neighbours both hold the samples along their common side.
        `water` is a pattern of as many files, where samples that are not 0 are water.
        """
        return tile_files.from_tiles(pattern, cell, origin, shared, water, memory)

    @classmethod
    def from_npy(
        cls,
        path: str | Path,
        cell: float,
        origin: Sequence[float] = (0.0, 0.0),
        water: str | Path | None = None,
        memory: float | None = None,
    ) -> Terrain | TiledTerrain:
        """Return the terrain whose heights in metres are a two-dimensional .npy file.

        A file too large to be held whole, or any with a `memory` in MiB, is read where creatures
        are; its water is a .npy too.
        """
        heights = heightmaps.read_npy(path)
        if memory is None and (heights.size <= MOST_SAMPLES or heights.ndim != 2):
            return _placed(path, heights, cell, origin, water)
        return tile_files.from_mapped(
            path, heights, cell, origin, water, MEMORY if memory is None else memory
        )

    @classmethod
    def from_png(
        cls,
        path: str | Path,
        cell: float,
        relief: float,
        origin: Sequence[float] = (0.0, 0.0),
        water: str | Path | None = None,
    ) -> Terrain:
        """Return the terrain of an 8- or 16-bit grey picture, `relief` metres from black to white.

        The picture's first row is the one of least z.
        """
        relief = heightmaps.judged_relief(path, relief)
        return _placed(path, heightmaps.read_grey(path) * relief, cell, origin, water)

    @classmethod
    def from_raw(
        cls,
        path: str | Path,
        format: str,
        cell: float,
        relief: float | None = None,
        rows: int | None = None,
        columns: int | None = None,
        origin: Sequence[float] = (0.0, 0.0),
        water: str | Path | None = None,
    ) -> Terrain:
        """Return the terrain of a file of bare samples: see `heightmaps.read_raw`."""
        heights = heightmaps.read_raw(path, format, relief, rows, columns)
        return _placed(path, heights, cell, origin, water)

    @classmethod
    def from_geotiff(
        cls,
        path: str | Path,
        origin: Sequence[float] = (0.0, 0.0),
        water: str | Path | None = None,
    ) -> Terrain:
        """Return the terrain of a GeoTIFF, whose pixels have their own size in metres.

        Samples without data lie at the lowest height, and no foot may stand there: they count as
        water. See `geotiff.read_geotiff`; it needs tifffile.
        """
        heights, cell, _, unknown = geotiff.read_geotiff(path)
        return _placed(path, heights, cell, origin, water, unknown)

    @classmethod
    def from_mesh(
        cls,
        path: str | Path,
        cell: float | None = None,
        scale: float = 1.0,
        origin: Sequence[float] | None = None,
        water: str | Path | None = None,
    ) -> Terrain:
        """Return the highest surface of an .obj, .glb or .gltf, y up: see `surfaces.read_mesh`.

        Without an origin the mesh stays where its file has it; else its least x and z are there.
        Samples under no triangle lie at the lowest height, and no foot may stand there.
        """
        heights, cell, place, unknown = surfaces.read_mesh(path, cell, scale)
        return _placed(path, heights, cell, place if origin is None else origin, water, unknown)

    @classmethod
    def hills(cls, seed: int = 0, **keys: float) -> Terrain:
        """Return rolling hills: see `generators.hills` for the keys."""
        return _finite("hills", seed=seed, **keys)

    @classmethod
    def endless_hills(cls, seed: int = 0, **keys: float) -> TiledTerrain:
        """Return rolling hills without an end: see `generators.endless_hills` for the keys."""
        made = generated("endless-hills", seed=seed, **keys)
        assert isinstance(made, TiledTerrain)  # as that generator's are
        return made

    @classmethod
    def rocks(cls, seed: int = 0, **keys: float) -> Terrain:
        """Return ground strewn with rounded rocks: see `generators.rocks` for the keys."""
        return _finite("rocks", seed=seed, **keys)

    @classmethod
    def stairs(cls, **keys: float) -> Terrain:
        """Return a flight of stairs up, along +z: see `generators.stairs` for the keys."""
        return _finite("stairs", **keys)

    @classmethod
    def steps(cls, seed: int = 0, **keys: float) -> Terrain:
        """Return a pavement of blocks of unequal height: see `generators.steps` for the keys."""
        return _finite("steps", seed=seed, **keys)

    @classmethod
    def slope(cls, angle: float, **keys: float) -> Terrain:
        """Return an even slope up, along +z, of `angle` radians: see `generators.slope`."""
        return _finite("slope", angle=angle, **keys)

    @classmethod
    def trenches(cls, seed: int = 0, **keys: float) -> Terrain:
        """Return level ground cut by trenches: see `generators.trenches` for the keys."""
        return _finite("trenches", seed=seed, **keys)

    @property
    def edge(self) -> tuple[int, int, int, int]:
        """First row, first column, last row and last column."""
        return 0, 0, self.heights.shape[0] - 1, self.heights.shape[1] - 1

    @property
    def wet(self) -> bool:
        """Whether there is water anywhere."""
        return self.water is not None and bool(np.any(self.water))

    def samples_at(self, row: IntArray, column: IntArray) -> FloatArray:
        """Return the heights [N] of samples [N], m."""
        return np.asarray(self.heights[row, column])

    def wet_at(self, row: IntArray, column: IntArray) -> BoolArray:
        """Return which samples [N] are water."""
        if self.water is None:
            return np.zeros(len(row), np.bool_)
        return np.asarray(self.water[row, column])

    def lowest_in(self, corners: FloatArray) -> float:
        """Return the lowest ground in a convex polygon [V, 2] (x, z), turning from +x toward +z."""
        if np.ptp(self.heights) == 0.0:
            return float(self.heights[0, 0])
        return super().lowest_in(corners)


def generated(generator: str, **keys: Any) -> Terrain | TiledTerrain:
    """Return a generated terrain; raise SceneError for a generator or a key that does not exist."""
    made = generators.generate(generator, keys)
    if isinstance(made, generators.Endless):
        return from_function(made.height_of, made.cell, name=f"the terrain generator {generator}")
    return Terrain(made.heights, made.cell, made.origin, None, made.parts)


def _finite(generator: str, **keys: Any) -> Terrain:
    made = generated(generator, **keys)
    assert isinstance(made, Terrain)  # the caller's generator has edges
    return made


def _placed(
    path: str | Path,
    heights: NDArray[Any],
    cell: float,
    origin: Sequence[float],
    water: str | Path | None,
    unknown: BoolArray | None = None,
) -> Terrain:
    """Return the terrain of a file; no foot may stand on water or where heights are unknown."""
    mask = None if water is None else heightmaps.read_grey(water) > 0.5
    if unknown is not None and mask is not None and mask.shape == unknown.shape:
        mask = mask | unknown
    elif unknown is not None and mask is None and bool(unknown.any()):
        mask = unknown
    try:
        return Terrain(heights, cell, tuple(float(o) for o in origin), mask)  # type: ignore[arg-type]
    except SceneError as error:
        raise SceneError(f"{path}: {error}") from None
