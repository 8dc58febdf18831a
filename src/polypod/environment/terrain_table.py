"""A terrain becomes the arrays that kernels read: all of it, or pages for its tiles."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from polypod.environment.pages import NO_PAGE
from polypod.environment.terrain import Terrain
from polypod.environment.tiled import TiledTerrain


def whole(terrain: Terrain) -> dict[str, Any]:
    """Return the fields of an `EnvironmentTable` for a terrain that is in memory."""
    heights = _at_least_two(terrain.heights)
    wet = terrain.water if terrain.water is not None and terrain.wet else None
    edge = (0, 0, heights.shape[0] - 1, heights.shape[1] - 1)
    return {
        "heights": heights,
        "terrain_range": np.array([heights.min(), heights.max()]),
        "water": np.zeros((0, 0), np.bool_) if wet is None else _at_least_two(wet),
        "tile_shift": 0,
        **_place(terrain, edge),
        **_index(1),
    }


def paged(terrain: TiledTerrain) -> dict[str, Any]:
    """Return the fields for a terrain that is read tile by tile; nothing is read yet."""
    side = terrain.tile + 1
    first_row, first_column, last_row, last_column = (line // terrain.tile for line in terrain.edge)
    # One more than there are tiles: page 0 stays level.
    tiles = (last_row - first_row + 1) * (last_column - first_column + 1) + 1
    pages = min(terrain.page_count, tiles)
    shape = (pages * side, side)
    return {
        # Memory that nobody has written to yet takes none.
        "heights": np.zeros(shape),
        "terrain_range": np.array([-np.inf, np.inf]),
        "water": np.zeros(shape if terrain.wet else (0, 0), np.bool_),
        "tile_shift": terrain.tile.bit_length() - 1,
        **_place(terrain, terrain.edge),
        # Half empty, so that a search is short.
        **_index(1 << (2 * pages).bit_length()),
    }


def _at_least_two(samples: NDArray[Any]) -> NDArray[Any]:
    """Return samples [rows, columns] of which there are two along each axis, as kernels read."""
    for axis in (0, 1):
        samples = np.repeat(samples, 2, axis) if samples.shape[axis] == 1 else samples
    return np.ascontiguousarray(samples)


def _place(terrain: Terrain | TiledTerrain, edge: tuple[int, int, int, int]) -> dict[str, Any]:
    return {
        "terrain_place": np.array([terrain.origin[0], terrain.origin[1], terrain.cell]),
        "first_row": edge[0],
        "first_column": edge[1],
        "last_row": edge[2],
        "last_column": edge[3],
    }


def _index(slots: int) -> dict[str, Any]:
    return {
        "tile_key": np.zeros((slots, 2), np.int64),
        "tile_page": np.full(slots, NO_PAGE, np.int64),
        "missed": np.zeros(1, np.bool_),
    }
