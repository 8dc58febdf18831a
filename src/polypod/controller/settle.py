"""How far the body and the swinging feet really get in a frame: as far as every leg allows."""

from __future__ import annotations

from typing import Any

from polypod.body.reach import TOLERANCE, body_within_reach, foot_shift
from polypod.body.support import body_rotation
from polypod.compute import kernel
from polypod.controller.steering import PlanPose, wrapped
from polypod.controller.swing import foot_along, store_foot, wished_progress
from polypod.environment.table import surface
from polypod.math.quat import Quat, load_quat, slerp, store_quat
from polypod.math.vec3 import Vec3, length, load_vec3, mix, store_vec3

# Shares of a frame's advance that are tried in turn; 0, the pose before, is always possible.
ADVANCES = (1.0, 0.75, 0.5, 0.3, 0.15, 0.05, 0.0)


@kernel
def feet_fit(
    c: int, dt: float, position: Vec3, turn: Quat, state: Any, tables: Any, scratch: Any
) -> bool:
    """Return whether every foot is within reach of a body pose, swinging ones as far as they may.

    A swinging foot goes on along its path if its leg can follow, or else waits where it is. Writes
    each one's progress to the scratch; the feet themselves are not moved.
    """
    tolerance = TOLERANCE * tables.leg_length
    for k in range(state.swinging.shape[1]):
        scratch.progress[k] = 0.0
        if state.swinging[c, k]:
            progress = wished_progress(c, k, dt, state)
            sole, foot_turn = foot_along(c, k, progress, state)
            if length(foot_shift(k, tables, sole, foot_turn, position, turn)) <= tolerance:
                scratch.progress[k] = progress
                continue
            scratch.progress[k] = state.swing_progress[c, k]
        sole = load_vec3(state.foot[c, k])
        foot_turn = load_quat(state.foot_rotation[c, k])
        if length(foot_shift(k, tables, sole, foot_turn, position, turn)) > 2.0 * tolerance:
            return False
    return True


@kernel
def settle_body(
    c: int, dt: float, pose: PlanPose, height: float, state: Any, tables: Any, scratch: Any
) -> None:
    """Move the body as far toward its wished pose as its legs allow, and the swinging feet along.

    The body first moves least so that all stance soles are within reach. Where that is not enough,
    shares of the frame's advance are tried down to none: the pose before was within reach of every
    foot, so a pose that keeps all soles always exists.
    """
    before = load_vec3(state.position[c])
    turn_before = load_quat(state.rotation[c])
    turn = body_rotation(pose.heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
    wished = Vec3(pose.x, height, pose.z)
    wished = body_within_reach(c, state, tables, wished, turn)
    heading_before = state.heading[c]
    for share in ADVANCES:
        position = mix(before, wished, share)
        turned = slerp(turn_before, turn, share)
        if feet_fit(c, dt, position, turned, state, tables, scratch) or share == 0.0:
            state.held[c] = share
            store_vec3(state.position[c], position)
            store_quat(state.rotation[c], turned)
            state.heading[c] = wrapped(
                heading_before + share * wrapped(pose.heading - heading_before)
            )
            break


@kernel
def advance_swings(c: int, state: Any, scratch: Any, env: Any) -> None:
    """Carry the swinging feet as far as `settle_body` found, and land those that arrived."""
    for k in range(state.swinging.shape[1]):
        if not state.swinging[c, k]:
            continue
        state.swing_progress[c, k] = scratch.progress[k]
        sole, turn = foot_along(c, k, scratch.progress[k], state)
        store_foot(c, k, sole, turn, state)
        if scratch.progress[k] >= 1.0:
            state.swinging[c, k] = False
            state.stood[c, k] = 0.0
            _, support = surface(env, sole.x, sole.z)
            state.foot_support[c, k] = support
