"""The obstacles' map and the elevations map around a creature (P1 section 4, Figures 10 to 12).

A map is a window of n x n cells. Rows run along +z and columns along +x, as in a heightmap. Each
obstacle is grown by the foot's rectangle at its orientation (Figure 12) and rasterised exactly: a
cell is touched if and only if the grown footprint overlaps the cell's square. The terrain is not
grown: a foot tilts with the ground, but not with the side of a crate.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polypod.compute import kernel
from polypod.environment.elevation import fill_terrain, fill_water
from polypod.environment.grown import fill_obstacles
from polypod.environment.halfplanes import SIDE_COLUMNS, TOP_COLUMNS
from polypod.environment.obstacles import MOST_HULL_POINTS
from polypod.environment.table import BoolArray, EnvironmentTable, FloatArray, IntArray

MOST_SIDES = 2 * MOST_HULL_POINTS  # of a footprint, and planes of a hull
# The chamfer counts in whole numbers, which is three times as fast: a step, and a diagonal one.
STEP, DIAGONAL = 5, 7


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
    kind: IntArray  # [N, N] KIND_... of `grown`: for display
    column: IntArray  # [N + 1] scratch
    fraction: FloatArray  # [N + 1] scratch
    line: FloatArray  # [2, N] scratch
    jump: FloatArray  # [N, N] scratch: the difference of heights that makes a cell an edge
    sides: FloatArray  # [MOST_SIDES + 8, SIDE_COLUMNS] scratch
    tops: FloatArray  # [MOST_SIDES, TOP_COLUMNS] scratch
    turned_corners: FloatArray  # [MOST_SIDES, 2] scratch: of a solid that turns
    turned_sides: FloatArray  # [MOST_SIDES, 3] scratch
    turned_planes: FloatArray  # [MOST_SIDES, 4] scratch
    steps: IntArray  # [N + 2, N + 2] scratch


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
        jump=np.zeros((n, n)),
        sides=np.zeros((MOST_SIDES + 8, SIDE_COLUMNS)),
        tops=np.zeros((MOST_SIDES, TOP_COLUMNS)),
        turned_corners=np.zeros((MOST_SIDES, 2)),
        turned_sides=np.zeros((MOST_SIDES, 3)),
        turned_planes=np.zeros((MOST_SIDES, 4)),
        steps=np.zeros((n + 2, n + 2), np.int64),
    )


@kernel
def fill_maps(
    env: EnvironmentTable,
    window: LocalMap,
    centre_x: float,
    centre_z: float,
    cell: float,
    n: int,
    foot_half_x: float,
    foot_half_z: float,
    foot_yaw: float,
    ahead: float,
) -> None:
    """Fill the maps of n x n cells around a place, for one foot's shape and orientation.

    Args:
        env: the world.
        window: where to write; made for at least n cells a side.
        centre_x: world x of the window's centre, metres.
        centre_z: world z of the window's centre, metres.
        cell: side of a cell, metres.
        n: cells along each side.
        foot_half_x: half extent of the foot's rectangle along its own x, metres; 0 for a point.
        foot_half_z: half extent along its own z, metres.
        foot_yaw: turn of the rectangle about +Y from +Z toward +X, radians.
        ahead: seconds from now for which what moves is drawn on its way.
    """
    window.place[0] = centre_x - 0.5 * n * cell
    window.place[1] = centre_z - 0.5 * n * cell
    window.place[2] = cell
    window.size[0] = n
    fill_terrain(env, window)
    if env.water.shape[0] > 0:
        fill_water(env, window, foot_half_x, foot_half_z, foot_yaw)
    if env.bucket_shape[0] > 0:
        fill_obstacles(env, window, foot_half_x, foot_half_z, foot_yaw, ahead)
    _fill_edge_distance(window)


@kernel
def _fill_edge_distance(window: LocalMap) -> None:
    """Set each cell's distance to the nearest edge, in cells: two sweeps of a chamfer.

    A cell is an edge where its heights differ by more than its jump, or where no foot may stand.
    Without any edge all distances are n.
    """
    n = window.size[0]
    steps = window.steps  # cell [i, j] is steps[i + 1, j + 1]; the rim around saves asking
    far = STEP * n
    found = False
    for i in range(n + 2):
        steps[i, 0] = far
        steps[i, n + 1] = far
        steps[0, i] = far
        steps[n + 1, i] = far
    for i in range(n):
        for j in range(n):
            rise = window.highest[i, j] - window.lowest[i, j]
            edge = rise > window.jump[i, j] or window.forbidden[i, j] or window.wet[i, j]
            steps[i + 1, j + 1] = 0 if edge else far
            window.edge_distance[i, j] = n
            found = found or edge
    if not found:
        return
    for i in range(1, n + 1):
        for j in range(1, n + 1):
            above = min(steps[i - 1, j - 1], steps[i - 1, j + 1]) + DIAGONAL
            steps[i, j] = min(steps[i, j], min(above, steps[i - 1, j] + STEP))
        for j in range(1, n + 1):
            steps[i, j] = min(steps[i, j], steps[i, j - 1] + STEP)
    for i in range(n, 0, -1):
        for j in range(1, n + 1):
            below = min(steps[i + 1, j - 1], steps[i + 1, j + 1]) + DIAGONAL
            steps[i, j] = min(steps[i, j], min(below, steps[i + 1, j] + STEP))
        for j in range(n, 0, -1):
            steps[i, j] = min(steps[i, j], steps[i, j + 1] + STEP)
            window.edge_distance[i - 1, j - 1] = steps[i, j] * (1.0 / STEP)
