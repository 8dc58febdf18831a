"""The obstacles' map and the elevations map around a creature (P1 section 4, Figures 10 to 12).

A map is a window of n x n cells. Rows run along +z and columns along +x, as in a heightmap. Each
obstacle is grown by the foot's rectangle at its orientation (Figure 12) and rasterised exactly: a
cell is touched if and only if the grown footprint overlaps the cell's square. The terrain is not
grown: a foot tilts with the ground, but not with the side of a crate.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polypod.environment.table import BoolArray, FloatArray, IntArray

# What a cell holds, the colours of P1 Figure 11.
KIND_GROUND = 0
KIND_GROWN = 1  # only the growth by the foot reaches it
KIND_EDGE = 2
KIND_CORNER = 3
KIND_INSIDE = 4
KIND_FORBIDDEN = 5

MOST_SIDES = 64  # of a footprint


class LocalMap(NamedTuple):
    """One window's maps, written by `fill_maps` into [:n, :n]; [row along z, column along x].

    Cell [i, j] is the square from `place[:2] + cell * (j, i)` to `place[:2] + cell * (j+1, i+1)`.
    """

    place: FloatArray  # [3] x and z of the outer corner of cell [0, 0], cell; world m
    size: IntArray  # [1] n, the cells a side in use
    highest: FloatArray  # [N, N] m: the highest surface that a foot centred in the cell touches
    lowest: FloatArray  # [N, N] m: the lowest surface under such a foot
    forbidden: BoolArray  # [N, N] feet neither stand here nor pass over
    wet: BoolArray  # [N, N] water: feet do not stand here, but may pass over
    edge_distance: FloatArray  # [N, N] cells to the nearest edge or forbidden cell; 0 on it
    kind: IntArray  # [N, N] KIND_...: for display
    column: IntArray  # [N + 1] scratch
    fraction: FloatArray  # [N + 1] scratch
    line: FloatArray  # [2, N] scratch
    sides: FloatArray  # [MOST_SIDES + 8, 4] scratch


def make_local_map(n: int) -> LocalMap:
    """Return the memory for windows of up to n x n cells."""
    return LocalMap(
        place=np.zeros(3),
        size=np.zeros(1, np.int64),
        highest=np.zeros((n, n)),
        lowest=np.zeros((n, n)),
        forbidden=np.zeros((n, n), np.bool_),
        wet=np.zeros((n, n), np.bool_),
        edge_distance=np.zeros((n, n)),
        kind=np.zeros((n, n), np.int64),
        column=np.zeros(n + 1, np.int64),
        fraction=np.zeros(n + 1),
        line=np.zeros((2, n)),
        sides=np.zeros((MOST_SIDES + 8, 4)),
    )
