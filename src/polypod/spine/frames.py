"""The frame in which a leg hangs: its girdle's, which a spine carries along (P2 5).

The body's pose stays the reference by which a creature is steered. Each segment of its spine has a
rigid motion relative to the body frame, `segment_shift` and `segment_turn` of the state, the
identity at rest: a point of segment s is body o segment s o rest. Wherever a leg is posed or
judged, its own frame is asked for here: as it is now, or as it will be at a later pose.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.controller.steering import PlanPose, wrapped
from polypod.math.quat import Quat, load_quat, rotate
from polypod.math.vec3 import Vec3, load_vec3
from polypod.spine.advancing import left_along, yaw_along
from polypod.spine.chain import joint_turn

# How quickly a girdle is on the track that it is off: for its own distance from the body centre
# that the body goes, or a radian that it turns, as an exponential of so much.
CARRY = 3.0


@kernel
def segment_frame(
    c: int, segment: int, position: Vec3, turn: Quat, state: Any
) -> tuple[Vec3, Quat]:
    """Return the frame of a segment, world, of a body at a pose; segment -1 is the body itself.

    A point `x` (body frame, at rest) that belongs to it is at `position + rotate(turn, x)`.
    """
    if segment < 0:
        return position, turn
    shift = load_vec3(state.segment_shift[c, segment])
    return position + rotate(turn, shift), turn * load_quat(state.segment_turn[c, segment])


@kernel
def segment_at(ahead: float, tables: Any) -> int:
    """Return the segment of the trunk that lies `ahead` m of the body centre at rest; -1: none."""
    spine = tables.spine
    if spine.joint.shape[0] == 0:
        return -1
    at = 0
    for s in range(1, spine.neck):
        if spine.pivot_rest[s, 2] <= ahead:
            at = s
    return at


@kernel
def leg_frame(
    c: int, k: int, position: Vec3, turn: Quat, state: Any, tables: Any
) -> tuple[Vec3, Quat]:
    """Return the frame in which a leg hangs, world, when the body is at a pose."""
    return segment_frame(c, tables.spine.of_leg[k], position, turn, state)


@kernel
def girdle_ahead(c: int, g: int, then: PlanPose, state: Any, tables: Any) -> tuple[float, float]:
    """Return how far to the left of the body's axis a girdle will be, m, and its yaw against it.

    At a later pose of the body. It follows the track (P2 5.2): when the body has gone on, the
    girdle behind is where the track is known, and the one ahead where the way leads. What a gait
    bends a spine by is left out, as are nod and sway.
    """
    left = float(state.girdle_bend[c, g, 0, 0])
    yaw = float(state.girdle_bend[c, g, 2, 0])
    lead = state.spine_share[c, 0, 0]
    gone_x = then.x - state.position[c, 0]
    gone_z = then.z - state.position[c, 2]
    gone = math.sqrt(gone_x * gone_x + gone_z * gone_z)
    turned = then.heading - then.aside.heading - state.heading[c] + state.deflection[c, 2]
    turned = wrapped(turned)
    if lead <= 0.0 or (gone == 0.0 and turned == 0.0):
        return left, yaw
    place = float(tables.girdles.place[g])
    most = tables.bend.most_yaw[g]
    along = yaw_along(c, place + gone, state, tables)
    later = min(max(lead * (along - turned), -most), most)
    # What it is off the track now it makes up for on the way there.
    share = math.exp(-CARRY * gone / max(abs(place), 1e-9) - CARRY * abs(turned))
    now = min(max(lead * yaw_along(c, place, state, tables), -most), most)
    yaw = later + (yaw - now) * share
    if abs(place) <= tables.leg_length:
        return 0.5 * yaw * place, yaw
    # A long way is no arc of one bend.
    off = left - left_along(c, place, lead, 0.0, state, tables)
    return left_along(c, place, lead, gone, state, tables) + off * share, yaw


@kernel
def leg_frame_at(
    c: int, k: int, position: Vec3, turn: Quat, then: PlanPose, state: Any, tables: Any
) -> tuple[Vec3, Quat]:
    """Return the frame in which a leg will hang, world, when the body is at a later pose `then`.

    `position` and `turn` are that pose in space.
    """
    if tables.spine.of_leg[k] < 0:
        return position, turn
    g = tables.girdles.of_leg[k]
    left, yaw = girdle_ahead(c, g, then, state, tables)
    carried = joint_turn(yaw, state.girdle_bend[c, g, 3, 0], state.girdle_bend[c, g, 4, 0])
    rest = load_vec3(tables.spine.girdle_rest[g])
    # Along an arc it is a little nearer than straight ahead.
    nearer = rest.z * yaw * yaw / 6.0
    moved = Vec3(left, state.girdle_bend[c, g, 1, 0], -nearer)
    shift = rest + moved - rotate(carried, rest)
    return position + rotate(turn, shift), turn * carried
