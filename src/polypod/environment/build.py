"""Terrain and obstacles become the arrays that kernels read; done once for a static world."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from polypod.environment.convex import FloatArray, polygon_sides
from polypod.environment.obstacles import Obstacle
from polypod.environment.shapes import BOX, CYLINDER, SPHERE
from polypod.environment.table import EnvironmentTable, IntArray
from polypod.environment.terrain import Terrain
from polypod.environment.terrain_table import paged, whole
from polypod.environment.tiled import TiledTerrain

KIND_OF_SHAPE = {"box": BOX, "hull": BOX, "sphere": SPHERE, "cylinder": CYLINDER}
MOST_BUCKETS = 1 << 18
MOST_LISTED = 1 << 22  # obstacles, summed over the buckets
# Where things move: as many buckets as are quickly listed anew, and so many of an obstacle.
MOST_BUCKETS_MOVING = 1 << 10
MOST_LISTED_MOVING = 64


def build_table(
    terrain: Terrain | TiledTerrain, obstacles: Sequence[Obstacle], movable: bool = False
) -> EnvironmentTable:
    """Return the table of an environment at its start; each obstacle's solids are rows in turn.

    Where something moves, or is `movable`, `motion.list_obstacles` must be called before it is
    asked anything.
    """
    owned = [(i, solid) for i, obstacle in enumerate(obstacles) for solid in obstacle.solids()]
    owner = np.array([i for i, _ in owned], dtype=np.int64)
    solids = [solid for _, solid in owned]
    pivot = np.array([o.position for o in obstacles], dtype=np.float64).reshape(-1, 3)
    planes = [solid.planes() for solid in solids]
    outlines = [solid.footprint() for solid in solids]
    bounds = _bounds(solids)
    plane_table, plane_count = _padded(planes, 4)
    footprint, footprint_count = _padded(outlines, 2)
    sides, _ = _padded([polygon_sides(outline) for outline in outlines], 3)
    place, shape, start, item, spread = _buckets(bounds)
    movers = np.array([i for i, o in enumerate(solids) if o.moves or movable], dtype=np.int64)
    if len(movers):
        # Listed anew in every frame, in memory that is large enough for any of them.
        start = np.zeros(MOST_BUCKETS_MOVING + 1, np.int64)
        item = np.zeros(max(1, len(solids)) * MOST_LISTED_MOVING, np.int64)
    return EnvironmentTable(
        **(paged(terrain) if isinstance(terrain, TiledTerrain) else whole(terrain)),
        owner=owner,
        kind=np.array([KIND_OF_SHAPE[o.shape] for o in solids], dtype=np.int64),
        position=np.array([o.position for o in solids], dtype=np.float64).reshape(-1, 3),
        rotation=np.array([o.rotation for o in solids], dtype=np.float64).reshape(-1, 4),
        half_size=0.5 * np.array([o.size for o in solids], dtype=np.float64).reshape(-1, 3),
        forbidden=np.array([o.forbidden for o in solids], dtype=np.bool_),
        forbidden_count=sum(o.forbidden for o in solids),
        planes=plane_table,
        plane_count=plane_count,
        footprint=footprint,
        footprint_side=sides,
        footprint_count=footprint_count,
        bounds=bounds,
        radius=_radii(outlines, pivot[owner]),
        mover_count=len(movers),
        movers=movers,
        pivot=pivot,
        shift=np.zeros((len(obstacles), 3)),
        velocity=np.zeros((len(obstacles), 3)),
        turn_in=np.full(len(obstacles), np.inf),
        next_velocity=np.zeros((len(obstacles), 3)),
        step=np.zeros((len(obstacles), 3)),
        can_turn=movable or any(o.turn_rate != 0.0 for o in obstacles),
        yaw=np.zeros(len(obstacles)),
        yaw_rate=np.zeros(len(obstacles)),
        yaw_step=np.zeros(len(obstacles)),
        swept=bounds.copy(),
        bucket_place=place,
        bucket_shape=shape,
        bucket_start=start,
        bucket_item=item,
        bucket_range=np.ascontiguousarray(spread),
    )


def _padded(arrays: list[FloatArray], width: int) -> tuple[FloatArray, IntArray]:
    """Return arrays [n, width] of unequal n as one, and their n."""
    count = np.array([len(array) for array in arrays], dtype=np.int64)
    table = np.zeros((len(arrays), max(1, int(count.max(initial=0))), width))
    for i, array in enumerate(arrays):
        table[i, : len(array)] = array
    return table, count


def _bounds(solids: Sequence[Obstacle]) -> FloatArray:
    """Return least and greatest x, y, z [S, 6]: exact but for cylinders, around which they lie."""
    bounds = np.zeros((len(solids), 6))
    for o, solid in enumerate(solids):
        if solid.shape == "sphere":
            centre, radius = np.array(solid.position), 0.5 * solid.size[0]
            bounds[o] = np.concatenate([centre - radius, centre + radius])
        else:
            corners = solid.corners()
            bounds[o] = np.concatenate([corners.min(axis=0), corners.max(axis=0)])
        # A point on the rim belongs to the solid whichever way its coordinates were rounded.
        slack = 1e-9 * (bounds[o, 3:] - bounds[o, :3])
        bounds[o, :3] -= slack
        bounds[o, 3:] += slack
    return bounds


def _radii(outlines: list[FloatArray], pivot: FloatArray) -> FloatArray:
    """Return how far outlines [V, 2] reach from their pivots [S, 3] in plan, with some slack."""
    pairs = zip(outlines, pivot[:, [0, 2]], strict=True)
    reach = [float(np.linalg.norm(line - centre, axis=1).max()) for line, centre in pairs]
    return (1.0 + 1e-9) * np.array(reach, dtype=np.float64)


def _buckets(bounds: FloatArray) -> tuple[FloatArray, IntArray, IntArray, IntArray, IntArray]:
    """Return the plan's buckets (place, shape, start, item) and each obstacle's range of them.

    A bucket is about half as wide as the typical obstacle is narrow, so that a point's bucket lists
    little that does not cover the point.
    """
    if len(bounds) == 0:
        empty = np.zeros(0, np.int64)
        spread = np.zeros((0, 4), np.int64)
        return (
            np.array([0.0, 0.0, 1.0]),
            np.zeros(2, np.int64),
            np.zeros(1, np.int64),
            empty,
            spread,
        )
    least, greatest = bounds[:, [0, 2]], bounds[:, [3, 5]]
    corner, extent = least.min(axis=0), np.ptp(np.concatenate([least, greatest]), axis=0)
    side = 0.5 * float(np.median(np.min(greatest - least, axis=1)))
    side = max(side, math.sqrt(extent[0] * extent[1] / MOST_BUCKETS), float(extent.max()) / 4096.0)
    while True:
        spread = np.floor((bounds[:, [2, 0, 5, 3]] - corner[[1, 0, 1, 0]]) / side).astype(np.int64)
        listed_count = np.sum(np.prod(spread[:, 2:] - spread[:, :2] + 1, axis=1))
        if listed_count <= MOST_LISTED:
            break
        side *= 2.0
    rows, columns = (spread[:, 2:].max(axis=0) + 1).tolist()
    lists: list[list[int]] = [[] for _ in range(rows * columns)]
    for o, (first_row, first_column, last_row, last_column) in enumerate(spread.tolist()):
        for row in range(first_row, last_row + 1):
            for column in range(first_column, last_column + 1):
                lists[row * columns + column].append(o)
    start = np.zeros(rows * columns + 1, np.int64)
    start[1:] = np.cumsum([len(listed) for listed in lists])
    item = np.array([o for listed in lists for o in listed], dtype=np.int64)
    place = np.array([corner[0], corner[1], side])
    return place, np.array([rows, columns], dtype=np.int64), start, item, spread
