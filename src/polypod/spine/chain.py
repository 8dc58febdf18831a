"""A spine's segments as a chain: the angles of its joints, and the motions that follow from them.

The state keeps the joints' angles, yaw, pitch and roll of each segment against the one behind it,
so that bones keep their length and limits hold whatever is mixed of two poses.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.math.quat import Quat, from_axis_angle, from_heading, rotate, store_quat
from polypod.math.vec3 import Vec3, load_vec3, store_vec3

AHEAD = Vec3(0.0, 0.0, 1.0)


@kernel
def joint_turn(yaw: float, pitch: float, roll: float) -> Quat:
    """Return the rotation by a heading, then (inside it) front up by a pitch, then a roll; rad.

    A roll raises the left side.
    """
    up = from_axis_angle(Vec3(1.0, 0.0, 0.0), -pitch)
    return from_heading(yaw) * up * from_axis_angle(AHEAD, roll)


@kernel
def joint_angles(turn: Quat) -> Vec3:
    """Return the yaw, pitch and roll, rad, of which `joint_turn` makes a rotation."""
    ahead = rotate(turn, AHEAD)
    left = rotate(turn, Vec3(1.0, 0.0, 0.0))
    up = rotate(turn, Vec3(0.0, 1.0, 0.0))
    return Vec3(
        math.atan2(ahead.x, ahead.z),
        math.asin(min(max(ahead.y, -1.0), 1.0)),
        math.atan2(left.y, up.y),
    )


@kernel
def within(angles: Vec3, limit: Any) -> Vec3:
    """Return the angles of a joint brought within its limits [3], rad."""
    return Vec3(
        min(max(angles.x, -limit[0]), limit[0]),
        min(max(angles.y, -limit[1]), limit[1]),
        min(max(angles.z, -limit[2]), limit[2]),
    )


@kernel
def mixed(c: int, segment: int, share: float, state: Any) -> Vec3:
    """Return a joint's angles at a share of the way from where they are to where they shall be."""
    own = load_vec3(state.spine_angle[c, segment])
    return own * (1.0 - share) + load_vec3(state.spine_wish[c, segment]) * share


@kernel
def place_segments(c: int, share: float, state: Any, tables: Any) -> None:
    """Write the motions of all segments at a share of what they are to bend in this step."""
    spine = tables.spine
    count = spine.joint.shape[0]
    if count == 0:
        return
    pivot = load_vec3(spine.pivot_rest[0])
    pivot = pivot + load_vec3(state.spine_base[c]) * (1.0 - share)
    pivot = pivot + load_vec3(state.spine_base_wish[c]) * share
    turn = Quat(0.0, 0.0, 0.0, 1.0)
    for s in range(count):
        angles = mixed(c, s, share, state)
        turn = turn * joint_turn(angles.x, angles.y, angles.z)
        begin = load_vec3(spine.pivot_rest[s])
        store_vec3(state.segment_shift[c, s], pivot - rotate(turn, begin))
        store_quat(state.segment_turn[c, s], turn)
        pivot = pivot + rotate(turn, load_vec3(spine.pivot_rest[s + 1]) - begin)
    place_tail(c, share, state, tables)


@kernel
def place_tail(c: int, share: float, state: Any, tables: Any) -> None:
    """Write the motions of the tail's segments, which hang on the spine's first."""
    spine = tables.spine
    count = spine.joint.shape[0]
    root = load_vec3(spine.tail_pivot_rest[0])
    first = state.segment_turn[c, 0]
    turn = Quat(first[0], first[1], first[2], first[3])
    pivot = load_vec3(state.segment_shift[c, 0]) + rotate(turn, root)
    for t in range(spine.tail_joint.shape[0]):
        row = count + t
        angles = mixed(c, row, share, state)
        turn = turn * joint_turn(angles.x, angles.y, angles.z)
        begin = load_vec3(spine.tail_pivot_rest[t])
        store_vec3(state.segment_shift[c, row], pivot - rotate(turn, begin))
        store_quat(state.segment_turn[c, row], turn)
        pivot = pivot + rotate(turn, load_vec3(spine.tail_pivot_rest[t + 1]) - begin)


@kernel
def keep_bend(c: int, share: float, state: Any, tables: Any) -> None:
    """Keep the joints' angles at the share of this step's bend that was possible."""
    if tables.spine.joint.shape[0] == 0:
        return
    for row in range(state.spine_angle.shape[1]):
        store_vec3(state.spine_angle[c, row], mixed(c, row, share, state))
    base = load_vec3(state.spine_base[c]) * (1.0 - share)
    store_vec3(state.spine_base[c], base + load_vec3(state.spine_base_wish[c]) * share)
    # What steered it goes on from there too, or it would ask for ever more of feet that hold it.
    for g in range(state.girdle_bend.shape[1]):
        was = state.girdle_sway[c, g, 1]
        state.girdle_sway[c, g, 0] = was + share * (state.girdle_sway[c, g, 0] - was)
        state.girdle_sway[c, g, 1] = state.girdle_sway[c, g, 0]
        for axis in range(state.girdle_bend.shape[2]):
            for i in range(3):
                was = state.girdle_was[c, g, axis, i]
                gone = share * (state.girdle_bend[c, g, axis, i] - was)
                state.girdle_bend[c, g, axis, i] = was + gone
                state.girdle_was[c, g, axis, i] = was + gone
