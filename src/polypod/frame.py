"""One frame of a herd: the blocks of P1's Figures 2 and 5, in their order.

Four kernels, each over a range of creatures: the table `PARTS` is the main loop. A creature writes
only its own rows, so that neither the range nor the thread matters to what comes out.
"""

from __future__ import annotations

import math
import time
from typing import Any

from polypod.body.motion import move_trunk, trunk_rotation
from polypod.body.pose import update_tilt, wished_height
from polypod.body.reach import may_drag
from polypod.body.support import feet_plane
from polypod.compute import kernel
from polypod.controller.activity import note_activity
from polypod.controller.headway import note_headway
from polypod.controller.landing import advance_swings
from polypod.controller.lift import any_off_place
from polypod.controller.move import move_body
from polypod.controller.moving import any_threatened, carry_feet
from polypod.controller.parting import shift_spacing
from polypod.controller.plan import plan_feet
from polypod.controller.reach import note_reaching, reach_feet
from polypod.controller.settle import settle_body
from polypod.controller.steering import load_pose, note_pose, store_pose
from polypod.gait.advance import advance_gait
from polypod.gait.needle import step_count
from polypod.herd import Herd
from polypod.ik.skeleton import pose_joints
from polypod.math.vec3 import load_vec3, store_vec3
from polypod.morphology.types import FloatArray
from polypod.routes.way import keep_ways
from polypod.spine.bend import bend_spine

# Longer steps than this are no frames that anybody watches.
LONGEST_FRAME = 0.05
# So many creatures go through all parts together: their state stays in a core's cache (a crowd of
# 1000 cost a quarter more for each when every part ran over all of it).
BLOCK = 32
# A walking body goes no farther than this in a step, leg lengths: a foot is down or up a step late,
# and so much farther behind its leg. Without it fast small walkers of whom 30 frames a second are
# asked stop and go; a run's feet are not waited for.
FARTHEST_STEP = 0.04
MOST_STEPS = 64


@kernel
def steps_on_the_way(c: int, dt: float, state: Any, tables: Any) -> int:
    """Return into how many steps a walking body's way in `dt` seconds must be divided."""
    if may_drag(c, state):
        return 1
    steps = math.ceil(state.speed[c] * dt / (FARTHEST_STEP * tables.leg_length))
    return int(min(max(steps, 1), MOST_STEPS))


@kernel
def begin_frame(first: int, last: int, dt: float, state: Any, tables: Any) -> int:
    """Divide each creature's frame into steps that miss no foot's event; return the most of them.

    A needle that turns far in `dt` seconds goes in several: small fast creatures at film rates.
    """
    most = 1
    for c in range(first, last):
        state.frame[c] = min(dt, LONGEST_FRAME)
        state.steps[c] = max(
            step_count(dt * state.cycle_rate[c], state.swing_extent[c]),
            steps_on_the_way(c, dt, state, tables),
        )
        most = max(most, state.steps[c])
        for k in range(state.swinging.shape[1]):
            store_vec3(state.foot_shown[c, k], load_vec3(state.foot[c, k]))
    return most


@kernel
def drive_creatures(
    first: int, last: int, step: int, dt: float, state: Any, command: Any, tables: Any,
    settings: Any, env: Any, plan_settings: Any, scratch: Any,
) -> None:  # fmt: skip
    """Turn the needle, and move the body on the plane as steering and the feet's feedback say."""
    for c in range(first, last):
        if step >= state.steps[c]:
            continue
        seconds = dt / state.steps[c]
        # What feet stand on takes them along.
        if env.mover_count > 0 and step == 0:
            carry_feet(c, dt, state, env)
        # Legs that a higher controller has taken out of the gait.
        note_reaching(c, state, command, tables, settings)
        # Feet spacing approaches what was asked for.
        shift_spacing(c, seconds, state, command, tables, settings)
        # Tempo, transition, needle.
        restless = any_off_place(c, state, tables, settings)
        restless = restless or (env.mover_count > 0 and any_threatened(c, state, tables, env))
        state.turn[c] = advance_gait(
            c, seconds, restless, state, command, tables, settings, scratch
        )
        store_pose(c, move_body(c, seconds, state, command, tables, settings, env, scratch), state)


@kernel
def plan_creatures(
    first: int, last: int, step: int, dt: float, state: Any, command: Any, tables: Any,
    settings: Any, env: Any, plan_settings: Any, scratch: Any,
) -> None:  # fmt: skip
    """Fill maps, and find footprints and paths, for the feet that need them."""
    for c in range(first, last):
        if step < state.steps[c]:
            plan_feet(
                c, dt / state.steps[c], load_pose(c, state), state, command, tables, settings, env,
                plan_settings, scratch,
            )  # fmt: skip


@kernel
def settle_creatures(
    first: int, last: int, step: int, dt: float, state: Any, command: Any, tables: Any,
    settings: Any, env: Any, plan_settings: Any, scratch: Any,
) -> None:  # fmt: skip
    """Put the body over its feet, as far as the legs reach, and carry the swinging feet along."""
    for c in range(first, last):
        if step >= state.steps[c]:
            continue
        seconds = dt / state.steps[c]
        pose = load_pose(c, state)
        # Tilt and height over the feet and over what lies beneath.
        plane = feet_plane(c, state, tables)
        update_tilt(c, seconds, plane, state, tables, settings)
        # What the gait adds to them.
        sway = move_trunk(c, seconds, state, command, tables, settings)
        # The spine along the track, over its girdles' feet.
        bend_spine(c, seconds, pose, plane, state, command, tables, settings, scratch)
        lean = trunk_rotation(c, pose.heading, state)
        height = wished_height(
            c, seconds, pose, plane, lean, state, command, tables, settings, env, scratch
        )
        # The body goes as far as its legs allow, and the swinging feet with it.
        before = load_vec3(state.position[c])
        settle_body(c, seconds, pose, height, sway, state, command, tables, env, scratch)
        note_pose(c, seconds, pose, before, state, command, tables, settings)
        advance_swings(c, seconds, state, tables, scratch, env)
        reach_feet(c, seconds, state, command, tables)
        note_headway(c, seconds, state, command, tables, env)
        note_activity(c, state, command, tables)


@kernel
def pose_creatures(
    first: int, last: int, step: int, dt: float, state: Any, command: Any, tables: Any,
    settings: Any, env: Any, plan_settings: Any, scratch: Any,
) -> None:  # fmt: skip
    """Pose every joint: inverse kinematics for the legs, the rest rides along."""
    for c in range(first, last):
        if step < state.steps[c]:
            pose_joints(c, state, tables, scratch)


PARTS = {
    "gait and steering": drive_creatures,
    "maps, footprints and paths": plan_creatures,
    "body": settle_creatures,
    "inverse kinematics": pose_creatures,
}


def step_creatures(
    herd: Herd,
    environment: Any,
    dt: float,
    first: int,
    last: int,
    worker: int,
    spent: FloatArray | None = None,
) -> None:
    """Advance creatures `first` to `last` - 1 of a herd by `dt` seconds.

    Args:
        herd: the herd.
        environment: the environment's table, as kernels take it.
        dt: seconds.
        first: row of the first creature.
        last: the row after the last.
        worker: whose working memory is used.
        spent: [4] where each part's processor time is added, seconds.
    """
    arguments = (
        herd.kernel_state, herd.kernel_command, herd.kernel_tables, herd.kernel_settings,
        environment, herd.kernel_plan, herd.scratch(worker),
    )  # fmt: skip
    if herd.follows:
        keep_ways(first, last, dt, *arguments)
    for start in range(first, last, BLOCK):
        end = min(start + BLOCK, last)
        for step in range(begin_frame(start, end, dt, herd.kernel_state, herd.kernel_tables)):
            for number, part in enumerate(PARTS.values()):
                began = time.thread_time()
                part(start, end, step, dt, *arguments)
                if spent is not None:
                    spent[number] += time.thread_time() - began
