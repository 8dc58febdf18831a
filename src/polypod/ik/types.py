"""What inverse kinematics knows of each leg, made once: bones, hinges, limits, fold and reach."""

from __future__ import annotations

from typing import NamedTuple

from polypod.morphology.types import BoolArray, FloatArray, IntArray


class IkTable(NamedTuple):
    """The K legs of a morphology; M is the most joints any leg has, S the samples of the fold.

    Joint 0 is the hip, a ball; every further joint is a hinge about `axis`. A hinge's *bend* is the
    signed angle about it between the bone before and the bone after, 0 when straight; its *turn* is
    the bend less the bend at rest. One number, the *fold*, bends a whole leg: hinge j turns by
    turn_base + fold * turn_slope, clipped to turn_low and turn_high. Rotations are relative to the
    rest; body frame.
    """

    joint_count: IntArray  # [K]
    hip_rest: FloatArray  # [K, 3] m, the hip's pivot
    bone_rest: FloatArray  # [K, M, 3] m, from joint i's pivot to the next or to the effector
    axis: FloatArray  # [K, M, 3] unit, hinge axes at rest; zero for the hip
    bend_rest: FloatArray  # [K, M] rad
    turn_base: FloatArray  # [K, M] rad, at fold 0
    turn_slope: FloatArray  # [K, M] rad per unit of fold
    turn_low: FloatArray  # [K, M] rad
    turn_high: FloatArray  # [K, M] rad
    guessed: BoolArray  # [K, M] the hinge is straight at rest, so its axis was guessed
    chain_length: FloatArray  # [K] m, hip to effector along the bones
    shortest: FloatArray  # [K] m, least distance from hip to effector
    longest: FloatArray  # [K] m, greatest distance from hip to effector
    comfortable: FloatArray  # [K] m, greatest distance a planner should ask for
    fold_of_reach: FloatArray  # [K, S] fold at distances evenly spread from shortest to longest
    turns_with_heading: BoolArray  # [K] the leg's plane follows the target's heading (sprawlers)
    normal_rest: FloatArray  # [K, 3] unit, normal of the leg's plane at rest
    normal_stance: FloatArray  # [K, 3] unit, the same carried by the stance's heading
    plan_stance: FloatArray  # [K, 2] unit x, z: the way from hip to effector in stance
    effector_stance: FloatArray  # [K, 3] m, the effector's place in stance, body frame
    fold_stance: FloatArray  # [K]
    hip_stance: FloatArray  # [K, 4] the hip's rotation in stance
    shank_stance: FloatArray  # [K, 4] that of the last joint before the effector
    limb_axis: FloatArray  # [K, 3] unit, hip to effector in stance: twist turns about it
    flexion_axis: FloatArray  # [K, 3] unit, at right angles to limb_axis, in stance
    hip_limit: FloatArray  # [K, 3] rad: flexion, sideways, twist, about the stance
    upright: BoolArray  # [K]
    stance_travel: FloatArray  # [K] m, straight fore-aft travel at stance height, within reach
    stance_travel_least: FloatArray  # [K] m, the same in the least favourable direction
