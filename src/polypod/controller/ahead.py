"""Where hips and ground will be when the body is elsewhere: carried along the plane of the feet."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.support import body_rotation
from polypod.compute import kernel
from polypod.controller.steering import PlanPose
from polypod.math.quat import rotate
from polypod.math.vec3 import Vec3, load_vec3


@kernel
def body_height_at(c: int, x: float, z: float, state: Any) -> float:
    """Return the height that the body would have elsewhere, carried along the feet's plane."""
    dx = x - state.position[c, 0]
    dz = z - state.position[c, 2]
    sine = math.sin(state.heading[c])
    cosine = math.cos(state.heading[c])
    rise: float = state.slope[c, 0] * (dx * sine + dz * cosine) + state.slope[c, 1] * (
        dx * cosine - dz * sine
    )
    return state.position[c, 1] + rise


@kernel
def level_height(c: int, x: float, z: float, state: Any) -> float:
    """Return the height of the feet's plane at a place, world."""
    return body_height_at(c, x, z, state) - state.position[c, 1] + state.plane_height[c]


@kernel
def hip_at(c: int, k: int, pose: PlanPose, state: Any, tables: Any) -> Vec3:
    """Return a hip's place, world, when the body is at a predicted pose."""
    turn = body_rotation(pose.heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
    centre = Vec3(pose.x, body_height_at(c, pose.x, pose.z, state), pose.z)
    return centre + rotate(turn, load_vec3(tables.legs.point_rest[k, 0]))
