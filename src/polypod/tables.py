"""A morphology's static data as kernels read it."""

from __future__ import annotations

import math

import numpy as np

from polypod.body.push import recovery_rate
from polypod.config import Settings
from polypod.controller.stride import make_stride_table
from polypod.gait.follow import make_ladder
from polypod.gait.tempo import GRAVITY
from polypod.ik.table import build_ik_table
from polypod.morphology.girdles import find_girdles
from polypod.morphology.types import Morphology
from polypod.spine.elevation import PELVIC_YAW
from polypod.spine.table import make_bend_table
from polypod.state import HerdTables, JointTable

# A trunk on two legs cannot follow the slope between its feet: it would nod at each step.
TWO_LEGGED_TILT = 0.25
# Weight of level places beside those of `PlanSettings`: tall legs have little to spare in height.
LEVEL_UPRIGHT = 0.5
LEVEL_SPRAWLING = 0.15
# A sprawler's feet go round what its body passes: the part of its track that is kept free.
SPRAWLING_TRACK = 0.72
# Clearance of swing feet, leg lengths: the middles of BIOMECHANICS 2, mammals 8-15 %, arthropods
# 10-25 %. No dependence on size is known there.
STEP_UPRIGHT = 0.115
STEP_SPRAWLING = 0.175


def make_tables(morphology: Morphology, like: HerdTables | None = None) -> HerdTables:
    """Return a morphology's static data as kernels read it.

    `like`: those of the same creature with other joint limits, which save the most of the time.
    """
    legs = morphology.legs
    driven = np.zeros(len(morphology.joint_node), np.bool_)
    driven[legs.joint[legs.joint >= 0]] = True
    for oriented in (legs.foot_joint, legs.toe_joint):
        driven[oriented[oriented >= 0]] = True
    leg_length = float(np.mean(legs.length))
    upright = bool(np.mean(legs.upright) > 0.5)
    track = float(np.mean(np.abs(legs.sole_stance[:, 0]) + legs.foot_half_size[:, 0]))
    hip_height = float(np.mean(legs.point_rest[:, 0, 1] - legs.sole_stance[:, 1]))
    hip_height = max(hip_height, 0.05 * leg_length)
    ik = build_ik_table(legs, None if like is None else (like.legs, like.ik))
    girdles = find_girdles(legs)
    bend = make_bend_table(morphology.segments, girdles, legs)
    girdle_yaw = PELVIC_YAW * bend.apart if len(morphology.segments.joint) else 0.0
    return HerdTables(
        legs=legs,
        ik=ik,
        girdles=girdles,
        spine=morphology.segments,
        bend=bend,
        body=morphology.body,
        joints=JointTable(morphology.joint_parent, morphology.joint_rest, driven),
        leg_length=leg_length,
        hip_height=hip_height,
        pendulum_time=math.sqrt(leg_length / GRAVITY),
        tilt_scale=TWO_LEGGED_TILT if len(legs.length) <= 2 else 1.0,
        ladder=make_ladder(legs),
        stride=make_stride_table(legs, ik, hip_height, girdle_yaw),
        track=track * (1.0 if upright else SPRAWLING_TRACK),
        # Two feet do not tell the slope of the ground ahead, nor what is level on it.
        level_weight=LEVEL_UPRIGHT if upright and len(legs.length) > 2 else LEVEL_SPRAWLING,
        upright=upright,
        stance_travel=float(ik.stance_travel.min()),
        recovery=recovery_rate(hip_height, leg_length),
    )


def folding_room(tables: HerdTables) -> float:
    """Return how far every leg can still fold in stance, metres: what a crouched leg steps with."""
    ik = tables.ik
    reach = np.linalg.norm(ik.effector_stance - ik.hip_rest, axis=1)
    return max(0.0, float(np.min(reach - ik.shortest)))


def step_share(settings: Settings, tables: HerdTables) -> float:
    """Return the clearance of swing feet, leg lengths: as set, or by the creature's build."""
    if settings.step_height is not None:
        return settings.step_height
    return STEP_UPRIGHT if tables.upright else STEP_SPRAWLING
