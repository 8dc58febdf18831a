"""Step 1: the orientation is asked of the head and passed back within limits (P2 5.1)."""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.math.quat import Quat, conjugate
from polypod.math.vec3 import Vec3, store_vec3
from polypod.spine.chain import joint_angles, joint_turn

# The head turns toward where the way leads so many moments of `note_way` ahead.
# A head takes on this share of the slope on which the body lies.
LEANING = 0.5


@kernel
def pass_back(c: int, wish: Any, state: Any, tables: Any) -> None:
    """Bring the yaws [G] that girdles should have, rad, within what the spine's joints allow.

    From the foremost back: each has what it wishes as far as the one ahead lets it. What is left
    turns the whole spine, which is what steering does (P2 turns it about the node before the head).
    """
    bend = tables.bend
    last = wish.shape[0] - 1
    for i in range(last + 1):
        g = last - i
        most = bend.most_yaw[g]
        wish[g] = min(max(wish[g], -most), most)
        if i > 0:
            gap = bend.yaw_gap[g]
            wish[g] = min(max(wish[g], wish[g + 1] - gap), wish[g + 1] + gap)


@kernel
def turn_neck(c: int, chest: Quat, gaze: Vec3, state: Any, tables: Any) -> None:
    """Write the angles of the neck's joints that turn the head from the chest to its gaze.

    `chest` is the rotation of the segment that the neck stands on and `gaze` the yaw, pitch and
    roll that the head shall have, both against the body frame. Joints share it as their limits do.
    """
    spine = tables.spine
    wanted = joint_angles(conjugate(chest) * joint_turn(gaze.x, gaze.y, gaze.z))
    share = Vec3(
        shared(wanted.x, tables.bend.neck_range[0]),
        shared(wanted.y, tables.bend.neck_range[1]),
        shared(wanted.z, tables.bend.neck_range[2]),
    )
    for s in range(spine.neck, spine.joint.shape[0]):
        limit = spine.limit[s]
        store_vec3(
            state.spine_wish[c, s],
            Vec3(share.x * limit[0], share.y * limit[1], share.z * limit[2]),
        )


@kernel
def shared(angle: float, whole: float) -> float:
    """Return the share of its range that each joint takes of an angle, at most all of it."""
    if whole <= 0.0:
        return 0.0
    return min(max(angle / whole, -1.0), 1.0)


@kernel
def wished_gaze(c: int, yaw: float, share: float, state: Any) -> Vec3:
    """Return the yaw, pitch and roll of a head against the body frame, rad.

    Toward the way ahead, steady where the body nods and rolls, and less steep than it.
    """
    pitch = math.atan(state.tilt[c, 0, 0] + state.nod[c, 0])
    pitch -= LEANING * math.atan(state.tilt[c, 0, 0])
    roll = math.atan(state.tilt[c, 1, 0] + state.nod[c, 1])
    return Vec3(share * yaw, -share * pitch, -share * roll)
