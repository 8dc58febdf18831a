"""Where feet rest beside the body, and where body and hips would be elsewhere."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.push import load_deflection
from polypod.body.support import body_rotation
from polypod.compute import kernel
from polypod.controller.steering import PlanPose
from polypod.math.quat import Quat, rotate
from polypod.math.vec3 import Vec3, load_vec3
from polypod.spine.frames import leg_frame_at

NOWHERE = Vec3(0.0, 0.0, 0.0)


@kernel
def place_body(c: int, k: int, state: Any, tables: Any) -> Vec3:
    """Return the rest place of a sole, spacing included; body frame, m."""
    stand = load_vec3(tables.legs.sole_stance[k])
    return Vec3(stand.x + state.spacing[c, k, 0], stand.y, stand.z + state.spacing[c, k, 1])


@kernel
def rest_ahead(c: int, k: int, then: PlanPose, state: Any, tables: Any, settings: Any) -> Vec3:
    """Return where a sole will rest beside the body centre at a pose, world axes, m.

    Only the plan counts. The body leans with the slope, and the rest places with it; upright legs
    take part of the lean back, so that the feet stay under the body. A spine carries them along
    with their girdle, to where that will be (P2 5).
    """
    turn = body_rotation(then.heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
    origin, turned = leg_frame_at(c, k, NOWHERE, turn, then, state, tables)
    offset = origin + rotate(turned, place_body(c, k, state, tables))
    if tables.legs.upright[k]:
        under = rotate(turn, Vec3(0.0, tables.legs.sole_stance[k, 1], 0.0))
        offset = offset - Vec3(under.x, 0.0, under.z) * settings.upright_lean
    return offset


@kernel
def rest_offset(c: int, k: int, heading: float, state: Any, tables: Any, settings: Any) -> Vec3:
    """Return `rest_ahead` of a body that is where it is, and has some heading there."""
    here = load_vec3(state.position[c])
    pose = PlanPose(
        here.x, here.z, heading, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, load_deflection(c, state), 0.0,
    )  # fmt: skip
    return rest_ahead(c, k, pose, state, tables, settings)


@kernel
def rise_to(c: int, x: float, z: float, state: Any) -> float:
    """Return by how much the feet's plane rises from under the body to a place, m."""
    dx = x - state.position[c, 0]
    dz = z - state.position[c, 2]
    sine = math.sin(state.heading[c])
    cosine = math.cos(state.heading[c])
    rise: float = state.slope[c, 0] * (dx * sine + dz * cosine) + state.slope[c, 1] * (
        dx * cosine - dz * sine
    )
    return rise


@kernel
def body_height_at(c: int, x: float, z: float, state: Any) -> float:
    """Return the height that the body would have elsewhere, carried along the feet's plane.

    Without its present heave, which will be another by then.
    """
    height: float = state.position[c, 1] - state.heave[c] + rise_to(c, x, z, state)
    return height


@kernel
def level_height(c: int, x: float, z: float, state: Any) -> float:
    """Return the height of the feet's plane at a place, world."""
    height: float = state.plane_height[c] + rise_to(c, x, z, state)
    return height


@kernel
def hip_offset(c: int, k: int, turn: Quat, then: PlanPose, state: Any, tables: Any) -> Vec3:
    """Return a hip's place beside the body centre, world axes, m, at a pose of rotation `turn`."""
    origin, turned = leg_frame_at(c, k, NOWHERE, turn, then, state, tables)
    return origin + rotate(turned, load_vec3(tables.legs.point_rest[k, 0]))


@kernel
def hip_at(c: int, k: int, pose: PlanPose, state: Any, tables: Any) -> Vec3:
    """Return a hip's place, world, when the body is at a predicted pose."""
    turn = body_rotation(pose.heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
    centre = Vec3(pose.x, body_height_at(c, pose.x, pose.z, state), pose.z)
    return centre + hip_offset(c, k, turn, pose, state, tables)
