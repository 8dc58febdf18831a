"""The foot's own frame, in which steps are planned on open ground.

The maps' grid lies along the world's axes. Where nothing but legs is in the way the step is turned
(and mirrored for a right foot) about its preferred place before it meets the grid, and its path is
turned back: so a walk that is moved, turned or mirrored is the same walk.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.compute import kernel
from polypod.footprints.settings import StepRequest
from polypod.math.vec3 import Vec3, load_vec3, store_vec3
from polypod.paths.curve import PathRow
from polypod.paths.scratch import OtherLegs

FloatArray = NDArray[np.float64]


class FootFrame(NamedTuple):
    """Axes about a place on the ground: z along the foot, x out from the body."""

    x: float  # world, m
    z: float
    sine: float  # of the foot's heading
    cosine: float
    outward: float  # 1, or -1 where out from the body is against the foot's x


@kernel
def foot_frame(request: StepRequest) -> FootFrame:
    """Return the frame of the foot that is asked about."""
    sine = math.sin(request.foot_yaw)
    cosine = math.cos(request.foot_yaw)
    side = request.side.x * cosine - request.side.z * sine
    outward = 1.0 if side >= 0.0 else -1.0
    return FootFrame(request.preferred_world.x, request.preferred_world.z, sine, cosine, outward)


@kernel
def turn_in(frame: FootFrame, v: Vec3) -> Vec3:
    """Return a world vector along the frame's axes."""
    across = v.x * frame.cosine - v.z * frame.sine
    return Vec3(across * frame.outward, v.y, v.x * frame.sine + v.z * frame.cosine)


@kernel
def turn_out(frame: FootFrame, v: Vec3) -> Vec3:
    """Return the world vector of one along the frame's axes."""
    across = v.x * frame.outward
    return Vec3(
        across * frame.cosine + v.z * frame.sine, v.y, v.z * frame.cosine - across * frame.sine
    )


@kernel
def place_in(frame: FootFrame, place: Vec3) -> Vec3:
    """Return a world place turned into the frame's axes about the frame's place."""
    centre = Vec3(frame.x, 0.0, frame.z)
    return turn_in(frame, place - centre) + centre


@kernel
def place_out(frame: FootFrame, place: Vec3) -> Vec3:
    """Return the world place that `place_in` turned."""
    centre = Vec3(frame.x, 0.0, frame.z)
    return turn_out(frame, place - centre) + centre


@kernel
def request_in(frame: FootFrame, request: StepRequest) -> StepRequest:
    """Return the same step as it lies in the frame."""
    return StepRequest(
        place_in(frame, request.start_world),
        turn_in(frame, request.start_velocity),
        request.preferred_world,
        place_in(frame, request.hip_start),
        place_in(frame, request.hip_touchdown),
        place_in(frame, request.hip_end_of_stance),
        turn_in(frame, request.effector_offset_touchdown),
        turn_in(frame, request.effector_offset_end_of_stance),
        request.reach_min,
        request.reach_max,
        request.reach_comfort_max,
        request.leg_length,
        request.step_height,
        request.foot_half_x,
        request.foot_half_z,
        0.0,
        place_in(frame, request.body_position),
        turn_in(frame, request.side),
        request.swing_seconds,
        request.speed_limit,
        request.search_radius,
        request.other_foot_count,
        request.frame_seconds,
        request.launch,
        request.level_height,
        request.stance_seconds,
        request.level_weight,
        request.profile,
        request.foot_behind,
        request.clears_whole,
    )


@kernel
def legs_in(frame: FootFrame, legs: OtherLegs, count: int) -> None:
    """Turn the other legs' segments into the frame."""
    for s in range(count):
        store_vec3(legs.a[s], place_in(frame, load_vec3(legs.a[s])))
        store_vec3(legs.b[s], place_in(frame, load_vec3(legs.b[s])))


@kernel
def legs_out(frame: FootFrame, legs: OtherLegs, count: int) -> None:
    """Turn the other legs' segments back into the world."""
    for s in range(count):
        store_vec3(legs.a[s], place_out(frame, load_vec3(legs.a[s])))
        store_vec3(legs.b[s], place_out(frame, load_vec3(legs.b[s])))


@kernel
def places_out(frame: FootFrame, place: FloatArray, count: int) -> None:
    """Turn the first `count` of places [C, 3] that were found in the frame into the world."""
    for k in range(count):
        store_vec3(place[k], place_out(frame, load_vec3(place[k])))


@kernel
def path_out(frame: FootFrame, path: PathRow) -> None:
    """Turn a path that was found in the frame into the world."""
    for k in range(path.count[0]):
        store_vec3(path.point[k], place_out(frame, load_vec3(path.point[k])))
        store_vec3(path.tangent[k], turn_out(frame, load_vec3(path.tangent[k])))
