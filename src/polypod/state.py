"""What changes and what is asked for: the state and the command of a herd.

A herd is all creatures of one morphology; arrays are shaped [creature, foot, ...]. A single
creature is a herd of one. Static data is in `polypod.morphology.types`. C creatures, K feet,
J joints, W waypoints; world frame, metres and seconds unless said.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from polypod.gait.follow import GaitLadder
from polypod.morphology.girdles import Girdles
from polypod.morphology.spine import SpineTable
from polypod.morphology.types import BodyTable, BoolArray, FloatArray, IntArray, LegTable
from polypod.paths.curve import PathRow
from polypod.routes.state import RouteState
from polypod.spine.table import BendTable


class JointTable(NamedTuple):
    """How joints hang together, for the pose."""

    parent: IntArray  # [J] row of the joint it rides on, -1: the body
    rest: FloatArray  # [J, 3] body frame, m
    driven: BoolArray  # [J] posed by a leg rather than by its parent


class HerdTables(NamedTuple):
    """All static data of a herd, as kernels read it."""

    legs: LegTable
    ik: Any  # polypod.ik.table.IkTable
    girdles: Girdles
    spine: SpineTable
    bend: BendTable
    body: BodyTable
    joints: JointTable
    leg_length: float  # mean over legs, m: the unit of all tolerances
    hip_height: float  # mean height of the hips above the soles in stance, m
    pendulum_time: float  # sqrt(leg length / g), s
    upright: bool  # most legs stand below their hips
    track: float  # m, half the width of the way that the feet take
    stance_travel: float  # m, the least of all legs': how far a body goes over a standing foot
    level_weight: float  # how much a foot prefers to land where the others stand
    recovery: float  # 1/s, of the spring that brings a pushed body back to its path
    tilt_scale: float  # how much of the feet's slope the trunk can take: less on two legs
    ladder: GaitLadder  # the gaits it takes by itself, from slow to fast
    stride: Any  # polypod.controller.stride.StrideTable


class HerdState(NamedTuple):
    """Everything that changes while a herd walks."""

    position: FloatArray  # [C, 3] the body centre
    rotation: FloatArray  # [C, 4] of the body frame
    heading: FloatArray  # [C] rad about +Y from +Z toward +X
    turn_rate: FloatArray  # [C] rad/s
    speed: FloatArray  # [C] m/s along the direction of travel
    waypoint: IntArray  # [C] index of the waypoint being approached
    travelled: FloatArray  # [C] m, along the way asked for
    route: RouteState  # the way to that waypoint
    deflection: FloatArray  # [C, 6] polypod.body.push.Deflection: how far it is off its path
    steered: FloatArray  # [C, 16] PlanPose: where steering wants the body at the end of the step
    needle: FloatArray  # [C] phase of the gait in [0, 1)
    turn: FloatArray  # [C] cycles by which the needle turned in this step
    cycle_rate: FloatArray  # [C] cycles a second
    detour: FloatArray  # [C] rad from the heading asked for, to pass what is forbidden
    pace: FloatArray  # [C] share of the speed asked for that others leave it, 0 to 1
    yielded: FloatArray  # [C] s for which it has waited for others
    crowded: BoolArray  # [C] others are so near that legs could meet
    member: IntArray  # [C] its row in the world's company
    asked: FloatArray  # [C, 4] direction (rad), speed and waypoint (x, z) when headway began
    judged: FloatArray  # [C, 3] x and z from which headway is judged, and the s since
    halted: FloatArray  # [C] s for which it still stands, for it made no headway
    halts: IntArray  # [C] how often in a row
    caught: IntArray  # [C] the foot that the body goes back for, from 1; 0: none
    caught_clock: FloatArray  # [C] s for which it has gone back
    shy: FloatArray  # [C] rad by which it passes to the side of where a foot was caught
    activity: IntArray  # [C] polypod.activity.Activity
    hurry: FloatArray  # [C] by how much quicker it steps because legs were at their limits
    swing_start: FloatArray  # [C, K] disks in use
    swing_extent: FloatArray  # [C, K]
    goal_start: FloatArray  # [C, K] disks on their way to the destination gait
    goal_extent: FloatArray  # [C, K]
    duty: FloatArray  # [C] mean duty factor of the destination gait, following speed
    blend_left: FloatArray  # [C] cycles left of a transition between gaits
    gait_number: IntArray  # [C] of the command's gait that the transition is to
    rung: IntArray  # [C] row in the ladder of the gait that follows the speed, -1: it is pinned
    gait_speed: FloatArray  # [C] m/s, the speed by which that is chosen
    gait_touchdown: FloatArray  # [C, K] the gait it walks in, as the command states one
    gait_share: FloatArray  # [C, K]
    gait_lag: FloatArray  # [C, K]
    gait_duty: FloatArray  # [C, 3]
    gait_vault: FloatArray  # [C]
    sink: FloatArray  # [C] m by which it carries its body lower, to stride longer
    caution: FloatArray  # [C] by how much the ground shortens its strides, 0 to 1
    cycles: FloatArray  # [C] cycles walked, where strides vary
    seed: IntArray  # [C] of what varies
    least_down: IntArray  # [C] fewest feet that must stand at any moment
    swinging: BoolArray  # [C, K] the foot is off the ground
    airborne: FloatArray  # [C, K] s since it lifted
    frame: FloatArray  # [C] s between two frames that are shown
    reaching: BoolArray  # [C, K] the leg is out of the gait: its foot goes where it was sent
    steps: IntArray  # [C] into how many steps the frame is divided
    stood: FloatArray  # [C, K] cycles since it landed
    lift_phase: FloatArray  # [C, K] needle at lift-off, or at the last new plan
    swing_progress: FloatArray  # [C, K] of the time from there to touchdown, 0 to 1
    waiting: FloatArray  # [C, K] s for which a foot has wished to lift and found no place
    pull: FloatArray  # [C, K] m by which a leg was too short or too long for the body's wished pose
    landing_support: IntArray  # [C, K] what it will land on: obstacle, -1: the ground
    plan_clock: FloatArray  # [C, K] s since its way was planned
    plan_seconds: FloatArray  # [C, K] s from then to touchdown
    landing_own: FloatArray  # [C, K, 3] m: the landing place among the rows of what it is on
    wish: FloatArray  # [C, K, 3] where it would then have liked to land
    foot: FloatArray  # [C, K, 3] the sole as planned
    foot_shown: FloatArray  # [C, K, 3] the sole when this frame began
    foot_start: FloatArray  # [C, K, 3] the sole at lift-off
    foot_target: FloatArray  # [C, K, 3] the footprint it is going to, or stands on
    foot_preferred: FloatArray  # [C, K, 3] where it would have liked to land
    foot_support: IntArray  # [C, K] obstacle stood on, -1: the ground
    foot_rotation: FloatArray  # [C, K, 4] of the foot as it stands, away from the rest
    foot_pitch: (
        FloatArray  # [C, K, 3] rad by which the whole foot is turned about its sole, heel up
    )
    foot_bend: FloatArray  # [C, K, 3] rad by which its heel is up about the roll's pivot; of both
    # also the rate, rad/s, and the input's low pass
    roll_start: (
        FloatArray  # [C, K, 4] at lift-off: pitch, bend, and after each its change, rad a swing
    )
    roll_plan: FloatArray  # [C, K, 3] pitch in swing: trailing, before touchdown, at touchdown; rad
    swing_begun: FloatArray  # [C, K] share of the whole swing that was over when it was planned
    foot_rotation_start: FloatArray  # [C, K, 4] at lift-off
    foot_rotation_target: FloatArray  # [C, K, 4] at touchdown
    spacing: FloatArray  # [C, K, 2] body x, z: shift of the rest place in use, m
    path: PathRow  # the swing paths, axes [C, K]
    path_profile: IntArray  # [C, K] polypod.paths.curve: the time profile on it
    path_launch: FloatArray  # [C, K] speed at the path's start over its mean speed
    plane_height: FloatArray  # [C] m, world: the plane through the feet, under the body centre
    slope: FloatArray  # [C, 2] of the plane through the feet: body z (pitch), body x (roll)
    tilt: FloatArray  # [C, 2, 3] smoothed slope, its rate, and the input's low pass
    lift: FloatArray  # [C, 3] smoothed height of the body centre, world, its rate, low pass, m
    particle_offset: FloatArray  # [C, K] m: each foot's particle over the preferred height
    particle_rise: FloatArray  # [C, K] m/s: how fast it rises; what pushes the body adds to it
    girdle_offset: FloatArray  # [C, G] m: mean of the particles of a girdle's feet
    beat: FloatArray  # [C, HARMONICS, 6] at full gravity, of the needle's angle, cosine and sine
    # each: heave (m), and what the feet lift by times their girdle's place (m^2) and their side (m)
    gravity_share: FloatArray  # [C] of gravity that the gait's bounce takes; the rest is borne
    beat_period: FloatArray  # [C] s a cycle, smoothed, by which the body bounces
    vault: FloatArray  # [C] Alexander's q of the feet's force
    sinusoid_share: FloatArray  # [C] how much of P1's sinusoid there is
    nod_share: FloatArray  # [C, 2] part of what the girdles nod and roll by that the trunk takes on
    heave: FloatArray  # [C] m: body centre over where it would be without its gait's motion
    heave_step: FloatArray  # [C] m: by how much that has changed in this step
    room: FloatArray  # [C, 2] m, at most 0: how far the body stays down for legs at their end, and
    # the cycles since
    nod: FloatArray  # [C, 2] slope forward and to the left that the gait adds to the tilt
    sway: FloatArray  # [C] m: body centre to the left of its course
    swayed: FloatArray  # [C] m: what it would be in full
    sway_share: FloatArray  # [C, 3] smoothed share of that, its rate, low pass
    segment_shift: FloatArray  # [C, S + T, 3] m: motion of the spine's segments, then the tail's,
    segment_turn: FloatArray  # [C, S + T, 4] relative to the body frame; see polypod.spine.frames
    spine_angle: FloatArray  # [C, S + T, 3] rad: yaw, pitch, roll against the segment behind, the
    # first of the spine against the body, those of the tail against the one nearer its root
    spine_base: FloatArray  # [C, 3] m, body frame: shift of where the spine begins
    spine_wish: FloatArray  # [C, S + T, 3] both as they are to be at the end of the step
    spine_base_wish: FloatArray  # [C, 3]
    girdle_bend: FloatArray  # [C, G, 5, 3] a girdle against the body's axis, without what its gait
    # adds: to the left and up, m, yaw (as a heading), pitch (front up) and roll (left side up),
    # rad; smoothed value, rate, low pass
    girdle_was: FloatArray  # [C, G, 5, 3] the same as the step began
    girdle_sway: FloatArray  # [C, G, 2] rad: yaw that its feet add, and the same as the step began
    spine_share: FloatArray  # [C, 2, 3] how much the spine takes on of the track, which is nothing
    # of who goes sideways, and of what the gait bends it by; smoothed
    spine_struck: FloatArray  # [C, 2] rad and rad/s: the bend that pushes gave it, of the front
    gaze: FloatArray  # [C, 3] rad: the head's yaw against the body's axis, smoothed
    tail_sway: FloatArray  # [C, T, 2, 3] rad: yaw and pitch that have come so far down the tail
    track: FloatArray  # [C, TRACK] rad: yaws of the way behind against the present heading
    track_gone: FloatArray  # [C] m, how far behind the first of them is
    track_from: FloatArray  # [C] rad: the heading against which they are
    way_ahead: FloatArray  # [C, MOMENTS, 2] arc, m, and yaw of the way ahead
    led: BoolArray  # [C] its head leads it: the way ahead is as the head took it
    kept_way: FloatArray  # [C, KEPT + 2] rad: yaws of that way against the present heading
    kept_gone: FloatArray  # [C] m, how far behind the middle the first of them is
    front_rate: FloatArray  # [C] rad/s at which its far end turns
    joint_position: FloatArray  # [C, J, 3]
    joint_rotation: FloatArray  # [C, J, 4] away from the rest pose
    foot_reached: FloatArray  # [C, K, 3] the sole where the rig has it
    residual: FloatArray  # [C, K] m, planned against reached
    held: FloatArray  # [C] share of this frame's advance that the legs allowed


class HerdCommand(NamedTuple):
    """What is asked of a herd; every array may be written at any time between steps."""

    speed: FloatArray  # [C] m/s
    heading: FloatArray  # [C] rad; used where there are no waypoints
    travel: FloatArray  # [C] rad from the heading to the direction of travel (a crab: pi / 2)
    step_height: FloatArray  # [C] m
    body_height: FloatArray  # [C] m above the feet's plane
    spacing: FloatArray  # [C, K, 2] body x, z: wished shift of each foot's rest place, m
    reaching: BoolArray  # [C, K] take the leg out of the gait and send its foot to a place
    reach_place: FloatArray  # [C, K, 3] that place, world, m
    period: FloatArray  # [C] s a cycle, NaN: from speed and morphology
    duty: FloatArray  # [C] mean duty factor, NaN: from speed and morphology
    follows: BoolArray  # [C] the gait follows the speed; else it is this one:
    gait_touchdown: FloatArray  # [C, K] phase of each foot's touchdown
    gait_share: FloatArray  # [C, K] each foot's duty over the mean duty
    gait_lag: FloatArray  # [C, K] shift of the touchdown per unit of mean duty
    gait_duty: FloatArray  # [C, 3] mean duty at which it was stated, lowest, highest
    gait_vault: FloatArray  # [C] Alexander's q of upright legs in that gait
    gait_number: IntArray  # [C] counts the changes of gait
    same_circle: BoolArray  # [C] its phases count from the same moment as those of the gait before
    blend_cycles: FloatArray  # [C] cycles in which a transition takes place
    waypoints: FloatArray  # [C, W, 2] x, z
    waypoint_count: IntArray  # [C]
