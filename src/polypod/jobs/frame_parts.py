"""A frame of World.step in parts, so that a clock can tell them apart.

Each part runs over all creatures before the next. Results are those of World.step to the last bit;
a test holds them to it.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polypod.body.pose import update_tilt, wished_height
from polypod.body.support import body_rotation, feet_plane
from polypod.compute import kernel
from polypod.controller.lift import any_off_place, lift_feet
from polypod.controller.settle import advance_swings, settle_body
from polypod.controller.steering import PlanPose, move_body, note_pose
from polypod.controller.swing import replan_feet, shift_spacing
from polypod.gait.advance import advance_gait
from polypod.gait.needle import step_count
from polypod.ik.skeleton import pose_joints
from polypod.math.vec3 import load_vec3
from polypod.world import LONGEST_FRAME, World

PARTS = ("gait and steering", "maps, footprints and paths", "body", "inverse kinematics")


@kernel
def run_part(
    part: int, count: int, dt: float, turn: Any, pose: Any, state: Any, command: Any, tables: Any,
    settings: Any, env: Any, plan_settings: Any, scratch: Any,
) -> None:  # fmt: skip
    """Run one part of a frame for all creatures; `turn` [C] and `pose` [C, 7] go between parts."""
    for c in range(count):
        if part == 0:
            state.frame[c] = min(dt, LONGEST_FRAME)
            shift_spacing(c, dt, state, command, tables, settings)
            restless = any_off_place(c, state, tables, settings)
            turn[c] = advance_gait(c, dt, restless, state, command, tables, settings, scratch)
            moved = move_body(c, dt, state, command, tables, settings, env)
            pose[c, 0] = moved.x
            pose[c, 1] = moved.z
            pose[c, 2] = moved.heading
            pose[c, 3] = moved.turn_rate
            pose[c, 4] = moved.speed
            pose[c, 5] = moved.waypoint
            pose[c, 6] = moved.detour
        at = PlanPose(
            pose[c, 0], pose[c, 1], pose[c, 2], pose[c, 3], pose[c, 4], pose[c, 5], pose[c, 6]
        )
        if part == 1:
            replan_feet(c, dt, at, state, command, tables, settings, env, plan_settings, scratch)
            lift_feet(
                c, dt, turn[c], at, state, command, tables, settings, env, plan_settings, scratch
            )
        if part == 2:
            plane = feet_plane(c, state, tables)
            update_tilt(c, dt, plane, state, tables, settings)
            lean = body_rotation(at.heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
            height = wished_height(
                c, dt, at, plane, lean, state, command, tables, settings, env, scratch
            )
            before = load_vec3(state.position[c])
            settle_body(c, dt, at, height, state, tables, env, scratch)
            note_pose(c, dt, at, before, state, command, tables, settings)
            advance_swings(c, dt, state, scratch, env)
        if part == 3:
            pose_joints(c, state, tables, scratch)


def step_in_parts(world: World, dt: float, seconds: NDArray[np.float64]) -> None:
    """Advance a world by `dt` in one thread, adding each part's processor time to `seconds` [4].

    Raises:
        ValueError: a needle turns so far in `dt` that World.step would take it in several steps.
    """
    for herd in world.herds:
        state = herd.state
        for c in range(herd.count):
            if step_count(dt * state.cycle_rate[c], state.swing_extent[c]) != 1:
                raise ValueError(f"a frame of {dt} s is several steps")
        turn, pose = np.zeros(herd.count), np.zeros((herd.count, 7))
        for part in range(len(PARTS)):
            began = time.thread_time()
            run_part(
                part, herd.count, dt, turn, pose, herd.kernel_state, herd.kernel_command,
                herd.kernel_tables, herd.kernel_settings, world.kernel_environment,
                herd.kernel_plan, herd.scratch(0),
            )  # fmt: skip
            seconds[part] += time.thread_time() - began
    world.time += dt
