"""Fills the pages of a tiled terrain with the tiles about the creatures; drops the oldest ones."""

from __future__ import annotations

import numpy as np

from polypod.environment.lattice import BoolArray, FloatArray, IntArray
from polypod.environment.pages import COLUMN_FACTOR, NO_PAGE, ROW_FACTOR
from polypod.environment.table import EnvironmentTable
from polypod.environment.tiled import TiledTerrain
from polypod.errors import SceneError


class Pager:
    """Which tiles are in memory, for one environment.

    What a tile holds depends on nothing but its place, so neither the order in which tiles come nor
    the pages that they are in matter to a walk.
    """

    def __init__(self, terrain: TiledTerrain, table: EnvironmentTable) -> None:
        self.terrain = terrain
        self.table = table
        self.made = 0  # tiles, from the start
        # Page 0 stays level: what is not there is read from it. Of the others, the least recently
        # used tile comes first.
        self._page: dict[tuple[int, int], int] = {}
        self._free = list(range(len(table.heights) // (terrain.tile + 1) - 1, 0, -1))
        self._most = len(self._free)
        self._spans = np.zeros((0, 4), np.int64)
        self._origin = np.array(terrain.origin)[::-1]
        self._first, self._last = np.array([terrain.edge[:2] * 2, terrain.edge[2:] * 2], float)

    @property
    def held(self) -> int:
        """How many tiles are in memory."""
        return len(self._page)

    def load(self, places: FloatArray, reach: FloatArray) -> None:
        """Have all tiles within reach [N] (m, along x and along z) of places [N, 2] (x, z).

        Raises:
            SceneError: they do not fit into the terrain's memory all at once, or its source gives
                what cannot be used.
        """
        self.table.missed[0] = False
        spans = self._spans_of(places, reach)
        if np.array_equal(spans, self._spans):
            return
        wanted = self._tiles_of(np.unique(spans, axis=0))
        for tile in wanted:
            page = self._page.pop(tile, None)
            if page is not None:
                self._page[tile] = page
        missing = [tile for tile in wanted if tile not in self._page]
        try:
            for tile in missing:
                self._fill(tile)
        finally:
            # Also where a source fails halfway: what is there is what the index says.
            if missing:
                self._index()
        self._spans = spans

    def _fill(self, tile: tuple[int, int]) -> None:
        """Make a tile, in a free page or in that of the tile least recently used."""
        heights, wet = self._make(tile)
        page = self._free.pop() if self._free else self._page.pop(next(iter(self._page)))
        side = self.terrain.tile + 1
        self.table.heights[page * side : (page + 1) * side] = heights
        if wet is not None:
            self.table.water[page * side : (page + 1) * side] = wet
        self._page[tile] = page

    def _spans_of(self, places: FloatArray, reach: FloatArray) -> IntArray:
        """Return first row, first column, last row and last column of tiles [N, 4]."""
        middle = (places[:, ::-1] - self._origin) / self.terrain.cell
        # Two samples more: the patch of the farthest place ends there.
        around = (reach / self.terrain.cell + 2.0)[:, None]
        ends = np.concatenate([middle - around, middle + around], axis=1)
        # In every frame: these are several times as fast as np.clip.
        ends = np.minimum(np.maximum(np.floor(ends), self._first), self._last)
        spans: IntArray = ends.astype(np.int64) >> self.table.tile_shift
        return spans

    def _tiles_of(self, spans: IntArray) -> list[tuple[int, int]]:
        """Return rows and columns of the tiles in spans, each once, in order."""
        wanted: set[tuple[int, int]] = set()
        for first_row, first_column, last_row, last_column in spans.tolist():
            one = (last_row - first_row + 1) * (last_column - first_column + 1)
            if one <= self._most:
                wanted |= {
                    (row, column)
                    for row in range(first_row, last_row + 1)
                    for column in range(first_column, last_column + 1)
                }
            if max(one, len(wanted)) > self._most:
                self._refuse(max(one, len(wanted)))
        return sorted(wanted)

    def _refuse(self, count: int) -> None:
        terrain = self.terrain
        # One page is that of what is not there.
        needed = terrain.memory * (count + 1) / terrain.page_count
        raise SceneError(
            f"{terrain.name}: the creatures need {count} tiles at once, or more, and its memory of "
            f"{terrain.memory:g} MiB has room for {self._most}; give it at least {needed:.0f} MiB"
        )

    def _make(self, tile: tuple[int, int]) -> tuple[FloatArray, BoolArray | None]:
        """Return the heights [side, side] of a tile and which of its samples are water."""
        terrain = self.terrain
        side = np.arange(terrain.tile + 1)
        first_row, first_column, last_row, last_column = terrain.edge
        row = np.clip(tile[0] * terrain.tile + side, first_row, last_row)
        column = np.clip(tile[1] * terrain.tile + side, first_column, last_column)
        rows, columns = (axis.ravel() for axis in np.meshgrid(row, column, indexing="ij"))
        shape = (len(side), len(side))
        self.made += 1
        heights = terrain.samples_at(rows, columns).reshape(shape)
        wet = terrain.wet_at(rows, columns).reshape(shape) if terrain.wet else None
        return heights, wet

    def _index(self) -> None:
        """Write the index of the pages anew."""
        slots = len(self.table.tile_page)
        pages: list[int] = [NO_PAGE] * slots
        keys: list[tuple[int, int]] = [(0, 0)] * slots
        for (row, column), page in self._page.items():
            slot = (row * ROW_FACTOR ^ column * COLUMN_FACTOR) & (slots - 1)
            while pages[slot] != NO_PAGE:
                slot = (slot + 1) & (slots - 1)
            pages[slot] = page
            keys[slot] = (row, column)
        self.table.tile_page[:] = pages
        self.table.tile_key[:] = keys
