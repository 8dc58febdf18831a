"""Where an obstacle's rows lie at a moment: it goes along and turns about the vertical.

The rows of what moves stay where it began. So a question about it is moved there: the world's point
becomes the obstacle's *own*, and what is found is turned back into the world.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from polypod.compute import kernel
from polypod.math.vec3 import Vec3, load_vec3

if TYPE_CHECKING:
    from polypod.environment.table import EnvironmentTable


@kernel
def shift_of(env: EnvironmentTable, i: int, ahead: float) -> Vec3:
    """Return how far obstacle `i` will be from where its rows have it, `ahead` seconds from now."""
    before = min(ahead, env.turn_in[i])
    after = ahead - before
    return Vec3(
        env.shift[i, 0] + env.velocity[i, 0] * before + env.next_velocity[i, 0] * after,
        env.shift[i, 1] + env.velocity[i, 1] * before + env.next_velocity[i, 1] * after,
        env.shift[i, 2] + env.velocity[i, 2] * before + env.next_velocity[i, 2] * after,
    )


@kernel
def yaw_of(env: EnvironmentTable, i: int, ahead: float) -> float:
    """Return by how much obstacle `i` will be turned against its rows, `ahead` s from now; rad."""
    if not env.can_turn:
        return 0.0
    return env.yaw[i] + env.yaw_rate[i] * ahead


@kernel
def turned(v: Vec3, angle: float) -> Vec3:
    """Return a vector turned about +Y from +Z toward +X by `angle` radians."""
    sine = math.sin(angle)
    cosine = math.cos(angle)
    return Vec3(v.x * cosine + v.z * sine, v.y, v.z * cosine - v.x * sine)


@kernel
def own_point(env: EnvironmentTable, i: int, point_world: Vec3, ahead: float) -> Vec3:
    """Return the place among obstacle `i`'s rows that is at a world point `ahead` s from now."""
    point = point_world - shift_of(env, i, ahead)
    yaw = yaw_of(env, i, ahead)
    if yaw == 0.0:
        return point
    pivot = load_vec3(env.pivot[i])
    return pivot + turned(point - pivot, -yaw)


@kernel
def world_point(env: EnvironmentTable, i: int, own: Vec3, ahead: float) -> Vec3:
    """Return where a place among obstacle `i`'s rows will be `ahead` s from now, world."""
    yaw = yaw_of(env, i, ahead)
    if yaw != 0.0:
        pivot = load_vec3(env.pivot[i])
        own = pivot + turned(own - pivot, yaw)
    return own + shift_of(env, i, ahead)


@kernel
def world_direction(env: EnvironmentTable, i: int, own: Vec3, ahead: float) -> Vec3:
    """Return the world direction of one along obstacle `i`'s rows, `ahead` s from now."""
    yaw = yaw_of(env, i, ahead)
    return own if yaw == 0.0 else turned(own, yaw)


@kernel
def ride(env: EnvironmentTable, i: int, point_world: Vec3) -> Vec3:
    """Return how far this frame's motion of obstacle `i` takes what was at a point; world, m."""
    step = load_vec3(env.step[i])
    if env.yaw_step[i] == 0.0:
        return step
    centre = load_vec3(env.pivot[i]) + load_vec3(env.shift[i]) - step
    arm = point_world - centre
    return step + turned(arm, env.yaw_step[i]) - arm
