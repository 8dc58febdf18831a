"""Joint rotations that bring a leg's effector to a target: fold, aim, then CCD as polish.

P1 section 3 and P2 section 3 solve a leg by Cyclic Coordinate Descent inside joint limits. Alone it
leaves a tenth to half of the targets unmet and its pose depends on history, so here it only
finishes a pose that is a pure function of the target: *fold* the leg by one number until it is as
long as the target is far, *aim* it there in a stated plane, and let CCD work where the hip's limits
forbid that pose.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.ik.types import IkTable
from polypod.math.quat import (
    Quat,
    between,
    conjugate,
    from_axis_angle,
    load_quat,
    rotate,
    store_quat,
    unit,
)
from polypod.math.vec3 import Vec3, cross, dot, length, load_vec3, normalized, store_vec3

# A secant step squares the error, and the table starts within about 1e-4 of the answer.
SECANT_STEPS = 6
POLISH_STEPS = 8
# Below this outward share of the direction the leg plane's heading is held back: straight under the
# hip a heading means nothing and would spin the leg.
HEADING_FLOOR = 0.3


@kernel
def bend_at(ik: IkTable, leg: int, joint: int, fold: float) -> float:
    """Return the bend of a hinge at a fold, radians, inside its range."""
    bend = ik.bend_base[leg, joint] + fold * ik.bend_slope[leg, joint]
    return min(max(bend, ik.bend_low[leg, joint]), ik.bend_high[leg, joint])


@kernel
def folded_chord(ik: IkTable, leg: int, fold: float) -> Vec3:
    """Return the way from hip to effector of the folded leg, its hip not turned, metres."""
    rotation = Quat(0.0, 0.0, 0.0, 1.0)
    chord = load_vec3(ik.bone_rest[leg, 0])
    for joint in range(1, ik.joint_count[leg]):
        turn = bend_at(ik, leg, joint, fold) - ik.bend_rest[leg, joint]
        rotation = rotation * from_axis_angle(load_vec3(ik.axis[leg, joint]), turn)
        chord = chord + rotate(rotation, load_vec3(ik.bone_rest[leg, joint]))
    return chord


@kernel
def fold_for_reach(ik: IkTable, leg: int, reach: float) -> float:
    """Return the fold at which hip and effector are `reach` metres apart.

    `reach` lies between the leg's shortest and longest; the table's cell gives both ends of a
    secant that then closes on the exact fold.
    """
    cells = ik.fold_of_reach.shape[1] - 1
    span = ik.longest[leg] - ik.shortest[leg]
    if span <= 0.0:
        return ik.fold_of_reach[leg, cells]
    place = min(max((reach - ik.shortest[leg]) / span, 0.0), 1.0) * cells
    cell = min(int(place), cells - 1)
    near = ik.fold_of_reach[leg, cell]
    far = ik.fold_of_reach[leg, cell + 1]
    fold = near + (far - near) * (place - cell)
    slope = (far - near) * cells / span
    error = length(folded_chord(ik, leg, fold)) - reach
    for _ in range(SECANT_STEPS):
        if abs(error) <= 1e-14 * ik.chain_length[leg]:
            break
        step = -error * slope
        fold_next = fold + step
        error_next = length(folded_chord(ik, leg, fold_next)) - reach
        if error_next != error:
            slope = step / (error_next - error)
        fold = fold_next
        error = error_next
    return fold


@kernel
def from_axes(x: Vec3, y: Vec3, z: Vec3) -> Quat:
    """Return the rotation that turns the unit axes to `x`, `y` and `z`, with w not negative."""
    trace = x.x + y.y + z.z
    if trace > 0.0:
        q = Quat(y.z - z.y, z.x - x.z, x.y - y.x, 1.0 + trace)
    elif x.x >= y.y and x.x >= z.z:
        q = Quat(1.0 + x.x - y.y - z.z, x.y + y.x, z.x + x.z, y.z - z.y)
    elif y.y >= z.z:
        q = Quat(x.y + y.x, 1.0 + y.y - x.x - z.z, y.z + z.y, z.x - x.z)
    else:
        q = Quat(z.x + x.z, y.z + z.y, 1.0 + z.z - x.x - y.y, x.y - y.x)
    if q.w < 0.0:
        q = Quat(-q.x, -q.y, -q.z, -q.w)
    return unit(q)


@kernel
def plane_frame(direction: Vec3, normal: Vec3) -> Quat:
    """Return the frame whose x is `direction` (unit) and whose y is as near `normal` as can be."""
    across = normalized(normal - direction * dot(normal, direction), Vec3(0.0, 1.0, 0.0))
    return from_axes(direction, across, cross(direction, across))


@kernel
def plane_normal(ik: IkTable, leg: int, direction: Vec3) -> Vec3:
    """Return the normal that the leg's plane should have for a unit direction of the effector.

    An erect leg keeps its rest normal. A sprawler's is carried about Y with the target's heading,
    which fades where the target nears the vertical line under the hip or passes behind it.
    """
    normal = load_vec3(ik.normal_stance[leg])
    if not ik.turns_with_heading[leg]:
        return normal
    plan_x = ik.plan_stance[leg, 0]
    plan_z = ik.plan_stance[leg, 1]
    outward = direction.x * plan_x + direction.z * plan_z
    sideways = direction.x * plan_z - direction.z * plan_x
    if outward < 2.0 * HEADING_FLOOR:
        rising = max(outward, 0.0)
        outward = HEADING_FLOOR + rising * rising / (4.0 * HEADING_FLOOR)
    size = math.sqrt(outward * outward + sideways * sideways)
    cosine = outward / size
    sine = sideways / size
    return Vec3(normal.x * cosine + normal.z * sine, normal.y, normal.z * cosine - normal.x * sine)


@kernel
def aimed_hip(ik: IkTable, leg: int, chord: Vec3, direction: Vec3) -> Quat:
    """Return the hip's rotation that turns the folded leg's `chord` to the unit `direction`."""
    chord_frame = plane_frame(normalized(chord, direction), load_vec3(ik.normal_rest[leg]))
    return plane_frame(direction, plane_normal(ik, leg, direction)) * conjugate(chord_frame)


@kernel
def hip_angles(ik: IkTable, leg: int, hip: Quat) -> Vec3:
    """Return flexion, sideways swing and twist of the hip away from the stance, radians.

    Swing is a rotation vector at right angles to the limb (flexion about the leg plane's normal),
    twist the turn about the limb that comes before it.
    """
    turned = hip * conjugate(load_quat(ik.hip_stance[leg]))
    if turned.w < 0.0:
        turned = Quat(-turned.x, -turned.y, -turned.z, -turned.w)
    limb = load_vec3(ik.limb_axis[leg])
    flexion = load_vec3(ik.flexion_axis[leg])
    along = turned.x * limb.x + turned.y * limb.y + turned.z * limb.z
    size = math.sqrt(along * along + turned.w * turned.w)
    twist = Quat(0.0, 0.0, 0.0, 1.0)
    if size > 1e-9:
        twist = Quat(
            limb.x * along / size, limb.y * along / size, limb.z * along / size, turned.w / size
        )
    swing = turned * conjugate(twist)
    vector = Vec3(swing.x, swing.y, swing.z)
    sine = length(vector)
    scale = 2.0
    if sine > 1e-9:
        scale = 2.0 * math.atan2(sine, swing.w) / sine
    return Vec3(
        scale * dot(vector, flexion),
        scale * dot(vector, cross(limb, flexion)),
        2.0 * math.atan2(along, turned.w),
    )


@kernel
def hip_strain(ik: IkTable, leg: int, hip: Quat) -> float:
    """Return how much of the hip's range a rotation takes: above 1 it is outside the limits.

    The swing's limit is an ellipse of flexion and sideways swing; the twist has its own.
    """
    angles = hip_angles(ik, leg, hip)
    flexion = angles.x / ik.hip_limit[leg, 0]
    sideways = angles.y / ik.hip_limit[leg, 1]
    swing = math.sqrt(flexion * flexion + sideways * sideways)
    return max(swing, abs(angles.z) / ik.hip_limit[leg, 2])


@kernel
def limited_hip(ik: IkTable, leg: int, hip: Quat) -> Quat:
    """Return the hip's rotation with swing and twist brought inside their limits."""
    angles = hip_angles(ik, leg, hip)
    limit = load_vec3(ik.hip_limit[leg])
    flexion = angles.x / limit.x
    sideways = angles.y / limit.y
    strain = math.sqrt(flexion * flexion + sideways * sideways)
    if strain <= 1.0 and abs(angles.z) <= limit.z:
        return hip
    limb = load_vec3(ik.limb_axis[leg])
    axis = load_vec3(ik.flexion_axis[leg])
    shrink = 1.0 / max(strain, 1.0)
    swing = axis * (angles.x * shrink) + cross(limb, axis) * (angles.y * shrink)
    angle = length(swing)
    twist = from_axis_angle(limb, min(max(angles.z, -limit.z), limit.z))
    turned = from_axis_angle(normalized(swing, axis), angle) * twist
    return turned * load_quat(ik.hip_stance[leg])


@kernel
def pose_leg(
    ik: IkTable, leg: int, hip: Quat, fold: float, rotation_out: Any, point_out: Any
) -> None:
    """Write the pose of a leg from its hip's rotation and its fold: forward kinematics."""
    rotation = hip
    point = load_vec3(ik.hip_rest[leg])
    for joint in range(ik.joint_count[leg]):
        if joint > 0:
            turn = bend_at(ik, leg, joint, fold) - ik.bend_rest[leg, joint]
            rotation = rotation * from_axis_angle(load_vec3(ik.axis[leg, joint]), turn)
        store_quat(rotation_out[joint], rotation)
        store_vec3(point_out[joint], point)
        point = point + rotate(rotation, load_vec3(ik.bone_rest[leg, joint]))
    store_vec3(point_out[ik.joint_count[leg]], point)


@kernel
def turn_from(
    ik: IkTable, leg: int, first: int, turn: Quat, rotation_out: Any, point_out: Any
) -> None:
    """Turn a posed leg from joint `first` outward about that joint's pivot."""
    count = ik.joint_count[leg]
    point = load_vec3(point_out[first])
    for joint in range(first, count):
        rotation = unit(turn * load_quat(rotation_out[joint]))
        store_quat(rotation_out[joint], rotation)
        point = point + rotate(rotation, load_vec3(ik.bone_rest[leg, joint]))
        store_vec3(point_out[joint + 1], point)


@kernel
def polish(ik: IkTable, leg: int, target: Vec3, rotation_out: Any, point_out: Any) -> None:
    """Bring the effector nearer to `target` by Cyclic Coordinate Descent inside the limits.

    P2 section 3: joints in turn, from the effector's end; each turns as far as helps and its range
    allows, so no step takes the effector farther away.
    """
    count = ik.joint_count[leg]
    for _ in range(POLISH_STEPS):
        for joint in range(count - 1, 0, -1):
            before = load_quat(rotation_out[joint - 1])
            axis = rotate(before, load_vec3(ik.axis[leg, joint]))
            own = conjugate(before) * load_quat(rotation_out[joint])
            rest_axis = load_vec3(ik.axis[leg, joint])
            sine = own.x * rest_axis.x + own.y * rest_axis.y + own.z * rest_axis.z
            bend = ik.bend_rest[leg, joint] + 2.0 * math.atan2(sine, own.w)
            pivot = load_vec3(point_out[joint])
            reached = load_vec3(point_out[count]) - pivot
            wanted = target - pivot
            reached = reached - axis * dot(reached, axis)
            wanted = wanted - axis * dot(wanted, axis)
            turn = math.atan2(dot(cross(reached, wanted), axis), dot(reached, wanted))
            bent = min(max(bend + turn, ik.bend_low[leg, joint]), ik.bend_high[leg, joint])
            turn_from(ik, leg, joint, from_axis_angle(axis, bent - bend), rotation_out, point_out)
        pivot = load_vec3(point_out[0])
        reached = load_vec3(point_out[count])
        hip = load_quat(rotation_out[0])
        turned = limited_hip(ik, leg, between(reached - pivot, target - pivot) * hip)
        swung = pivot + rotate(turned * conjugate(hip), reached - pivot)
        if length(swung - target) <= length(reached - target):
            turn_from(ik, leg, 0, turned * conjugate(hip), rotation_out, point_out)


@kernel
def offset_from_hip(ik: IkTable, leg: int, effector_body: Vec3) -> Vec3:
    """Return the way from the hip to a target, a far one drawn in so that no square overflows."""
    far = 1e9 * ik.chain_length[leg]
    hip = load_vec3(ik.hip_rest[leg])
    return Vec3(
        min(max(effector_body.x - hip.x, -far), far),
        min(max(effector_body.y - hip.y, -far), far),
        min(max(effector_body.z - hip.z, -far), far),
    )


@kernel
def solve_leg(
    ik: IkTable, leg: int, effector_body: Vec3, rotation_out: Any, point_out: Any
) -> float:
    """Pose a leg so that its effector is at a target, or as near as limits allow.

    A pure function of the target: it knows no history. Targets beyond the leg's shortest and
    longest reach are drawn in. No limit of a joint is ever exceeded.

    Args:
        ik: the legs.
        leg: row of the leg.
        effector_body: the target, body frame, m.
        rotation_out: [M, 4] written: each joint's rotation relative to the rest, body frame.
        point_out: [M + 1, 3] written: the pivots and, at joint_count, the effector reached.

    Returns:
        The distance from the effector to the target, m.
    """
    hip = load_vec3(ik.hip_rest[leg])
    offset = offset_from_hip(ik, leg, effector_body)
    direction = normalized(offset, load_vec3(ik.limb_axis[leg]))
    reach = min(max(length(offset), ik.shortest[leg]), ik.longest[leg])
    fold = fold_for_reach(ik, leg, reach)
    aimed = aimed_hip(ik, leg, folded_chord(ik, leg, fold), direction)
    allowed = limited_hip(ik, leg, aimed)
    pose_leg(ik, leg, allowed, fold, rotation_out, point_out)
    if hip_strain(ik, leg, aimed) > 1.0:
        polish(ik, leg, hip + direction * reach, rotation_out, point_out)
    return length(load_vec3(point_out[ik.joint_count[leg]]) - effector_body)
