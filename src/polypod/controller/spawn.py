"""A creature's first stand: every foot placed by the normal search, the body over them."""

from __future__ import annotations

from typing import Any

from polypod.body.pose import wished_height
from polypod.body.reach import body_within_reach
from polypod.body.support import body_rotation, feet_plane
from polypod.compute import kernel
from polypod.controller.errand import Errand
from polypod.controller.feet import plan_foot
from polypod.controller.rest import rest_offset
from polypod.controller.settle import feet_fit, wish_feet
from polypod.controller.steering import plan_pose
from polypod.environment.table import surface
from polypod.math.quat import store_quat
from polypod.math.vec3 import Vec3, load_vec3, store_vec3

# Body and feet are placed in turns: each fits the other better.
TURNS = 4
SEARCH_GROWTH = 1.6
WIDEST_SPAWN = SEARCH_GROWTH ** (TURNS - 1)
# Feet come down from so many leg lengths above their place.
FROM_ABOVE = 0.1


@kernel
def drop_feet(c: int, above: float, state: Any, tables: Any, settings: Any, env: Any) -> None:
    """Put every foot so many leg lengths above the ground at its rest place."""
    pose = plan_pose(c, state)
    for k in range(state.swinging.shape[1]):
        offset = rest_offset(c, k, pose.heading, state, tables, settings)
        x = pose.x + offset.x
        z = pose.z + offset.z
        height, _ = surface(env, x, z)
        store_vec3(state.foot[c, k], Vec3(x, height + above * tables.legs.length[k], z))


@kernel
def stand_feet(
    c: int, first: bool, radius: float, state: Any, command: Any, tables: Any, settings: Any,
    env: Any, plan_settings: Any, scratch: Any,
) -> bool:  # fmt: skip
    """Place every foot of a creature near its rest place under the present body pose.

    The `first` time the body is taken to be at its preferred height over what is under it.
    """
    if first:
        under, _ = surface(env, state.position[c, 0], state.position[c, 2])
        state.position[c, 1] = under + command.body_height[c]
        state.plane_height[c] = under
    pose = plan_pose(c, state)
    drop_feet(c, FROM_ABOVE, state, tables, settings, env)
    # All feet are there before the first looks for its place: it keeps clear of the others' legs.
    for k in range(state.swinging.shape[1]):
        leg = tables.legs.length[k]
        below = load_vec3(state.foot[c, k]) - Vec3(0.0, FROM_ABOVE * leg, 0.0)
        errand = Errand(below, 0.0, Vec3(0.0, 0.0, 0.0), 0.0, radius * leg)
        if not plan_foot(
            c, k, 0.0, pose, errand, state, command, tables, settings, env, plan_settings, scratch
        ):
            return False
        for axis in range(3):
            state.foot[c, k, axis] = state.foot_target[c, k, axis]
        for axis in range(4):
            state.foot_rotation[c, k, axis] = state.foot_rotation_target[c, k, axis]
        _, support = surface(env, state.foot[c, k, 0], state.foot[c, k, 2])
        state.foot_support[c, k] = support
    return True


@kernel
def stand_body(
    c: int, at_rest: bool, state: Any, command: Any, tables: Any, settings: Any, env: Any,
    scratch: Any,
) -> bool:  # fmt: skip
    """Put the body over its feet, level with their plane; return whether all are in reach.

    Over the ground at the feet's rest places where they have no other: `at_rest`.
    """
    if at_rest:
        drop_feet(c, 0.0, state, tables, settings, env)
    plane = feet_plane(c, state, tables)
    share = settings.tilt_share * tables.tilt_scale
    for axis in range(2):
        slope = plane.slope_forward if axis == 0 else plane.slope_left
        state.slope[c, axis] = slope
        state.tilt[c, axis, 0] = slope * share
        state.tilt[c, axis, 1] = 0.0
        state.tilt[c, axis, 2] = slope * share
    pose = plan_pose(c, state)
    turn = body_rotation(pose.heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
    store_quat(state.rotation[c], turn)
    # An endless time step: the filter arrives, whatever it was.
    height = wished_height(
        c, 1e6, pose, plane, turn, state, command, tables, settings, env, scratch
    )
    wish_feet(c, 0.0, state, command, tables, env, scratch)
    wished = Vec3(pose.x, height, pose.z)
    position = body_within_reach(c, True, state, tables, scratch, wished, turn)
    store_vec3(state.position[c], position)
    return feet_fit(c, False, position, turn, state, tables, env, scratch)


def spawn(
    c: int, state: Any, command: Any, tables: Any, settings: Any,
    env: Any, plan_settings: Any, scratch: Any, search_radius: float,
) -> bool:  # fmt: skip
    """Stand a creature at its position and heading on the plane; return whether it can stand.

    Where a foot finds no place the body was not where legs reach the ground: it is taken for level
    at first. Then it lies along the ground under the feet's rest places.

    Plain Python over two kernels: one kernel around both would take as long again to compile.
    """
    radius = search_radius
    for turn in range(TURNS):
        placed = stand_feet(
            c, turn == 0, radius, state, command, tables, settings, env, plan_settings, scratch
        )
        fits = stand_body(c, not placed, state, command, tables, settings, env, scratch)
        if placed and fits:
            return True
        radius *= SEARCH_GROWTH
    return False
