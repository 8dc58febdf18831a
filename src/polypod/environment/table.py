"""The environment as kernels read it, and exact questions about it.

These queries use the true shapes and not the maps' cells, so that planners and audits agree on what
is inside and what is not. Everything is 2.5-dimensional where it concerns standing: what stands
highest over a point of the plan is the surface there.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.compute import kernel
from polypod.environment.buckets import bucket_at, bucket_line, first_met
from polypod.environment.pages import stored
from polypod.environment.placing import own_point, world_direction
from polypod.environment.shapes import (
    column_of,
    depth_inside,
    plan_distance,
    top_normal_of,
)
from polypod.math.vec3 import Vec3

if TYPE_CHECKING:
    from polypod.environment.lattice import Lattice

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
GROUND = -1  # the support of a foot that stands on the terrain


class EnvironmentTable(NamedTuple):
    """Terrain, and O obstacles of S convex solids; P planes and V corners are padded to the most.

    World metres. Most obstacles are one solid; a mesh is several that move as one. Obstacles that
    move keep their rows: `placing` says where those are at a moment.

    A vertical line meets only the solids listed in its bucket: bucket [r, c] of the plan holds
    `bucket_item[bucket_start[r * C + c] : bucket_start[r * C + c + 1]]`, in rising order.
    """

    heights: FloatArray  # [rows, columns] m; rows run along +z, columns along +x; or in pages
    terrain_place: FloatArray  # [3] x and z of sample [0, 0], metres between samples
    terrain_range: FloatArray  # [2] m: no sample is lower or higher; -inf, inf where in pages
    water: BoolArray  # like heights: no foot may stand here; [0, 0] where there is no water
    first_row: int  # the terrain's edges: it has samples from here
    first_column: int
    last_row: int  # to here; at least two along each axis
    last_column: int
    tile_shift: int  # where in pages, a tile has 2 ** this patches along each side; else 0
    tile_key: IntArray  # [T, 2] row and column of a tile: an index with open addressing
    tile_page: IntArray  # [T] in which it is, or NO_PAGE; T is a power of two
    missed: BoolArray  # [1] a sample was asked for that is in no page
    owner: IntArray  # [S] the obstacle of which each solid is (a part)
    kind: IntArray  # [S] BOX, SPHERE or CYLINDER
    position: FloatArray  # [S, 3] centre
    rotation: FloatArray  # [S, 4] x, y, z, w
    half_size: FloatArray  # [S, 3]
    forbidden: BoolArray  # [S]
    forbidden_count: int  # how many of them are: most places have none, and need not be asked
    planes: FloatArray  # [S, P, 4] outward normal n and offset d: inside where n . p <= d
    plane_count: IntArray  # [S] of a cylinder: a prism around it; of a sphere: 0
    footprint: FloatArray  # [S, V, 2] x, z: convex corners in plan, circumscribed for round shapes
    footprint_side: FloatArray  # [S, V, 3] outward normal x, z and offset of the side from corner v
    footprint_count: IntArray  # [S]
    bounds: FloatArray  # [S, 6] least x, y, z, then greatest x, y, z
    radius: FloatArray  # [S] m: how far in plan it reaches from its obstacle's pivot
    mover_count: int  # solids that move; they are the first rows of `movers`
    movers: IntArray  # [movers] which
    pivot: FloatArray  # [O, 3] an obstacle's position; it turns about the vertical through it
    shift: FloatArray  # [O, 3] how far each now is from where all the above has it
    velocity: FloatArray  # [O, 3] m/s, now
    turn_in: FloatArray  # [O] s until it takes another velocity, infinite where it keeps this one
    next_velocity: FloatArray  # [O, 3] m/s, from then on
    step: FloatArray  # [O, 3] by how much it moved in this frame
    can_turn: bool  # whether any of them ever turns: most places need not ask
    yaw: FloatArray  # [O] rad by which it is turned, about +Y from +Z toward +X
    yaw_rate: FloatArray  # [O] rad/s
    yaw_step: FloatArray  # [O] by how much it turned in this frame
    swept: FloatArray  # [S, 6] bounds of all that it will meet within the horizon
    bucket_place: FloatArray  # [3] x and z of the corner of bucket [0, 0], side of a bucket, m
    bucket_shape: IntArray  # [2] rows (along z), columns (along x)
    bucket_start: IntArray  # [rows * columns + 1]
    bucket_item: IntArray  # [items] solids
    bucket_range: IntArray  # [S, 4] first row, first column, last row, last column (inclusive)


class TiledTable(EnvironmentTable):
    """The table of a tiled terrain, with the terrain itself.

    Who looks at a whole walk, as pictures and reports do, asks `ground`: the pages hold only what
    is near the creatures now.
    """

    ground: Lattice


@kernel
def _patch(env: EnvironmentTable, x: float, z: float) -> tuple[int, int, float, float]:
    """Return where in `heights` the patch of terrain at (x, z) begins, and the place in it.

    The place goes from 0 to 1. Beyond the edge it is the nearest place at the edge.
    """
    u = (x - env.terrain_place[0]) / env.terrain_place[2]
    v = (z - env.terrain_place[1]) / env.terrain_place[2]
    u = min(max(u, float(env.first_column)), float(env.last_column))
    v = min(max(v, float(env.first_row)), float(env.last_row))
    column = min(math.floor(u), env.last_column - 1)
    row = min(math.floor(v), env.last_row - 1)
    at_row, at_column = stored(env, row, column)
    return at_row, at_column, u - column, v - row


@kernel
def ground_height(env: EnvironmentTable, x: float, z: float) -> float:
    """Return the terrain's height in metres, bilinear between its samples; no obstacles."""
    row, column, u, v = _patch(env, x, z)
    near = env.heights[row, column] * (1.0 - u) + env.heights[row, column + 1] * u
    far = env.heights[row + 1, column] * (1.0 - u) + env.heights[row + 1, column + 1] * u
    return float(near * (1.0 - v) + far * v)


@kernel
def ground_normal(env: EnvironmentTable, x: float, z: float) -> Vec3:
    """Return the terrain's unit normal; between two patches, that of the one further along x, z."""
    row, column, u, v = _patch(env, x, z)
    a = env.heights[row, column]
    b = env.heights[row, column + 1]
    c = env.heights[row + 1, column]
    d = env.heights[row + 1, column + 1]
    slope_x = ((b - a) * (1.0 - v) + (d - c) * v) / env.terrain_place[2]
    slope_z = ((c - a) * (1.0 - u) + (d - b) * u) / env.terrain_place[2]
    # Beyond the edge the ground is level across it.
    over_x = (x - env.terrain_place[0]) / env.terrain_place[2]
    over_z = (z - env.terrain_place[1]) / env.terrain_place[2]
    if over_x < env.first_column or over_x > env.last_column:
        slope_x = 0.0
    if over_z < env.first_row or over_z > env.last_row:
        slope_z = 0.0
    size = math.sqrt(1.0 + slope_x * slope_x + slope_z * slope_z)
    return Vec3(-slope_x / size, 1.0 / size, -slope_z / size)


@kernel
def surface(env: EnvironmentTable, x: float, z: float) -> tuple[float, int]:
    """Return the height of the highest surface at a plan point now, and what it is."""
    return surface_at(env, x, z, 0.0)


@kernel
def surface_at(env: EnvironmentTable, x: float, z: float, ahead: float) -> tuple[float, int]:
    """Return the height of the highest surface at a plan point `ahead` seconds from now.

    Also what it is: the index of an obstacle, or GROUND (-1). Between equals the ground wins, then
    the lower index.
    """
    height, solid = highest_at(env, x, z, ahead)
    return height, env.owner[solid] if solid >= 0 else GROUND


@kernel
def highest_at(env: EnvironmentTable, x: float, z: float, ahead: float) -> tuple[float, int]:
    """Return the height of the highest surface at a plan point, and its solid or GROUND."""
    height = ground_height(env, x, z)
    highest = GROUND
    bucket = bucket_at(env, x, z)
    if bucket >= 0:
        for i in range(env.bucket_start[bucket], env.bucket_start[bucket + 1]):
            o = env.bucket_item[i]
            own = own_point(env, env.owner[o], Vec3(x, 0.0, z), ahead)
            if (
                own.x >= env.bounds[o, 0]
                and own.x <= env.bounds[o, 3]
                and own.z >= env.bounds[o, 2]
                and own.z <= env.bounds[o, 5]
            ):
                top = column_of(env, o, own.x, own.z)[1] - own.y
                if top > height:
                    height = top
                    highest = o
    return height, highest


@kernel
def surface_normal(env: EnvironmentTable, x: float, z: float) -> Vec3:
    """Return the unit normal of the highest surface at a plan point now."""
    return surface_normal_at(env, x, z, 0.0)


@kernel
def surface_normal_at(env: EnvironmentTable, x: float, z: float, ahead: float) -> Vec3:
    """Return the unit normal of the highest surface at a plan point `ahead` seconds from now."""
    solid = highest_at(env, x, z, ahead)[1]
    if solid == GROUND:
        return ground_normal(env, x, z)
    own = own_point(env, env.owner[solid], Vec3(x, 0.0, z), ahead)
    normal = top_normal_of(env, solid, own.x, own.z)
    return world_direction(env, env.owner[solid], normal, ahead)


@kernel
def is_forbidden(env: EnvironmentTable, x: float, z: float, margin: float) -> bool:
    """Say whether a forbidden obstacle's footprint is within `margin` metres in plan now."""
    return is_forbidden_at(env, x, z, margin, 0.0)


@kernel
def is_forbidden_at(env: EnvironmentTable, x: float, z: float, margin: float, ahead: float) -> bool:
    """Say whether a forbidden footprint will be within `margin` m in plan `ahead` s from now."""
    if env.forbidden_count == 0:
        return False
    left = bucket_line(env.bucket_place, env.bucket_shape, x - margin, 0)
    right = bucket_line(env.bucket_place, env.bucket_shape, x + margin, 0)
    top = bucket_line(env.bucket_place, env.bucket_shape, z - margin, 1)
    bottom = bucket_line(env.bucket_place, env.bucket_shape, z + margin, 1)
    for row in range(top, bottom + 1):
        for column in range(left, right + 1):
            bucket = row * env.bucket_shape[1] + column
            for i in range(env.bucket_start[bucket], env.bucket_start[bucket + 1]):
                o = env.bucket_item[i]
                if not env.forbidden[o] or not first_met(
                    env.bucket_range, o, row, column, top, left
                ):
                    continue
                own = own_point(env, env.owner[o], Vec3(x, 0.0, z), ahead)
                if plan_distance(env, o, own.x, own.z) <= margin:
                    return True
    return False


@kernel
def is_wet(env: EnvironmentTable, x: float, z: float) -> bool:
    """Say whether a plan point lies in water: the terrain's nearest sample is marked so."""
    if env.water.shape[0] == 0:
        return False
    column = math.floor((x - env.terrain_place[0]) / env.terrain_place[2] + 0.5)
    row = math.floor((z - env.terrain_place[1]) / env.terrain_place[2] + 0.5)
    column = min(max(column, env.first_column), env.last_column)
    row = min(max(row, env.first_row), env.last_row)
    at_row, at_column = stored(env, row, column)
    return bool(env.water[at_row, at_column])


@kernel
def penetration(env: EnvironmentTable, point_world: Vec3) -> tuple[float, int]:
    """Return how deep a point is inside something now, in metres, and in what."""
    return penetration_at(env, point_world, 0.0)


@kernel
def penetration_at(env: EnvironmentTable, point_world: Vec3, ahead: float) -> tuple[float, int]:
    """Return how deep a point will be inside something `ahead` s from now; outside at most 0.

    In metres, and in what. In an obstacle it is the exact distance to its surface. In the terrain
    it is the distance to the plane that touches the ground right above: the vertical depth times
    the slope's cosine.
    """
    below = ground_height(env, point_world.x, point_world.z) - point_world.y
    depth = below * ground_normal(env, point_world.x, point_world.z).y
    support = GROUND
    bucket = bucket_at(env, point_world.x, point_world.z)
    if bucket >= 0:
        for i in range(env.bucket_start[bucket], env.bucket_start[bucket + 1]):
            o = env.bucket_item[i]
            inside = depth_inside(env, o, own_point(env, env.owner[o], point_world, ahead))
            if inside > depth:
                depth = inside
                support = env.owner[o]
    return depth, support
