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

# The table starts within about 1e-6 of the answer: one or two steps are the rule.
SECANT_STEPS = 6
REACH_TOLERANCE = 1e-13
POLISH_STEPS = 4
POLISH_TURN = 0.1
# Nearer than twice this to the vertical line under the hip, in leg lengths, the heading of a leg's
# plane is held back: straight under the hip a heading means nothing and would spin the leg.
HEADING_FLOOR = 0.25


@kernel
def hinge_turn(base: float, slope: float, fold: float, low: float, high: float) -> float:
    """Return a hinge's turn away from the rest at a fold, radians, inside its range."""
    return min(max(base + fold * slope, low), high)


@kernel
def folded_chord(ik: IkTable, leg: int, fold: float) -> Vec3:
    """Return the way from hip to effector of the folded leg, its hip not turned, metres."""
    rotation = Quat(0.0, 0.0, 0.0, 1.0)
    chord = load_vec3(ik.bone_rest[leg, 0])
    for joint in range(1, ik.joint_count[leg]):
        turn = hinge_turn(
            ik.turn_base[leg, joint],
            ik.turn_slope[leg, joint],
            fold,
            ik.turn_low[leg, joint],
            ik.turn_high[leg, joint],
        )
        rotation = rotation * from_axis_angle(load_vec3(ik.axis[leg, joint]), turn)
        chord = chord + rotate(rotation, load_vec3(ik.bone_rest[leg, joint]))
    return chord


@kernel
def fold_for_reach(ik: IkTable, leg: int, reach: float) -> tuple[float, Vec3]:
    """Return the fold at which hip and effector are `reach` metres apart, and the way between them.

    `reach` lies between the leg's shortest and longest. A cubic through the table's four nearest
    samples gives a start and a slope from which a secant closes on the exact fold.
    """
    cells = ik.fold_of_reach.shape[1] - 1
    span = ik.longest[leg] - ik.shortest[leg]
    if span <= 0.0:
        fold = ik.fold_of_reach[leg, cells]
        return fold, folded_chord(ik, leg, fold)
    place = min(max((reach - ik.shortest[leg]) / span, 0.0), 1.0) * cells
    cell = min(int(place), cells - 1)
    near = ik.fold_of_reach[leg, cell]
    far = ik.fold_of_reach[leg, cell + 1]
    rise = far - near
    rise_near = 0.5 * (far - ik.fold_of_reach[leg, cell - 1]) if cell > 0 else rise
    rise_far = 0.5 * (ik.fold_of_reach[leg, cell + 2] - near) if cell + 2 <= cells else rise
    u = place - cell
    v = 1.0 - u
    fold = near * v + far * u + u * v * (v * (rise_near - rise) - u * (rise_far - rise))
    slope = rise + (v - u) * (v * (rise_near - rise) - u * (rise_far - rise))
    slope = (slope - u * v * (rise_near + rise_far - 2.0 * rise)) * cells / span
    chord = folded_chord(ik, leg, fold)
    error = length(chord) - reach
    steps = 0
    while abs(error) > REACH_TOLERANCE * ik.chain_length[leg] and steps < SECANT_STEPS:
        step = -error * slope
        fold += step
        chord = folded_chord(ik, leg, fold)
        before = error
        error = length(chord) - reach
        if error != before:
            slope = step / (error - before)
        steps += 1
    return fold, chord


@kernel
def from_axes(x: Vec3, y: Vec3, z: Vec3) -> Quat:
    """Return the rotation that turns the unit axes to `x`, `y` and `z`, of either sign."""
    trace = x.x + y.y + z.z
    if trace > 0.0:
        q = Quat(y.z - z.y, z.x - x.z, x.y - y.x, 1.0 + trace)
    elif x.x >= y.y and x.x >= z.z:
        q = Quat(1.0 + x.x - y.y - z.z, x.y + y.x, z.x + x.z, y.z - z.y)
    elif y.y >= z.z:
        q = Quat(x.y + y.x, 1.0 + y.y - x.x - z.z, y.z + z.y, z.x - x.z)
    else:
        q = Quat(z.x + x.z, y.z + z.y, 1.0 + z.z - x.x - y.y, x.y - y.x)
    return unit(q)


@kernel
def plane_frame(direction: Vec3, normal: Vec3) -> Quat:
    """Return the frame whose x is `direction` (unit) and whose y is as near `normal` as can be."""
    across = normalized(normal - direction * dot(normal, direction), Vec3(0.0, 1.0, 0.0))
    return from_axes(direction, across, cross(direction, across))


@kernel
def plane_normal(ik: IkTable, leg: int, offset: Vec3) -> Vec3:
    """Return the normal that the leg's plane should have for an effector at `offset` from the hip.

    An erect leg keeps its rest normal. A sprawler's is carried about Y with the target's heading,
    which fades where the target nears the vertical line under the hip or passes behind it.
    """
    normal = load_vec3(ik.normal_stance[leg])
    if not ik.turns_with_heading[leg]:
        return normal
    plan_x = ik.plan_stance[leg, 0]
    plan_z = ik.plan_stance[leg, 1]
    outward = offset.x * plan_x + offset.z * plan_z
    sideways = offset.x * plan_z - offset.z * plan_x
    floor = HEADING_FLOOR * ik.chain_length[leg]
    if outward < 2.0 * floor:
        rising = max(outward, 0.0)
        outward = floor + rising * rising / (4.0 * floor)
    size = math.sqrt(outward * outward + sideways * sideways)
    cosine = outward / size
    sine = sideways / size
    return Vec3(normal.x * cosine + normal.z * sine, normal.y, normal.z * cosine - normal.x * sine)


@kernel
def aimed_hip(chord: Vec3, normal_rest: Vec3, direction: Vec3, normal: Vec3) -> Quat:
    """Return the hip's rotation that turns the folded leg's `chord` to the unit `direction`.

    The plane's normal goes from `normal_rest` to as near `normal` as the direction allows.
    """
    chord_frame = plane_frame(normalized(chord, direction), normal_rest)
    return plane_frame(direction, normal) * conjugate(chord_frame)


@kernel
def hip_for(ik: IkTable, leg: int, chord: Vec3, direction: Vec3) -> Quat:
    """Return the hip's rotation that brings a folded leg's end where it is wanted.

    `chord` is the way from hip to effector while the hip is not turned, m; `direction` the unit
    direction in which that way should lead.
    """
    normal = plane_normal(ik, leg, direction * length(chord))
    aimed = aimed_hip(chord, load_vec3(ik.normal_rest[leg]), direction, normal)
    # Of its two signs the one nearer to the stance, so that components change smoothly too.
    stance = load_quat(ik.hip_stance[leg])
    near = aimed.x * stance.x + aimed.y * stance.y + aimed.z * stance.z + aimed.w * stance.w
    if near < 0.0:
        aimed = Quat(-aimed.x, -aimed.y, -aimed.z, -aimed.w)
    return aimed


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
            turn = hinge_turn(
                ik.turn_base[leg, joint],
                ik.turn_slope[leg, joint],
                fold,
                ik.turn_low[leg, joint],
                ik.turn_high[leg, joint],
            )
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
            own = conjugate(before) * load_quat(rotation_out[joint])
            axis = load_vec3(ik.axis[leg, joint])
            sine = own.x * axis.x + own.y * axis.y + own.z * axis.z
            turn = 2.0 * math.atan2(sine, own.w)
            axis = rotate(before, axis)
            pivot = load_vec3(point_out[joint])
            reached = load_vec3(point_out[count]) - pivot
            wanted = target - pivot
            reached = reached - axis * dot(reached, axis)
            wanted = wanted - axis * dot(wanted, axis)
            more = math.atan2(dot(cross(reached, wanted), axis), dot(reached, wanted))
            more = min(max(more, -POLISH_TURN), POLISH_TURN)
            best = min(max(turn + more, ik.turn_low[leg, joint]), ik.turn_high[leg, joint])
            turn_from(ik, leg, joint, from_axis_angle(axis, best - turn), rotation_out, point_out)
        pivot = load_vec3(point_out[0])
        reached = load_vec3(point_out[count])
        hip = load_quat(rotation_out[0])
        turned = limited_hip(ik, leg, between(reached - pivot, target - pivot) * hip)
        swung = pivot + rotate(turned * conjugate(hip), reached - pivot)
        if length(swung - target) <= length(reached - target):
            turn_from(ik, leg, 0, turned * conjugate(hip), rotation_out, point_out)


@kernel
def offset_from_hip(effector_body: Vec3, hip_body: Vec3, chain_length: float) -> Vec3:
    """Return the way from the hip to a target, a far one drawn in so that no square overflows."""
    far = 1e9 * chain_length
    return Vec3(
        min(max(effector_body.x - hip_body.x, -far), far),
        min(max(effector_body.y - hip_body.y, -far), far),
        min(max(effector_body.z - hip_body.z, -far), far),
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
    offset = offset_from_hip(effector_body, hip, ik.chain_length[leg])
    direction = normalized(offset, load_vec3(ik.limb_axis[leg]))
    reach = min(max(length(offset), ik.shortest[leg]), ik.longest[leg])
    fold, chord = fold_for_reach(ik, leg, reach)
    aimed = hip_for(ik, leg, chord, direction)
    if hip_strain(ik, leg, aimed) <= 1.0:
        pose_leg(ik, leg, aimed, fold, rotation_out, point_out)
    else:
        pose_leg(ik, leg, limited_hip(ik, leg, aimed), fold, rotation_out, point_out)
        polish(ik, leg, hip + direction * reach, rotation_out, point_out)
    return length(load_vec3(point_out[ik.joint_count[leg]]) - effector_body)
