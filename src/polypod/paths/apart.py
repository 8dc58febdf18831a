"""How far a stepping leg stays from the others, as they will be (P1 section 5.1: legs crossed).

The sole's projection is not enough: legs bend beside and above their soles, and other legs step
meanwhile. So at a few moments of the swing and of the stance after it the whole legs are posed, as
they will be posed then, and the distance between their sections is taken.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.compute import kernel
from polypod.footprints.frame import FootFrame, place_out
from polypod.footprints.settings import StepRequest
from polypod.ik.reach import direction_strain
from polypod.ik.solve import offset_from_hip, solve_leg
from polypod.ik.types import IkTable
from polypod.math.quat import load_quat, rotate, unrotate
from polypod.math.segments import segment_gap
from polypod.math.vec3 import Vec3, load_vec3, store_vec3
from polypod.paths.curve import PathRow, path_point, swing_progress

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

# The moments that are looked at: shares of the swing's time, and beyond 1 of the stance after it.
MOMENTS = np.array([0.3, 0.5, 0.68, 0.85, 1.0, 1.4])
TOUCHDOWN = 4
# Only legs whose lines from hip to sole come so near in plan are posed, leg lengths: knees bend out
# of that line by less, those of sprawlers, whose legs stand in upright planes, by little.
NEAR_IN_PLAN = 0.3
NEAR_SPRAWLING = 0.15
# Room between two legs that is as good as any, leg lengths.
ROOM = 0.03
# What a pair of footprint and path is worth where two legs would touch, and where they would be
# inside each other by `ROOM`. Deeper it is worth ever less: legs that are crossed come out again.
TOUCHING = 0.4
INSIDE = 0.15

# A hip is turned too far on the way at so much of its range: a little beyond may be a prediction's.
STRAINED = 1.02


class LegsAhead(NamedTuple):
    """The body and the other legs at the T moments of a step; world, m.

    K legs, S of them about the stepping one, M the most joints of a leg. A leg's points are its
    pivots, then the effector, then (of an oriented foot) the sole.
    """

    ik: IkTable
    section_radius: FloatArray  # [K, M + 1] half the thickness of each section
    foot_joint: IntArray  # [K] -1: the leg ends at its effector
    own: IntArray  # [1] row of the stepping leg
    others: IntArray  # [1] how many other legs there are
    leg: IntArray  # [S] their rows
    frame: FloatArray  # [5] the `FootFrame` that paths are in; world where the last is 0
    position: FloatArray  # [T, K, 3] the frame in which each of these legs hangs
    rotation: FloatArray  # [T, K, 4]
    sole: FloatArray  # [T, S, 3]
    effector: FloatArray  # [T, S, 3]
    posed: BoolArray  # [T, S] the points below are written
    point: FloatArray  # [T, S, M + 2, 3]
    own_point: FloatArray  # [M + 2, 3]
    leg_rotation: FloatArray  # [M, 4] work of inverse kinematics
    leg_point: FloatArray  # [M + 1, 3]


def make_legs_ahead(ik: IkTable, section_radius: FloatArray, foot_joint: IntArray) -> LegsAhead:
    """Return the memory for one thread.

    Args:
        ik: the legs.
        section_radius: [K, M + 1] m.
        foot_joint: [K] -1 where a leg has no oriented foot.
    """
    moments, (legs, joints) = len(MOMENTS), ik.bend_rest.shape
    return LegsAhead(
        ik=ik,
        section_radius=section_radius,
        foot_joint=foot_joint,
        own=np.zeros(1, np.int64),
        others=np.zeros(1, np.int64),
        leg=np.zeros(legs, np.int64),
        frame=np.zeros(5),
        position=np.zeros((moments, legs, 3)),
        rotation=np.zeros((moments, legs, 4)),
        sole=np.zeros((moments, legs, 3)),
        effector=np.zeros((moments, legs, 3)),
        posed=np.zeros((moments, legs), np.bool_),
        point=np.zeros((moments, legs, joints + 2, 3)),
        own_point=np.zeros((joints + 2, 3)),
        leg_rotation=np.zeros((joints, 4)),
        leg_point=np.zeros((joints + 1, 3)),
    )


@kernel
def pose_ahead(
    ahead: LegsAhead, moment: int, leg: int, effector: Vec3, sole: Vec3, point_out: Any
) -> None:
    """Write the points of a leg [M + 2, 3] as it is posed at a moment; world, m."""
    position = load_vec3(ahead.position[moment, leg])
    turn = load_quat(ahead.rotation[moment, leg])
    target = unrotate(turn, effector - position)
    solve_leg(ahead.ik, leg, target, ahead.leg_rotation, ahead.leg_point)
    count = ahead.ik.joint_count[leg]
    for i in range(count + 1):
        store_vec3(point_out[i], position + rotate(turn, load_vec3(ahead.leg_point[i])))
    store_vec3(point_out[count + 1], load_vec3(point_out[count]) + sole - effector)


@kernel
def section_count(ahead: LegsAhead, leg: int) -> int:
    """Return how many sections a leg has."""
    return int(ahead.ik.joint_count[leg] + (1 if ahead.foot_joint[leg] >= 0 else 0))


@kernel
def room_between(ahead: LegsAhead, moment: int, other: int, most: float) -> float:
    """Return the room between the stepping leg and another, both posed, m; at most `most`.

    Their thighs are not compared with each other: they hang on the body as it was made.
    """
    own = ahead.own[0]
    leg = ahead.leg[other]
    room = most
    for i in range(section_count(ahead, own)):
        for j in range(section_count(ahead, leg)):
            if i == 0 and j == 0:
                continue
            gap = segment_gap(
                load_vec3(ahead.own_point[i]),
                load_vec3(ahead.own_point[i + 1]),
                load_vec3(ahead.point[moment, other, j]),
                load_vec3(ahead.point[moment, other, j + 1]),
            )
            room = min(room, gap - ahead.section_radius[own, i] - ahead.section_radius[leg, j])
    return room


@kernel
def hip_ahead(ahead: LegsAhead, moment: int, leg: int) -> Vec3:
    """Return a hip's place in plan at a moment; y is 0."""
    turn = load_quat(ahead.rotation[moment, leg])
    hip = load_vec3(ahead.position[moment, leg]) + rotate(turn, load_vec3(ahead.ik.hip_rest[leg]))
    return Vec3(hip.x, 0.0, hip.z)


@kernel
def room_at(
    ahead: LegsAhead, moment: int, sole: Vec3, effector: Vec3, leg_length: float, most: float
) -> float:
    """Return the least room between the stepping leg and the others at a moment, m.

    At most `most`. Legs that are far from each other in plan are not posed.
    """
    own = ahead.own[0]
    own_hip = hip_ahead(ahead, moment, own)
    own_sole = Vec3(sole.x, 0.0, sole.z)
    near = (NEAR_SPRAWLING if ahead.ik.turns_with_heading[own] else NEAR_IN_PLAN) * leg_length
    posed = False
    for other in range(ahead.others[0]):
        leg = ahead.leg[other]
        there = load_vec3(ahead.sole[moment, other])
        there = Vec3(there.x, 0.0, there.z)
        hip = hip_ahead(ahead, moment, leg)
        if segment_gap(own_hip, own_sole, hip, there) > near:
            continue
        if not posed:
            pose_ahead(ahead, moment, own, effector, sole, ahead.own_point)
            posed = True
        if not ahead.posed[moment, other]:
            pose_ahead(
                ahead, moment, leg, load_vec3(ahead.effector[moment, other]),
                load_vec3(ahead.sole[moment, other]), ahead.point[moment, other],
            )  # fmt: skip
            ahead.posed[moment, other] = True
        most = room_between(ahead, moment, other, most)
    return most


@kernel
def factor_of(room: float, most: float) -> float:
    """Return what a step is worth for the room between the legs; `most` is as good as any, m."""
    share = room / most
    if share >= 1.0:
        return 1.0
    if share >= 0.0:
        return TOUCHING + (1.0 - TOUCHING) * share
    if share >= -1.0:
        return TOUCHING + (TOUCHING - INSIDE) * share
    return -INSIDE / share


@kernel
def place_ahead(ahead: LegsAhead, place: Vec3) -> Vec3:
    """Return in the world a place that is in the world, or in the frame that `ahead` says."""
    kept = ahead.frame
    if kept[4] == 0.0:
        return place
    return place_out(FootFrame(kept[0], kept[1], kept[2], kept[3], kept[4]), place)


@kernel
def room_beside(
    ahead: LegsAhead, moment: int, request: StepRequest, sole: Vec3, most: float
) -> float:
    """Return the least room at a moment with the sole at a place, m; at most `most`.

    The place is as for `place_ahead`.
    """
    effector = place_ahead(ahead, sole + request.effector_offset_touchdown)
    sole = place_ahead(ahead, sole)
    return room_at(ahead, moment, sole, effector, request.leg_length, most)


@kernel
def place_factor(ahead: LegsAhead, request: StepRequest, place: Vec3) -> float:
    """Return what a place is worth for the room between the legs when the foot lands there."""
    most = ROOM * request.leg_length
    return factor_of(room_beside(ahead, TOUCHDOWN, request, place, most), most)


@kernel
def path_factor(ahead: LegsAhead, request: StepRequest, path: PathRow) -> float:
    """Return what a path is worth for the room between the legs on the way and after it."""
    most = ROOM * request.leg_length
    room = most
    for moment in range(MOMENTS.shape[0]):
        along = 1.0
        if MOMENTS[moment] < 1.0:
            along, _ = swing_progress(request.profile, MOMENTS[moment], request.launch)
        sole = path_point(path.point, path.tangent, path.fraction, path.count[0], along)
        room = room_beside(ahead, moment, request, sole, room)
    return factor_of(room, most)


@kernel
def strains_hip(ahead: LegsAhead, request: StepRequest, path: PathRow) -> bool:
    """Return whether the leg would have to turn at its hip farther than it can on the way.

    Ways round what is forbidden lead there, behind the body or under it.
    """
    own = ahead.own[0]
    hip = load_vec3(ahead.ik.hip_rest[own])
    for moment in range(TOUCHDOWN):
        along, _ = swing_progress(request.profile, MOMENTS[moment], request.launch)
        sole = path_point(path.point, path.tangent, path.fraction, path.count[0], along)
        effector = place_ahead(ahead, sole + request.effector_offset_touchdown)
        turn = load_quat(ahead.rotation[moment, own])
        target = unrotate(turn, effector - load_vec3(ahead.position[moment, own]))
        offset = offset_from_hip(target, hip, ahead.ik.chain_length[own])
        if direction_strain(ahead.ik, own, offset) > STRAINED:
            return True
    return False
