"""What moves, asked about by itself: feet that stand or swing near it ask often."""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.environment.placing import own_point, world_direction
from polypod.environment.shapes import depth_inside, way_out
from polypod.environment.table import EnvironmentTable
from polypod.math.vec3 import Vec3


@kernel
def mover_depth(env: EnvironmentTable, point_world: Vec3, ahead: float, own: int) -> float:
    """Return how deep a point will be inside anything that moves but `own`, `ahead` s from now; m.

    Outside it is below zero and its size at most the distance; minus infinity where nothing moves.
    """
    deepest = -math.inf
    for m in range(env.mover_count):
        o = env.movers[m]
        i = env.owner[o]
        if i != own:
            depth = depth_inside(env, o, own_point(env, i, point_world, ahead))
            deepest = max(deepest, depth)
    return deepest


@kernel
def depth_in_mover(env: EnvironmentTable, i: int, point_world: Vec3, ahead: float) -> float:
    """Return how deep a point will be inside obstacle `i`, `ahead` s from now, m.

    Below zero outside; minus infinity where it does not move.
    """
    deepest = -math.inf
    for m in range(env.mover_count):
        o = env.movers[m]
        if env.owner[o] == i:
            deepest = max(deepest, depth_inside(env, o, own_point(env, i, point_world, ahead)))
    return deepest


@kernel
def clear_of_movers(env: EnvironmentTable, point_world: Vec3, ahead: float, own: int) -> Vec3:
    """Return a point, or the place by it that nothing that moves, but `own`, takes up.

    `ahead` s from now.
    """
    for m in range(env.mover_count):
        o = env.movers[m]
        i = env.owner[o]
        if i != own:
            out = way_out(env, o, own_point(env, i, point_world, ahead))
            point_world = point_world + world_direction(env, i, out, ahead)
    return point_world
