"""How a foot is turned where it stands: its shape flat on the ground, as far as its leg allows."""

from __future__ import annotations

from typing import Any

from polypod.body.reach import effector_world
from polypod.body.support import body_rotation
from polypod.compute import kernel
from polypod.controller.ahead import hip_at
from polypod.controller.steering import PlanPose
from polypod.environment.table import surface_at
from polypod.footprints.settings import FootShape
from polypod.ik.foot import foot_rotation
from polypod.ik.solve import solve_leg
from polypod.math.quat import Quat, angle_of, conjugate, load_quat, unrotate
from polypod.math.vec3 import Vec3, distance, load_vec3

# Halvings of the way from level to flat, where flat is too much for ankle or leg.
HALVINGS = 7
# Feet that stand as good as level need no question.
LEVEL = 1e-6


@kernel
def ground_normal_under(env: Any, foot: FootShape, x: float, z: float, ahead: float) -> Vec3:
    """Return a normal, not of unit length, of the plane under a foot's shape, world.

    `x`, `z` is the sole's place; `ahead` is the seconds from now for which it is asked. The plane
    is that of the middles of the shape's sides.
    """
    x += foot.middle_x
    z += foot.middle_z
    half_x = foot.half_x
    half_z = foot.half_z
    east, _ = surface_at(env, x + half_x * foot.cosine, z - half_x * foot.sine, ahead)
    west, _ = surface_at(env, x - half_x * foot.cosine, z + half_x * foot.sine, ahead)
    north, _ = surface_at(env, x + half_z * foot.sine, z + half_z * foot.cosine, ahead)
    south, _ = surface_at(env, x - half_z * foot.sine, z - half_z * foot.cosine, ahead)
    across = 0.5 * (east - west) / half_x
    along = 0.5 * (north - south) / half_z
    return Vec3(
        -across * foot.cosine - along * foot.sine, 1.0, across * foot.sine - along * foot.cosine
    )


@kernel
def ankle_turn(
    k: int, sole: Vec3, foot_turn: Quat, hip: Vec3, body_turn: Quat, tables: Any, scratch: Any
) -> float:
    """Return how far an ankle is turned away from the stance when its foot stands so, rad."""
    ik = tables.ik
    ankle = effector_world(k, tables, sole, foot_turn, 0.0)
    target = load_vec3(ik.hip_rest[k]) + unrotate(body_turn, ankle - hip)
    solve_leg(ik, k, target, scratch.leg_rotation, scratch.leg_point)
    shank = load_quat(scratch.leg_rotation[ik.joint_count[k] - 1])
    foot = conjugate(body_turn) * foot_turn
    return angle_of(conjugate(shank) * foot * load_quat(ik.shank_stance[k]))


@kernel
def demand(
    c: int, k: int, sole: Vec3, foot_turn: Quat, landing: PlanPose, middle: PlanPose,
    state: Any, tables: Any, scratch: Any,
) -> Vec3:  # fmt: skip
    """Return what a foot's turn asks of its leg: ankle at touchdown, ankle in mid-stance, reach.

    Rad, rad, and m from hip to ankle at touchdown.
    """
    turn = body_rotation(landing.heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
    hip = hip_at(c, k, landing, state, tables)
    first = ankle_turn(k, sole, foot_turn, hip, turn, tables, scratch)
    far = distance(effector_world(k, tables, sole, foot_turn, 0.0), hip)
    turn = body_rotation(middle.heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
    hip = hip_at(c, k, middle, state, tables)
    return Vec3(first, ankle_turn(k, sole, foot_turn, hip, turn, tables, scratch), far)


@kernel
def aligned_turn(
    c: int, k: int, sole: Vec3, normal: Vec3, landing: PlanPose, middle: PlanPose,
    state: Any, tables: Any, settings: Any, scratch: Any,
) -> Quat:  # fmt: skip
    """Return how a foot is turned that lands at a place: flat on ground of the given normal.

    Less where that takes its ankle beyond its range at touchdown or in the middle of the stance, or
    its leg beyond its reach at touchdown: then as much as they allow. Level is always allowed.
    """
    flat = foot_rotation(middle.heading, normal, settings.foot_align, settings.foot_tilt)
    level = foot_rotation(middle.heading, normal, 0.0, 0.0)
    if angle_of(flat * conjugate(level)) < LEVEL:
        return flat
    wanted = demand(c, k, sole, flat, landing, middle, state, tables, scratch)
    ankle = settings.ankle_range
    reach = tables.ik.longest[k]
    if max(wanted.x, wanted.y) <= ankle and wanted.z <= reach:
        return flat
    least = demand(c, k, sole, level, landing, middle, state, tables, scratch)
    low = 0.0
    high = settings.foot_align
    for _ in range(HALVINGS):
        share = 0.5 * (low + high)
        turn = foot_rotation(middle.heading, normal, share, settings.foot_tilt)
        wanted = demand(c, k, sole, turn, landing, middle, state, tables, scratch)
        if (
            wanted.x <= max(ankle, least.x)
            and wanted.y <= max(ankle, least.y)
            and wanted.z <= max(reach, least.z)
        ):
            low = share
        else:
            high = share
    return foot_rotation(middle.heading, normal, low, settings.foot_tilt)
