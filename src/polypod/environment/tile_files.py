"""Heights too many for memory, in files: one mapped .npy, or one .npy for each tile."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polypod.environment import heightmaps
from polypod.environment.lattice import IntArray
from polypod.environment.tiled import MEMORY, TILE, SampleFunction, TiledTerrain
from polypod.errors import SceneError

MOST_FILES = 1_000_000
OPEN_FILES = 64  # at a time: systems allow a few hundred
NUMBER = r"(?P<{}>-?\d+)"


def from_mapped(
    path: str | Path,
    heights: NDArray[Any],
    cell: float,
    origin: Sequence[float],
    water: str | Path | None,
    memory: float = MEMORY,
) -> TiledTerrain:
    """Return the terrain of a mapped array of heights [rows, columns], read where it is needed.

    `water` is a .npy of as many samples, mapped too: what is not 0 is water.
    """
    wet_of = None
    if water is not None:
        if Path(water).suffix.lower() != ".npy":
            raise SceneError(
                f"{water}: the mask of a heightmap that is not read at once must be a .npy"
            )
        mask = _mapped(water)
        if mask.shape != heights.shape:
            raise SceneError(f"{water}: a water mask must have as many samples as the heightmap")
        wet_of = _gather(mask, nonzero=True)
    x, z = origin
    last = (heights.shape[0] - 1, heights.shape[1] - 1)
    return TiledTerrain(
        _gather(heights), cell, (float(x), float(z)), (0, 0, *last), wet_of, memory=memory,
        name=str(path),
    )  # fmt: skip


def from_tiles(
    pattern: str | Path,
    cell: float,
    origin: Sequence[float] = (0.0, 0.0),
    shared: bool = True,
    water: str | Path | None = None,
    memory: float = MEMORY,
) -> TiledTerrain:
    """Return the terrain of many .npy files; see `Terrain.from_tiles`."""
    tiles = _TileFiles(Path(pattern), shared)
    wet_of: SampleFunction | None = None
    if water is not None:
        masks = _TileFiles(Path(water), shared)
        if (masks.side, masks.bounds) != (tiles.side, tiles.bounds):
            raise SceneError(
                f"{water}: the tiles of water must be as many and as large as {pattern}"
            )
        wet_of = masks.wet_at
    x, z = origin
    return TiledTerrain(
        tiles.samples_at, cell, (float(x), float(z)), tiles.bounds, wet_of,
        tile=TILE, memory=memory, name=str(pattern),
    )  # fmt: skip


class _TileFiles:
    """Square .npy files of one size, that fill a rectangle of tiles."""

    def __init__(self, pattern: Path, shared: bool) -> None:
        """Find the files and judge their number and the first one's size; raise SceneError."""
        self.pattern = pattern
        self.shared = shared
        self.files = _listed(pattern)
        rows, columns = zip(*self.files, strict=True)
        first_row, first_column = min(rows), min(columns)
        self.last_row, self.last_column = max(rows), max(columns)
        whole = (self.last_row - first_row + 1) * (self.last_column - first_column + 1)
        if whole > len(self.files):
            row, column = self._missing(first_row, first_column)
            raise SceneError(
                f"{pattern}: the tile of column {column}, row {row} is missing; "
                "the tiles must fill a rectangle"
            )
        first = _mapped(self.files[first_row, first_column])
        self.side = int(first.shape[0])
        # Neighbours that share their samples at the seam advance by one less.
        self.stride = self.side - 1 if shared else self.side
        if first.shape != (self.side, self.side) or self.stride < 1:
            raise SceneError(
                f"{self.files[first_row, first_column]}: a tile must be a square of at least "
                f"{2 if shared else 1} samples a side, not {_size(first)}"
            )
        extra = 0 if shared else -1
        self.bounds = (
            first_row * self.stride,
            first_column * self.stride,
            (self.last_row + 1) * self.stride + extra,
            (self.last_column + 1) * self.stride + extra,
        )
        self._open = lru_cache(OPEN_FILES)(self._opened)

    def _missing(self, first_row: int, first_column: int) -> tuple[int, int]:
        """Return row and column of the first tile that is not there."""
        return next(
            (row, column)
            for row in range(first_row, self.last_row + 1)
            for column in range(first_column, self.last_column + 1)
            if (row, column) not in self.files
        )

    def samples_at(self, row: IntArray, column: IntArray) -> NDArray[Any]:
        """Return the values [N] of samples [N]."""
        tile_row = np.minimum(row // self.stride, self.last_row)
        tile_column = np.minimum(column // self.stride, self.last_column)
        values = np.zeros(len(row))
        for i, j in np.unique(np.stack([tile_row, tile_column], axis=1), axis=0):
            here = (tile_row == i) & (tile_column == j)
            tile = self._open(int(i), int(j))
            values[here] = tile[row[here] - i * self.stride, column[here] - j * self.stride]
        return values

    def wet_at(self, row: IntArray, column: IntArray) -> NDArray[Any]:
        """Return which samples [N] are not 0."""
        return self.samples_at(row, column) != 0

    def _opened(self, row: int, column: int) -> NDArray[Any]:
        """Return a tile, judged; where tiles share samples, with those along its sides."""
        tile = self._mapped_tile(row, column)
        if self.shared:
            for beside, own, other in (
                ((row, column - 1), np.s_[:, 0], np.s_[:, -1]),
                ((row, column + 1), np.s_[:, -1], np.s_[:, 0]),
                ((row - 1, column), np.s_[0], np.s_[-1]),
                ((row + 1, column), np.s_[-1], np.s_[0]),
            ):
                if beside in self.files and not np.array_equal(
                    tile[own], self._mapped_tile(*beside)[other]
                ):
                    raise SceneError(
                        f"{self.files[row, column]}: its samples differ from those of "
                        f"{self.files[beside].name} along their common side; make them equal, or "
                        "say shared = false where tiles continue each other"
                    )
        return tile

    def _mapped_tile(self, row: int, column: int) -> NDArray[Any]:
        tile = _mapped(self.files[row, column])
        if tile.shape != (self.side, self.side):
            raise SceneError(
                f"{self.files[row, column]}: the tile has {_size(tile)} samples; all must have "
                f"{self.side} x {self.side}, as the first has"
            )
        return tile


def _listed(pattern: Path) -> dict[tuple[int, int], Path]:
    """Return the files of a pattern by row and column."""
    name = pattern.name
    if name.count("{column}") != 1 or name.count("{row}") != 1 or not name.endswith(".npy"):
        raise SceneError(
            f"{pattern}: tiles are named by a pattern with {{column}} and {{row}} in the name of "
            'the files, which are .npy: "ground/{column}_{row}.npy"'
        )
    word = re.escape(name)
    for key in ("column", "row"):
        word = word.replace(re.escape(f"{{{key}}}"), NUMBER.format(key))
    found: dict[tuple[int, int], Path] = {}
    try:
        files = sorted(pattern.parent.iterdir())
    except OSError as error:
        raise SceneError(f"{pattern}: no tiles can be read ({error.strerror or error})") from None
    for file in files:
        match = re.fullmatch(word, file.name)
        if match is None:
            continue
        place = int(match["row"]), int(match["column"])
        if place in found:
            raise SceneError(f"{file}: it is the same tile as {found[place].name}")
        found[place] = file
    if not 0 < len(found) <= MOST_FILES:
        raise SceneError(
            f"{pattern}: there are {len(found)} such files; there must be 1 to {MOST_FILES}"
        )
    return found


def _mapped(path: str | Path) -> NDArray[Any]:
    """Return a two-dimensional .npy file of numbers or truth values, mapped."""
    values = heightmaps.read_npy(path)
    if values.ndim != 2 or values.size == 0:
        raise SceneError(
            f"{path}: samples must have shape [rows, columns], not {list(values.shape)}"
        )
    return values


def _size(values: NDArray[Any]) -> str:
    return " x ".join(map(str, values.shape))


def _gather(values: NDArray[Any], nonzero: bool = False) -> SampleFunction:
    if nonzero:
        return lambda row, column: values[row, column] != 0
    return lambda row, column: values[row, column]
