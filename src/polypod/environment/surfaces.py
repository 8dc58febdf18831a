"""A mesh becomes ground: the highest surface over each sample of a regular lattice.

Triangles are cut into rows of samples and rows into samples, exactly and all at once in arrays of
bounded size: a mesh of a few vast triangles costs no more than one of many small ones.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from polypod.environment.heightmaps import MOST_SAMPLES, HeightField, filled
from polypod.environment.obstacles import LARGEST, SMALLEST
from polypod.environment.triangles import read_triangles
from polypod.errors import SceneError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

CELLS_A_SIDE = 1024  # of the longer side, where no cell is asked for
AT_ONCE = 1 << 18  # rows or samples in one array
MOST_COVERED = 2_000_000_000  # rows and samples, summed over the triangles: some minutes
ROUNDING = 1e-9  # cells: a sample on the edge between two triangles belongs to both
SLIVER = 1e-12  # of the square of the longest side: less area in plan is none


def read_mesh(path: str | Path, cell: float | None = None, scale: float = 1.0) -> HeightField:
    """Return the highest surface of a mesh, seen from above, at each sample of a lattice.

    The lattice begins at the mesh's least x and z and ends within a cell of its greatest. Samples
    over which there is no triangle are unknown. A vertical face cannot be seen from above.

    Args:
        path: an .obj, .glb or .gltf file, y up; of glTF, every node's triangles as the file poses
            them.
        cell: metres between samples; where omitted, the longer side has 1024 cells.
        scale: metres of one unit of the file.

    Returns:
        Heights, cell and origin in metres.

    Raises:
        SceneError: the file cannot be read, or it has no triangle that is seen from above, or too
            many samples.
    """
    path = Path(path)
    if not SMALLEST <= scale <= LARGEST:
        raise SceneError(f"{path}: scale = {scale:g} must be from {SMALLEST:g} to {LARGEST:g}")
    triangles = read_triangles(path, scale)
    return highest_surface(str(path), triangles, cell)


def highest_surface(place: str, triangles: FloatArray, cell: float | None) -> HeightField:
    """Return the highest of triangles [T, 3 corners, x y z] over each sample of a lattice.

    Args:
        place: the start of each error.
        triangles: in metres, y up.
        cell: metres between samples, None for 1024 cells along the longer side.

    Returns:
        The height field, unknown where there is no triangle.

    Raises:
        SceneError: no triangle lies over a sample, or there are too many samples.
    """
    least, cell, rows, columns = _lattice(place, triangles, cell)
    corners = (triangles - least) / cell
    corners[..., 1] = triangles[..., 1]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    twice_area = np.abs(first[:, 0] * second[:, 2] - first[:, 2] * second[:, 0])
    spread = np.ptp(corners[..., [0, 2]], axis=1)
    work = 0.5 * float(twice_area.sum()) + float(spread[:, 1].sum())
    if rows * columns > MOST_SAMPLES or work > MOST_COVERED:
        raise SceneError(
            f"{place}: {rows} x {columns} samples {cell:g} m apart are too many for "
            f"{len(triangles)} triangles; choose a larger cell"
        )
    heights = np.full(rows * columns, -np.inf)
    _raise_to(heights, corners[twice_area > SLIVER * spread.max(axis=1) ** 2], rows, columns)
    unknown = np.isneginf(heights).reshape(rows, columns)
    if bool(unknown.all()):
        raise SceneError(
            f"{place}: no triangle of the mesh lies over a sample; choose a cell smaller than "
            f"{cell:g}"
        )
    origin = (float(least[0]), float(least[2]))
    return filled(heights.reshape(rows, columns), cell, origin, unknown)


def _lattice(
    place: str, triangles: FloatArray, cell: float | None
) -> tuple[FloatArray, float, int, int]:
    """Return the least x, y, z of triangles, the cell, and rows and columns of samples."""
    least = triangles.reshape(-1, 3).min(axis=0, initial=np.inf)
    greatest = triangles.reshape(-1, 3).max(axis=0, initial=-np.inf)
    extent = (greatest - least)[[0, 2]]
    if not bool(np.all(extent > 0.0)):
        raise SceneError(f"{place}: the mesh has no triangle that can be seen from above")
    cell = max(float(extent.max()) / CELLS_A_SIDE, SMALLEST) if cell is None else cell
    if not SMALLEST <= cell <= LARGEST:
        raise SceneError(f"{place}: cell = {cell:g} must be from {SMALLEST:g} to {LARGEST:g}")
    columns, rows = (math.floor(side / cell + ROUNDING) + 1 for side in extent.tolist())
    return least, cell, rows, columns


def _raise_to(heights: FloatArray, corners: FloatArray, rows: int, columns: int) -> None:
    """Raise heights [rows * columns] to triangles [T, 3, column height row] that lie higher."""
    corners = np.take_along_axis(corners, np.argsort(corners[..., 2], axis=1)[..., None], axis=1)
    top = np.maximum(np.ceil(corners[:, 0, 2] - ROUNDING), 0).astype(np.int64)
    bottom = np.minimum(np.floor(corners[:, 2, 2] + ROUNDING), rows - 1).astype(np.int64)
    for owner, offset in _each(np.maximum(bottom - top + 1, 0)):
        row = top[owner] + offset
        start, end = _cut(corners[owner], row)
        left = np.maximum(np.ceil(start[:, 0] - ROUNDING), 0).astype(np.int64)
        right = np.minimum(np.floor(end[:, 0] + ROUNDING), columns - 1).astype(np.int64)
        width = end[:, 0] - start[:, 0]
        # A cut as thin as rounding is a wall: its top counts.
        thin = width <= ROUNDING
        start[thin, 1] = end[thin, 1] = np.maximum(start[thin, 1], end[thin, 1])
        slope = (end[:, 1] - start[:, 1]) / np.where(thin, 1.0, width)
        for cut, along in _each(np.maximum(right - left + 1, 0)):
            column = left[cut] + along
            off = np.clip(column - start[cut, 0], 0.0, width[cut])
            found = start[cut, 1] + slope[cut] * off
            np.maximum.at(heights, row[cut] * columns + column, found)


def _cut(corners: FloatArray, row: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return where rows [N] enter and leave triangles [N, 3, column height row].

    Corners are in the order of their rows. Each end is [N, column height], the first the one of
    the lesser column. An edge is always cut from its lesser row on, so that both of its triangles
    find the very same place.
    """
    low, middle, high = corners[:, 0], corners[:, 1], corners[:, 2]
    # A row may miss its triangle by a rounding.
    line = np.clip(row.astype(np.float64), low[:, 2], high[:, 2])
    before = (line < middle[:, 2])[:, None]
    long_side = _along(low, high, line)
    short_side = _along(np.where(before, low, middle), np.where(before, middle, high), line)
    swapped = (long_side[:, 0] > short_side[:, 0])[:, None]
    return np.where(swapped, short_side, long_side), np.where(swapped, long_side, short_side)


def _along(start: FloatArray, end: FloatArray, line: FloatArray) -> FloatArray:
    """Return [N, column height] where edges, from `start` to `end` [N, 3], meet lines [N]."""
    rise = end[:, 2] - start[:, 2]
    share = (line - start[:, 2]) / np.where(rise > 0.0, rise, 1.0)
    return start[:, :2] + share[:, None] * (end - start)[:, :2]


def _each(counts: IntArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Yield, some at a time, the owner and the number from 0 of each of `counts` [N] things."""
    ends = np.cumsum(counts)
    total = int(ends[-1]) if len(ends) else 0
    for start in range(0, total, AT_ONCE):
        thing = np.arange(start, min(start + AT_ONCE, total))
        owner = np.searchsorted(ends, thing, side="right")
        yield owner, thing - (ends - counts)[owner]
