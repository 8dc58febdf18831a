"""What the footprints planner is told: its settings, and one foot's request.

Lengths given as fractions are fractions of the leg's length, so that a fly and a dinosaur plan
alike.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from polypod.compute import kernel
from polypod.math.vec3 import Vec3

# Room about start, preferred place and search radius for ways around, leg lengths.
DETOUR = 0.25


class PlanSettings(NamedTuple):
    """How thoroughly and how carefully to plan; the same for all feet of a creature.

    Level of detail (P1 section 6) lowers `candidate_limit` and `slice_limit`, or raises
    `slice_thickness`.
    """

    # Thoroughness.
    cell: float = 0.07  # side of a map cell, leg lengths (P1: 7 cm for its spider)
    candidate_limit: int = 12  # places that are judged exactly, besides the preferred one
    slice_limit: int = 4  # wavefronts a request may spread; 0: always over, never around
    slice_thickness: float = 1.0 / 3.0  # elevation between two slices, step heights
    candidate_spacing: float = 0.13  # least distance between two candidates, leg lengths
    open_score: float = 0.6  # a direct swing to the preferred place this good ends the search
    first_pair: bool = False  # True: the first valid pair is taken (off-screen, P1 section 6)

    # Margins.
    clearance: float = 0.03  # of the sole above what it passes over, leg lengths
    toe: float = 0.02  # what the foot's shape is grown by in plan, leg lengths
    forbidden_margin: float = 0.02  # beyond the foot's shape, around forbidden things, leg lengths
    edge: float = 0.07  # wanted between the foot's shape and an edge, leg lengths
    reach: float = 0.01  # kept from the leg's shortest and longest reach, share of the reach
    leg_gap: float = 0.01  # between the foot and another leg, leg lengths
    chord: float = 0.008  # accepted of the chord between two frames, leg lengths
    penetration: float = 0.0005  # accepted by the exact check of a path, leg lengths

    # What can be stood on.
    rise: float = 0.3  # height above or below the other feet that is no longer level, leg lengths
    uneven: float = 0.02  # largest departure from a plane under the foot, leg lengths,
    uneven_foot: float = 0.2  # and what a larger foot may have more, shares of its half extent
    slope: float = 1.2  # steepest plane under the foot, tangent of the angle (50 degrees)
    drop: float = 0.03  # a larger difference beside the foot is an edge, leg lengths

    # Weights of a place's score; they are normalised by their sum.
    weight_distance: float = 0.45
    weight_even: float = 0.10
    weight_edge: float = 0.15
    weight_reach: float = 0.20
    weight_escape: float = 0.10
    crossing: float = 0.3  # factor on the score of a place across the body from its leg

    # Weights of a path's score; they are normalised by their sum.
    weight_length: float = 0.5
    weight_bending: float = 0.25
    weight_acceleration: float = 0.25

    weight_path: float = 0.5  # share of the path in a pair's score, the rest is the place's


class FootShape(NamedTuple):
    """A foot's shape as it lies in the world: half extents in m, its turn, and where it lies."""

    half_x: float
    half_z: float
    sine: float  # of the heading
    cosine: float
    radius: float  # m, the larger half extent
    middle_x: float  # m, from the sole to the middle of the shape
    middle_z: float


class Tread(NamedTuple):
    """The sole's shape on the plane on which it would stand; its axes are a across and b along."""

    x: float  # world, m: its middle
    y: float
    z: float
    half_a: float
    half_b: float
    sine: float  # of the heading
    cosine: float
    slope_a: float  # rise of the plane along each axis
    slope_b: float
    tolerance: float  # m that the ground may be above or below the plane
    gap: float  # m: gaps up to twice as wide are none
    ahead: float  # s from now for which it is asked


class StepRequest(NamedTuple):
    """One foot's step: world frame, metres, seconds, radians."""

    start_world: Vec3  # the sole now
    start_velocity: Vec3  # per unit of swing progress; zero for a normal lift-off
    preferred_world: Vec3  # only x and z are read
    hip_start: Vec3  # the hip's pivot at lift-off
    hip_touchdown: Vec3  # predicted at touchdown
    hip_end_of_stance: Vec3  # predicted at the end of the coming stance
    effector_offset_touchdown: (
        Vec3  # sole + offset = effector, whose distance to the hip is limited
    )
    effector_offset_end_of_stance: Vec3  # the same when the heel has risen to lift off
    reach_min: float  # m, effector to hip
    reach_max: float
    reach_comfort_max: float
    leg_length: float
    step_height: float  # m, the arc's height over level ground
    foot_half_x: float  # m, half extents of the foot's shape in its own axes
    foot_half_z: float
    foot_yaw: float  # heading of the foot's shape
    body_position: Vec3  # predicted at touchdown
    side: Vec3  # unit, outward from the body in plan; zero for a leg in the middle
    swing_seconds: float
    speed_limit: float  # m/s, the most the foot may move at; infinite where there is none
    search_radius: float  # m, about the preferred place
    other_foot_count: int  # segments of other legs in the scratch
    frame_seconds: float = 0.0  # between two frames, whose chords are checked; 0: the curve alone
    launch: float = 0.0  # speed at the path's start over its mean speed
    level_height: float = 0.0  # m, where the other feet stand, under the preferred place
    stance_seconds: float = 0.0  # how long the foot will stand
    level_weight: float = 0.0  # what a place at that height is worth, beside the settings' weights
    profile: int = 0  # polypod.paths.curve: the time profile on the path
    foot_behind: float = 0.0  # m, from the sole back to the middle of the foot's shape
    clears_whole: bool = False  # its whole shape keeps clear of uneven ground, not the sole alone


@kernel
def landing_time(request: StepRequest) -> float:
    """Return how many seconds from now the foot lands.

    Obstacles are already where they are at the end of this frame, and feet where they were before.
    """
    return max(request.swing_seconds - request.frame_seconds, 0.0)


@kernel
def foot_radius(request: StepRequest) -> float:
    """Return how much room a foot takes beside other legs, m: the mean of its half extents.

    Legs mostly pass each other sideways, where a long sole is narrow; whether they truly touch is
    found by posing them (`paths.apart`).
    """
    return 0.5 * (request.foot_half_x + request.foot_half_z)


@kernel
def placed_shape(half_x: float, half_z: float, behind: float, yaw: float) -> FootShape:
    """Return a foot's shape for a heading, its middle `behind` metres behind its sole."""
    sine = math.sin(yaw)
    cosine = math.cos(yaw)
    radius = max(half_x, half_z)
    return FootShape(half_x, half_z, sine, cosine, radius, -behind * sine, -behind * cosine)


@kernel
def foot_shape(request: StepRequest) -> FootShape:
    """Return the shape of the foot that is asked about."""
    return placed_shape(
        request.foot_half_x, request.foot_half_z, request.foot_behind, request.foot_yaw
    )
