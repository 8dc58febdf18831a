"""A pose for every joint: legs by inverse kinematics, the rest riding on them and on the body."""

from __future__ import annotations

from typing import Any

from polypod.body.reach import effector_world, pitched
from polypod.compute import kernel
from polypod.ik.solve import solve_leg
from polypod.math.quat import Quat, load_quat, rotate, store_quat, unrotate
from polypod.math.vec3 import Vec3, distance, load_vec3, store_vec3
from polypod.spine.frames import leg_frame, segment_frame


@kernel
def pose_leg_of(
    c: int, k: int, position: Vec3, turn: Quat, state: Any, tables: Any, scratch: Any
) -> None:
    """Pose one leg so that its sole is where it was planned; note where it really is.

    `position` and `turn` are the body's pose.
    """
    legs = tables.legs
    position, turn = leg_frame(c, k, position, turn, state, tables)
    foot_turn = pitched(load_quat(state.foot_rotation[c, k]), state.foot_pitch[c, k, 0])
    bend = state.foot_bend[c, k, 0]
    sole = load_vec3(state.foot[c, k])
    effector = effector_world(k, tables, sole, foot_turn, bend)
    target_body = unrotate(turn, effector - position)
    solve_leg(tables.ik, k, target_body, scratch.leg_rotation, scratch.leg_point)
    count = legs.joint_count[k]
    for i in range(count):
        joint = legs.joint[k, i]
        store_vec3(
            state.joint_position[c, joint],
            position + rotate(turn, load_vec3(scratch.leg_point[i])),
        )
        store_quat(state.joint_rotation[c, joint], turn * load_quat(scratch.leg_rotation[i]))
    reached = position + rotate(turn, load_vec3(scratch.leg_point[count]))
    foot_joint = legs.foot_joint[k]
    if foot_joint >= 0:
        heel_turn = pitched(foot_turn, bend)
        store_vec3(state.joint_position[c, foot_joint], reached)
        store_quat(state.joint_rotation[c, foot_joint], heel_turn)
        pivot_rest = load_vec3(legs.roll_pivot[k])
        reached = reached + rotate(heel_turn, pivot_rest - load_vec3(legs.point_rest[k, count]))
        toe_joint = legs.toe_joint[k]
        if toe_joint >= 0:
            store_vec3(state.joint_position[c, toe_joint], reached)
            store_quat(state.joint_rotation[c, toe_joint], foot_turn)
        reached = reached + rotate(foot_turn, load_vec3(legs.sole_rest[k]) - pivot_rest)
    store_vec3(state.foot_reached[c, k], reached)
    state.residual[c, k] = distance(reached, sole)


@kernel
def pose_joints(c: int, state: Any, tables: Any, scratch: Any) -> None:
    """Write the pose of every joint: world positions, and rotations away from the rest."""
    position = load_vec3(state.position[c])
    turn = load_quat(state.rotation[c])
    for k in range(state.swinging.shape[1]):
        pose_leg_of(c, k, position, turn, state, tables, scratch)
    joints = tables.joints
    for j in range(joints.parent.shape[0]):
        if joints.driven[j]:
            continue
        parent = joints.parent[j]
        place = load_vec3(joints.rest[j])
        segment = tables.spine.of_joint[j]
        if segment >= 0 or parent < 0:
            origin, turned = segment_frame(c, segment, position, turn, state)
            store_vec3(state.joint_position[c, j], origin + rotate(turned, place))
            store_quat(state.joint_rotation[c, j], turned)
            continue
        parent_turn = load_quat(state.joint_rotation[c, parent])
        arm = place - load_vec3(joints.rest[parent])
        store_vec3(
            state.joint_position[c, j],
            load_vec3(state.joint_position[c, parent]) + rotate(parent_turn, arm),
        )
        store_quat(state.joint_rotation[c, j], parent_turn)
