"""The ground: a heightmap, bilinear between its samples, that goes on for ever at its edges.

A heightmap cannot hold a vertical face: between two samples it slopes. So the generators with
vertical faces (`stairs`, `steps`, `trenches`) put exact boxes on the ground: they are obstacles of
the terrain's own, listed in `parts`, and a foot beside a riser is beside a truly vertical face.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polypod.environment import generators, geotiff, heightmaps, surfaces
from polypod.environment.heightmaps import MOST_SAMPLES, BoolArray, FloatArray
from polypod.environment.obstacles import LARGEST, Obstacle
from polypod.errors import SceneError


@dataclass(frozen=True, eq=False)
class Terrain:
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
        if len(self.origin) != 2 or not all(abs(o) <= LARGEST for o in self.origin):
            raise SceneError(
                f"a terrain has origin = {list(self.origin)}; "
                f"it must be x and z of the first sample, within {LARGEST:g} m"
            )
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
    def from_npy(
        cls,
        path: str | Path,
        cell: float,
        origin: Sequence[float] = (0.0, 0.0),
        water: str | Path | None = None,
    ) -> Terrain:
        """Return the terrain whose heights in metres are a two-dimensional .npy file."""
        return _placed(path, heightmaps.read_npy(path), cell, origin, water)

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
        return generated("hills", seed=seed, **keys)

    @classmethod
    def rocks(cls, seed: int = 0, **keys: float) -> Terrain:
        """Return ground strewn with rounded rocks: see `generators.rocks` for the keys."""
        return generated("rocks", seed=seed, **keys)

    @classmethod
    def stairs(cls, **keys: float) -> Terrain:
        """Return a flight of stairs up, along +z: see `generators.stairs` for the keys."""
        return generated("stairs", **keys)

    @classmethod
    def steps(cls, seed: int = 0, **keys: float) -> Terrain:
        """Return a pavement of blocks of unequal height: see `generators.steps` for the keys."""
        return generated("steps", seed=seed, **keys)

    @classmethod
    def slope(cls, angle: float, **keys: float) -> Terrain:
        """Return an even slope up, along +z, of `angle` radians: see `generators.slope`."""
        return generated("slope", angle=angle, **keys)

    @classmethod
    def trenches(cls, seed: int = 0, **keys: float) -> Terrain:
        """Return level ground cut by trenches: see `generators.trenches` for the keys."""
        return generated("trenches", seed=seed, **keys)

    def height_at(self, x: float, z: float) -> float:
        """Return the ground's height in metres, without the terrain's parts."""
        return float(self.heights_at(np.array([[x, z]]))[0])

    def heights_at(self, points: FloatArray) -> FloatArray:
        """Return the ground's heights [N] at plan points [N, 2] (x, z)."""
        rows, columns = self.heights.shape
        u = np.clip((points[:, 0] - self.origin[0]) / self.cell, 0, columns - 1)
        v = np.clip((points[:, 1] - self.origin[1]) / self.cell, 0, rows - 1)
        i, j = np.floor(v).astype(np.int64), np.floor(u).astype(np.int64)
        below, right = np.minimum(i + 1, rows - 1), np.minimum(j + 1, columns - 1)
        u, v = u - j, v - i
        first = self.heights[i, j] * (1 - u) + self.heights[i, right] * u
        second = self.heights[below, j] * (1 - u) + self.heights[below, right] * u
        return np.asarray(first * (1 - v) + second * v)

    def lowest_in(self, corners: FloatArray) -> float:
        """Return the lowest ground in a convex polygon [V, 2] (x, z), turning from +x toward +z.

        Between samples the ground is straight along x and along z, so it is lowest at a sample or
        on the outline; a straight line meets it in parabolas between the sample lines.
        """
        if np.ptp(self.heights) == 0.0:
            return float(self.heights[0, 0])
        ends = np.roll(corners, -1, axis=0)
        lowest = min(self._lowest_along(a, b) for a, b in zip(corners, ends, strict=True))
        rows, columns = self.heights.shape
        first = np.maximum(np.ceil((corners.min(axis=0) - self.origin) / self.cell), 0)
        last = np.floor((corners.max(axis=0) - self.origin) / self.cell)
        last = np.minimum(last, (columns - 1, rows - 1))
        axes = np.arange(first[0], last[0] + 1), np.arange(first[1], last[1] + 1)
        samples = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2).astype(np.int64)
        place = samples * self.cell + self.origin
        along = ends - corners
        left = (place[:, None, 1] - corners[:, 1]) * along[:, 0]
        left -= (place[:, None, 0] - corners[:, 0]) * along[:, 1]
        within = np.all(left >= 0.0, axis=1)
        found = self.heights[samples[within, 1], samples[within, 0]]
        return min(lowest, float(np.min(found, initial=np.inf)))

    def _lowest_along(self, start: FloatArray, end: FloatArray) -> float:
        """Return the lowest ground on a straight line in plan."""
        times = [np.array([0.0, 1.0])]
        for axis in (0, 1):
            one, other = sorted((start[axis], end[axis]))
            if other > one:
                first = math.ceil(max((one - self.origin[axis]) / self.cell, 0.0))
                limit = self.heights.shape[1 - axis] - 1
                last = math.floor(min((other - self.origin[axis]) / self.cell, limit))
                lines = np.arange(first, last + 1) * self.cell + self.origin[axis]
                times.append((lines - start[axis]) / (end[axis] - start[axis]))
        knots = np.unique(np.clip(np.concatenate(times), 0.0, 1.0))
        middles = 0.5 * (knots[:-1] + knots[1:])
        at_knots = self.heights_at(start + knots[:, None] * (end - start))
        at_middles = self.heights_at(start + middles[:, None] * (end - start))
        # height(s) = c + b s + a s^2 for s from 0 to 1 in each stretch.
        a = 2.0 * (at_knots[:-1] + at_knots[1:] - 2.0 * at_middles)
        b = at_knots[1:] - at_knots[:-1] - a
        valley = (a > 0.0) & (b < 0.0) & (-b < 2.0 * a)
        bottom = at_knots[:-1][valley] - b[valley] ** 2 / (4.0 * a[valley])
        return float(np.min(np.concatenate([at_knots, at_middles, bottom])))


def generated(generator: str, **keys: Any) -> Terrain:
    """Return a generated terrain; raise SceneError for a generator or a key that does not exist."""
    made = generators.generate(generator, keys)
    return Terrain(made.heights, made.cell, made.origin, None, made.parts)


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
