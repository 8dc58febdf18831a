"""How a foot is turned where it stands: its shape flat on the ground, as far as its leg allows."""

from __future__ import annotations

from typing import Any

from polypod.body.reach import effector_world
from polypod.body.support import body_rotation
from polypod.compute import kernel
from polypod.controller.rest import hip_at
from polypod.controller.steering import PlanPose
from polypod.environment.table import surface_at, surface_normal_at
from polypod.footprints.settings import FootShape
from polypod.ik.foot import foot_rotation
from polypod.ik.solve import solve_leg
from polypod.math.quat import Quat, angle_of, conjugate, load_quat, unrotate
from polypod.math.vec3 import Vec3, distance, load_vec3
from polypod.spine.frames import leg_frame_at

# Halvings of the way from level to flat, where flat is too much for ankle or leg.
HALVINGS = 7
# How much worse a corner that sinks in is than one in the air.
SINKING = 4.0
# Corners this near to a plane make it one, half extents of the foot; steeper ground is a wall.
FITTING = 0.02
STEEPEST = 0.3
# Feet that stand as good as level need no question.
LEVEL = 1e-6


@kernel
def plane_normal_under(env: Any, foot: FootShape, x: float, z: float, ahead: float) -> Vec3:
    """Return a normal, not of unit length, of the plane through the middles of a shape's sides."""
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
def misfit(env: Any, foot: FootShape, sole: Vec3, normal: Vec3, ahead: float) -> float:
    """Return how badly a foot stands whose shape lies in a plane through its sole, m.

    The gaps under its four corners, those that sink in counted several times.
    """
    total = 0.0
    for corner in range(4):
        a = foot.half_x if corner < 2 else -foot.half_x
        b = foot.half_z if corner % 2 == 0 else -foot.half_z
        x = foot.middle_x + a * foot.cosine + b * foot.sine
        z = foot.middle_z - a * foot.sine + b * foot.cosine
        height, _ = surface_at(env, sole.x + x, sole.z + z, ahead)
        gap = sole.y - (normal.x * x + normal.z * z) / normal.y - height
        total += gap if gap >= 0.0 else -SINKING * gap
    return total


@kernel
def ground_normal_under(env: Any, foot: FootShape, sole: Vec3, ahead: float) -> Vec3:
    """Return a normal, not of unit length, of the ground on which a foot's shape lies best, world.

    The plane through its shape; where that is no plane, as beside an edge that it overhangs, it may
    lie better on what is under its sole or under its middle. `ahead` is the seconds from now for
    which it is asked.
    """
    best = plane_normal_under(env, foot, sole.x, sole.z, ahead)
    least = misfit(env, foot, sole, best, ahead)
    if least <= FITTING * foot.radius:
        return best
    for share in range(2):
        x = sole.x + share * foot.middle_x
        z = sole.z + share * foot.middle_z
        normal = surface_normal_at(env, x, z, ahead)
        if normal.y < STEEPEST:
            continue
        other = misfit(env, foot, sole, normal, ahead)
        if other < least:
            least = other
            best = normal
    return best


@kernel
def ankle_turn(
    k: int, sole: Vec3, foot_turn: Quat, hip: Vec3, leg_turn: Quat, tables: Any, scratch: Any
) -> float:
    """Return how far an ankle is turned away from the stance when its foot stands so, rad."""
    ik = tables.ik
    ankle = effector_world(k, tables, sole, foot_turn, 0.0)
    target = load_vec3(ik.hip_rest[k]) + unrotate(leg_turn, ankle - hip)
    solve_leg(ik, k, target, scratch.leg_rotation, scratch.leg_point)
    shank = load_quat(scratch.leg_rotation[ik.joint_count[k] - 1])
    foot = conjugate(leg_turn) * foot_turn
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
    _, turn = leg_frame_at(c, k, sole, turn, landing, state, tables)
    hip = hip_at(c, k, landing, state, tables)
    first = ankle_turn(k, sole, foot_turn, hip, turn, tables, scratch)
    far = distance(effector_world(k, tables, sole, foot_turn, 0.0), hip)
    turn = body_rotation(middle.heading, state.tilt[c, 0, 0], state.tilt[c, 1, 0])
    _, turn = leg_frame_at(c, k, sole, turn, middle, state, tables)
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
