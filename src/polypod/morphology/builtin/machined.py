"""Machined parts: turned on a lathe or milled from a bar, with edges to be seen."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from polypod.morphology.builtin.curves import FloatArray, frames
from polypod.morphology.builtin.shapes import LEFT, Patch, band_triangles, round_ring, sweep


def turned(
    start: ArrayLike,
    end: ArrayLike,
    runs: Sequence[Sequence[tuple[float, float]]],
    sides: int = 16,
    side: ArrayLike = LEFT,
) -> Patch:
    """Return a part as from a lathe: round about its axis, with sharp edges between its runs.

    Args:
        start: [3] where the axis begins, m.
        end: [3] where it ends, m.
        runs: each a smooth outline as (place, radius) from start to end; the place is 0 at `start`
            and 1 at `end`, the radius in metres. The first point is where the run before ended.
        sides: vertices around.
        side: the direction of "across".
    """
    origin, axis = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
    axis = axis - origin
    across, up = frames(np.stack([origin, origin + axis]), np.asarray(side, dtype=np.float64))
    ring = round_ring(sides)
    spokes = ring[:, :1] * across[0] + ring[:, 1:] * up[0]
    rows = np.array([row for run in runs for row in run])
    points = origin + rows[:, :1] * axis
    grid = np.arange(len(rows) * sides).reshape(len(rows), sides)
    first = np.cumsum([0, *(len(run) for run in runs)])
    triangles = [band_triangles(grid[a:b]) for a, b in pairwise(first.tolist())]
    return Patch(
        positions=(points[:, None, :] + rows[:, 1, None, None] * spokes).reshape(-1, 3),
        triangles=np.concatenate(triangles),
        centres=np.repeat(points, sides, axis=0),
        along=np.repeat(rows[:, 0], sides),
        height=np.tile(ring[:, 1], len(rows)),
    )


def beam(
    points: ArrayLike, keys: Sequence[Sequence[float]], side: ArrayLike = LEFT, cut: float = 0.3
) -> Patch:
    """Return a machined bar with chamfered edges, flat faces and flat ends.

    Args:
        points: [2, 3] the line it follows, m.
        keys: rows of the place on that line (0 to 1), then half widths: across and up.
        side: the direction of "across".
        cut: part of a half width that the chamfer takes.
    """
    start, end = np.asarray(points, dtype=np.float64)
    table = np.array(keys, dtype=np.float64)
    centres = start + table[:, :1] * (end - start)
    radii = table[:, [1, 2, 2]]
    return sweep(centres, radii, chamfered_ring(cut), side, table[:, 0], faceted=True)


def chamfered_ring(cut: float = 0.3) -> FloatArray:
    """Return a square [8, 2] of half size 1 with its corners cut off: a machined beam."""
    near = 1.0 - cut
    half = [(1.0, near), (near, 1.0), (-near, 1.0), (-1.0, near)]
    return np.array(half + [(-x, -y) for x, y in half])
