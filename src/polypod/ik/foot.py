"""How a foot that is not bent by inverse kinematics is turned."""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.math.quat import Quat, from_axis_angle, from_heading
from polypod.math.vec3 import Vec3, cross, length, normalized


@kernel
def foot_rotation(heading: float, ground_normal: Vec3, share: float, most: float) -> Quat:
    """Return a foot's rotation relative to the rest: its yaw, then a tilt toward the ground.

    Args:
        heading: the foot's turn about +Y from +Z toward +X, rad.
        ground_normal: normal of what it stands on, world; pointing up, any length.
        share: part of the ground's tilt that the foot takes, 0 (level) to 1 (flat on it).
        most: the greatest tilt, rad.
    """
    axis = cross(Vec3(0.0, 1.0, 0.0), ground_normal)
    sine = length(axis)
    tilt = min(share * math.atan2(sine, ground_normal.y), most)
    yaw = from_heading(heading)
    return from_axis_angle(normalized(axis, Vec3(1.0, 0.0, 0.0)), tilt) * yaw
