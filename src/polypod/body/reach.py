"""The least correction of the body that keeps every sole within its leg's reach."""

from __future__ import annotations

from typing import Any

from polypod.compute import kernel
from polypod.ik.reach import reach_shift
from polypod.math.quat import Quat, from_axis_angle, load_quat, rotate, unrotate
from polypod.math.vec3 import Vec3, length, load_vec3
from polypod.spine.frames import leg_frame

PASSES = 16
# A target this near to the edge of the reach, in leg lengths, counts as inside.
TOLERANCE = 2e-5
# A swinging foot farther out of reach than this, leg lengths, waits instead of pulling the body.
# One that has just lifted will soon be fast: the body waits for it. One that lands shall not drag.
EARLY = 0.35
EARLY_PULL = 0.06
LATE_PULL = 0.015
# It waits by no more than this share of its way in a step for feet that come along on the edge of
# their legs' reach: to wait as long as it takes was a halt for a frame or two in many strides. It
# does so for one that would be farther off its path than this, leg lengths.
MOST_WAIT = 0.2
FAR = 0.05
# A gait with a mean duty factor below this is a run.
RUNNING_DUTY = 0.5


@kernel
def pitched(turn: Quat, pitch: float) -> Quat:
    """Return a foot's rotation with its heel raised over its toes by `pitch`, rad."""
    return turn * from_axis_angle(Vec3(1.0, 0.0, 0.0), pitch)


@kernel
def effector_world(k: int, tables: Any, sole_world: Vec3, foot_turn: Quat, bend: float) -> Vec3:
    """Return where a leg's effector is when its sole is at `sole_world`.

    `foot_turn` is the rotation of the sole, and of the toes where the foot has such a joint; from
    the roll's pivot back the foot is turned by `bend` (rad) more.
    """
    legs = tables.legs
    if legs.foot_joint[k] < 0:
        return sole_world
    ankle = load_vec3(legs.point_rest[k, legs.joint_count[k]])
    pivot = load_vec3(legs.roll_pivot[k])
    pivot_world = sole_world - rotate(foot_turn, load_vec3(legs.sole_rest[k]) - pivot)
    return pivot_world - rotate(pitched(foot_turn, bend), pivot - ankle)


@kernel
def shift_in_frame(
    k: int, tables: Any, sole_world: Vec3, foot_turn: Quat, bend: float, position: Vec3, turn: Quat
) -> Vec3:
    """Return the least shift of a foot, world, that brings it within its leg's reach.

    `position` and `turn` are the frame in which its leg hangs; the shift is zero where the leg
    reaches the sole.
    """
    target = effector_world(k, tables, sole_world, foot_turn, bend)
    return rotate(turn, reach_shift(tables.ik, k, unrotate(turn, target - position)))


@kernel
def foot_shift(
    c: int, k: int, sole_world: Vec3, foot_turn: Quat, bend: float, state: Any, tables: Any,
    position: Vec3, turn: Quat,
) -> Vec3:  # fmt: skip
    """Return `shift_in_frame` of a body at a pose whose spine is bent as it is now."""
    position, turn = leg_frame(c, k, position, turn, state, tables)
    return shift_in_frame(k, tables, sole_world, foot_turn, bend, position, turn)


@kernel
def shift_as_it_is(
    c: int, k: int, sole_world: Vec3, state: Any, tables: Any, position: Vec3, turn: Quat
) -> Vec3:
    """Return `foot_shift` of a foot that is turned and rolled as it is now, its sole at a place."""
    foot_turn = pitched(load_quat(state.foot_rotation[c, k]), state.foot_pitch[c, k, 0])
    bend = state.foot_bend[c, k, 0]
    return foot_shift(c, k, sole_world, foot_turn, bend, state, tables, position, turn)


@kernel
def shift_as_wished(
    c: int, k: int, sole_world: Vec3, state: Any, tables: Any, scratch: Any, position: Vec3,
    turn: Quat,
) -> Vec3:  # fmt: skip
    """Return `foot_shift` of a foot turned and rolled as the scratch has it, its sole anywhere."""
    foot_turn = pitched(load_quat(scratch.turn[k]), scratch.pitch[k, 0])
    bend = scratch.bend[k, 0]
    return foot_shift(c, k, sole_world, foot_turn, bend, state, tables, position, turn)


@kernel
def may_drag(c: int, state: Any) -> bool:
    """Return whether a body takes feet in the air along that fall behind: in runs.

    Feet swing for longer than they stand there. Nothing holds a body in flight, and one that waits
    in mid-air, or ambles in fits and starts, looks odd.
    """
    return bool(state.duty[c] < RUNNING_DUTY)


@kernel
def body_within_reach(
    c: int, waits: bool, state: Any, tables: Any, scratch: Any, position: Vec3, turn: Quat
) -> Vec3:
    """Return the position nearest to `position` at which the feet in the scratch are in reach.

    Each pass moves the body against each foot's own shift in turn (projections onto nearly convex
    sets); it ends where no foot asks for more, or with what the passes reached. A swinging foot
    that is far out of reach does not pull: it can wait. Nor does any where the body does not wait.
    What each foot asked for is noted.
    """
    tolerance = TOLERANCE * tables.leg_length
    for attempt in range(PASSES):
        worst = 0.0
        for k in range(state.swinging.shape[1]):
            if state.reaching[c, k]:
                continue
            sole = load_vec3(scratch.sole[k])
            shift = shift_as_wished(c, k, sole, state, tables, scratch, position, turn)
            size = length(shift)
            if attempt == 0:
                state.pull[c, k] = size
            pull = EARLY_PULL if scratch.progress[k] < EARLY else LATE_PULL
            if not waits or (scratch.progress[k] < 1.0 and may_drag(c, state)):
                pull = 0.0
            if state.swinging[c, k] and size > pull * tables.leg_length:
                continue
            if size > tolerance:
                position = position - shift * (1.0 + 0.2 * tolerance / size)
            worst = max(worst, size)
        if worst <= tolerance:
            break
    return position


@kernel
def waits_little(
    c: int, wished: Vec3, waiting: Vec3, before: Vec3, state: Any, tables: Any, scratch: Any,
    turn: Quat,
) -> Vec3:  # fmt: skip
    """Return where a body gets from `before` that waits but little for feet in the air.

    `waiting` is where it gets if it waits for them as long as they need: that it does where one is
    far off its path.
    """
    worst = 0.0
    for k in range(state.swinging.shape[1]):
        if state.swinging[c, k]:
            worst = max(worst, state.pull[c, k] / tables.leg_length)
    if worst <= TOLERANCE or worst > FAR:
        return waiting
    free = body_within_reach(c, False, state, tables, scratch, wished, turn)
    back = waiting - free
    most = MOST_WAIT * length(free - before)
    if length(back) <= most:
        return waiting
    return free + back * (most / length(back))
