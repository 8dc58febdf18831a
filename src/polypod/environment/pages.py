"""Where a sample of the terrain lies in memory: in its place, or in the page of its tile.

A terrain that is too large to be held whole is held in pages: squares of samples, one for each tile
that somebody may look at, one below another in `heights`. A page holds one more row and column than
its tile has patches, so that the four samples about any place lie side by side in one page. Which
page a tile is in is found by hashing. `paging` fills them, between frames.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from polypod.compute import kernel

if TYPE_CHECKING:
    from polypod.environment.table import EnvironmentTable

NO_PAGE = -1
# Two large odd numbers: neighbouring tiles are far apart in the index.
ROW_FACTOR = 73856093
COLUMN_FACTOR = 19349663


@kernel
def stored(env: EnvironmentTable, row: int, column: int) -> tuple[int, int]:
    """Return row and column in `heights` and `water` of a sample of the terrain.

    The next samples along x and along z lie beside it there.
    """
    if env.tile_shift == 0:
        return row, column
    return in_page(env, row, column)


@kernel
def in_page(env: EnvironmentTable, row: int, column: int) -> tuple[int, int]:
    """Return where a sample lies in the pages.

    What no page holds is level ground at height 0, and is noted as missed.
    """
    tile_row = row >> env.tile_shift
    tile_column = column >> env.tile_shift
    last = env.tile_page.shape[0] - 1
    slot = (tile_row * ROW_FACTOR ^ tile_column * COLUMN_FACTOR) & last
    while env.tile_page[slot] != NO_PAGE:
        if env.tile_key[slot, 0] == tile_row and env.tile_key[slot, 1] == tile_column:
            tile = 1 << env.tile_shift
            first = env.tile_page[slot] * (tile + 1)
            return first + (row & (tile - 1)), column & (tile - 1)
        slot = (slot + 1) & last
    env.missed[0] = True
    return 0, 0
