"""The plane through the feet: what the body's height, pitch and roll follow (P1 3.2).

P1 reads the pitch off the convex hull's segment under the body, which jumps whenever a crate enters
the slice. The plane fitted to the feet says the same where feet stand on the same ground, and moves
continuously because a swing foot counts as being on its way from its old place to its next.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from polypod.compute import kernel
from polypod.math.quat import Quat, from_axis_angle, from_heading
from polypod.math.vec3 import Vec3, load_vec3, mix

# Feet that stand nearly in a line say little about the slope across it: the fit leans to level
# ground by a spread of so many leg lengths. More across than along: a trunk on a narrow track stays
# upright where one foot is on a crate, as a horse's does.
LEVEL_LENGTH = 0.08
LEVEL_WIDTH = 0.2


class FeetPlane(NamedTuple):
    """The plane fitted to the feet, about the point under the body centre."""

    height: float  # m, world, at the body centre's place on the plan
    slope_forward: float  # rise per metre along the heading
    slope_left: float  # rise per metre toward the creature's left


@kernel
def smooth_step(share: float) -> float:
    """Return a rise from 0 to 1 with flat ends, of continuous acceleration."""
    s = min(1.0, max(0.0, share))
    return s * s * s * (10.0 + s * (6.0 * s - 15.0))


@kernel
def foot_on_its_way(c: int, k: int, state: Any) -> Vec3:
    """Return where a foot counts as being for the body: between its old place and its next."""
    if not state.swinging[c, k]:
        return load_vec3(state.foot[c, k])
    share = smooth_step(state.swing_progress[c, k])
    return mix(load_vec3(state.foot_start[c, k]), load_vec3(state.foot_target[c, k]), share)


@kernel
def feet_plane(c: int, state: Any, tables: Any) -> FeetPlane:
    """Return the least-squares plane through the feet, leaning to level ground."""
    count = state.swinging.shape[1]
    sine = math.sin(state.heading[c])
    cosine = math.cos(state.heading[c])
    mean_z = 0.0
    mean_x = 0.0
    mean_y = 0.0
    for k in range(count):
        place = foot_on_its_way(c, k, state)
        x = place.x - state.position[c, 0]
        z = place.z - state.position[c, 2]
        mean_z += (x * sine + z * cosine) / count
        mean_x += (x * cosine - z * sine) / count
        mean_y += place.y / count
    zz = (LEVEL_LENGTH * tables.leg_length) ** 2
    xx = (LEVEL_WIDTH * tables.leg_length) ** 2
    zx = 0.0
    zy = 0.0
    xy = 0.0
    for k in range(count):
        place = foot_on_its_way(c, k, state)
        x = place.x - state.position[c, 0]
        z = place.z - state.position[c, 2]
        forward = x * sine + z * cosine - mean_z
        left = x * cosine - z * sine - mean_x
        up = place.y - mean_y
        zz += forward * forward / count
        xx += left * left / count
        zx += forward * left / count
        zy += forward * up / count
        xy += left * up / count
    scale = 1.0 / (zz * xx - zx * zx)
    slope_forward = (zy * xx - xy * zx) * scale
    slope_left = (xy * zz - zy * zx) * scale
    return FeetPlane(
        mean_y - slope_forward * mean_z - slope_left * mean_x, slope_forward, slope_left
    )


@kernel
def body_rotation(heading: float, slope_forward: float, slope_left: float) -> Quat:
    """Return the orientation of a body that faces `heading` and lies along two slopes."""
    pitch = from_axis_angle(Vec3(1.0, 0.0, 0.0), -math.atan(slope_forward))
    roll = from_axis_angle(Vec3(0.0, 0.0, 1.0), math.atan(slope_left))
    return from_heading(heading) * pitch * roll
