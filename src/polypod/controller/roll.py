"""How a foot rolls off and comes down: heel up before lift-off, trailing, and heel or toes first.

Two angles, rad, positive where the heel is higher than the toes. The *bend* raises the heel about
the roll's pivot while toes stay flat (`polypod.morphology.roll`); the *pitch* turns the whole foot
about its sole. Neither moves the sole. Standing feet follow a target through a filter and swinging
feet a curve that begins with the angle and the rate of lift-off, so both are continuous.

The figures are those of animals filmed from the side, for feet of one piece: a walking human's heel
rises from the middle of the stance on, and strikes with toes up by some 20 degrees; paws and hooves
tip over their toes late, trail far back, and come down nearly flat, toes first.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.body.reach import effector_world, pitched
from polypod.body.smoothing import follow
from polypod.compute import kernel
from polypod.environment.table import surface
from polypod.math.intervals import wrap_phase
from polypod.math.quat import Quat, load_quat, rotate
from polypod.math.vec3 import Vec3, distance, load_vec3, mix
from polypod.morphology.roll import FLAT
from polypod.paths.curve import path_point
from polypod.paths.curve import swing_progress as progress_on_path

# By kind (FLAT, TOE_FIRST, HEEL_FIRST), rad: the heel's rise at lift-off, how far the foot trails
# in swing, how far the toes are up before a heel strikes, and the heel when toes land first.
HEEL_RISE = (0.0, 0.5, 0.6)
TRAIL = (0.0, 0.6, 0.4)
STRIKE = (0.0, 0.0, 0.32)
TOES_DOWN = (0.0, 0.1, 0.0)
# The share of the stance from which the heel rises.
RISE_FROM = (1.0, 0.55, 0.4)
# Shares of the swing: where the bend has gone over into pitch, the foot trails most, and its toes
# are highest.
UNBENT = 0.3
TRAILING = 0.35
READY = 0.7
# Steps, and ways of the body in a stance, this long roll in full, leg lengths; none without.
FULL_STRIDE = 0.5
# Shares of a cycle in which a standing foot's heel rises to its target, sinks to it where the foot
# has missed its turn, and comes down after the toes.
RISING = 0.1
SINKING = 0.3
SETTLING = 0.15
SLOWEST = 4.0  # and that cycle at most, leg pendulum times
# A swing's roll is tried against the ground in so many moments, and keeps so much of the room.
SAMPLES = 16
ROOM = 0.8
MOST_LIFT = 0.3  # rad by which a heel is lifted over an edge that it would meet
LEAST_SIZE = 0.02  # of the roll there, or it says nothing
# What the leg does not reach is shrunk so often, by so much; a folded leg keeps some of its range.
SHRINKS = 5
SHRINK = 0.7
NEAREST = 1.02
SUNK = 0.003  # and may sink so deep, leg lengths
# A foot that lifts flat trails by this share; and none turns back faster, rad a leg pendulum time.
TRAIL_FLAT = 0.4
FASTEST_ROLL = 2.2


@kernel
def stride_share(length: float, leg_length: float) -> float:
    """Return how much of a roll belongs to a step forward by `length`, m: none on the spot."""
    share = min(1.0, max(0.0, length / (FULL_STRIDE * leg_length)))
    return share * share * (3.0 - 2.0 * share)


@kernel
def rise_at_lift(c: int, k: int, state: Any, command: Any, tables: Any) -> float:
    """Return how far a foot's heel is up when it lifts off, by the stride of its present disk."""
    if state.cycle_rate[c] <= 0.0:
        return 0.0
    duty = 1.0 - state.swing_extent[c, k]
    way = state.speed[c] * math.cos(command.travel[c]) * duty / state.cycle_rate[c]
    rise: float = HEEL_RISE[tables.legs.roll_kind[k]] * stride_share(way, tables.legs.length[k])
    return rise


@kernel
def heel_target(c: int, k: int, state: Any, command: Any, tables: Any) -> float:
    """Return how far a standing foot's heel should be up, by how much of its stance is over."""
    kind = tables.legs.roll_kind[k]
    rate = state.cycle_rate[c]
    if kind == FLAT or rate <= 0.0 or state.reaching[c, k]:
        return 0.0
    duty = 1.0 - state.swing_extent[c, k]
    stood = wrap_phase(state.needle[c] - state.swing_start[c, k] - state.swing_extent[c, k])
    share = stood / duty
    if stood >= duty:
        # A foot that is still down in its swing sector stays up on its toes; one that has landed a
        # little before the sector's end, which has moved, lies.
        share = 1.0 if state.stood[c, k] >= 0.5 * duty else 0.0
    rise = max(0.0, share - RISE_FROM[kind]) / (1.0 - RISE_FROM[kind])
    # One that has just landed out of turn stands first.
    settled = min(1.0, state.stood[c, k] / (0.5 * duty))
    whole: float = settled * rise_at_lift(c, k, state, command, tables)
    return whole * rise * rise * (3.0 - 2.0 * rise)


@kernel
def roll_standing(
    c: int, k: int, dt: float, state: Any, command: Any, tables: Any, scratch: Any
) -> None:
    """Write to the scratch how far a foot that does not swing rolls by the end of the step."""
    for i in range(3):
        scratch.pitch[k, i] = state.foot_pitch[c, k, i]
        scratch.bend[k, i] = state.foot_bend[c, k, i]
    if tables.legs.roll_kind[k] == FLAT:
        return
    seconds = SLOWEST * tables.pendulum_time
    if state.cycle_rate[c] > 0.0:
        seconds = min(seconds, 1.0 / state.cycle_rate[c])
    target = heel_target(c, k, state, command, tables)
    time = RISING if target >= scratch.bend[k, 0] else SINKING
    follow(scratch.bend[k], target, time * seconds, dt)
    follow(scratch.pitch[k], 0.0, SETTLING * seconds, dt)


@kernel
def eased(a: float, b: float, share: float) -> float:
    """Return the way from one angle to another that begins and ends at rest."""
    return a + (b - a) * share * share * (3.0 - 2.0 * share)


@kernel
def pitch_along(
    gone: float, start: float, rate: float, trail: float, up: float, end: float
) -> float:
    """Return the pitch at a share of the swing: from its start over trailing and `up` to the end.

    `rate` is the pitch's at the start, rad a swing.
    """
    if gone < TRAILING:
        share = gone / TRAILING
        own = share * (1.0 - share) * (1.0 - share) * TRAILING * rate
        return eased(start, trail, share) + own
    if gone < READY:
        return eased(trail, up, (gone - TRAILING) / (READY - TRAILING))
    # The sole comes down as fast as this does: a heel that is ahead of it meets the ground early.
    left = (1.0 - gone) / (1.0 - READY)
    return end + (up - end) * left * left * left * (4.0 - 3.0 * left)


@kernel
def bend_along(gone: float, start: float, rate: float) -> float:
    """Return the bend at a share of the swing: what lift-off left of it goes over into pitch."""
    if gone >= UNBENT:
        return 0.0
    share = gone / UNBENT
    left = 1.0 - share
    return start * left * left * (1.0 + 2.0 * share) + rate * UNBENT * share * left * left


@kernel
def roll_swinging(c: int, k: int, dt: float, progress: float, state: Any, scratch: Any) -> None:
    """Write to the scratch how far a swinging foot rolls at a share of its present swing."""
    begun = state.swing_begun[c, k]
    gone = begun + (1.0 - begun) * progress
    start = state.roll_start[c, k]
    plan = state.roll_plan[c, k]
    pitch = pitch_along(gone, start[0], start[1], plan[0], plan[1], plan[2])
    bend = bend_along(gone, start[2], start[3])
    scratch.pitch[k, 1] = (pitch - state.foot_pitch[c, k, 0]) / dt
    scratch.bend[k, 1] = (bend - state.foot_bend[c, k, 0]) / dt
    for i in (0, 2):
        scratch.pitch[k, i] = pitch
        scratch.bend[k, i] = bend


@kernel
def sole_planned(c: int, k: int, gone: float, state: Any, scratch: Any) -> Vec3:
    """Return where a foot is at a share of the path just planned, world."""
    path = scratch.path
    along, _ = progress_on_path(state.path_profile[c, k], gone, 0.0)
    return path_point(path.point, path.tangent, path.fraction, path.count[0], along)


@kernel
def room_below(sole: Vec3, turn: Quat, half_width: float, behind: float, env: Any) -> float:
    """Return how high a side of a foot's shape is over the ground, m.

    The lower of the two corners `behind` metres behind the sole, or ahead of it where that is
    negative, when the foot is turned by `turn` and not rolled.
    """
    least = math.inf
    for side in range(2):
        across = half_width * (1.0 - 2.0 * side)
        place = sole + rotate(turn, Vec3(across, 0.0, -behind))
        height, _ = surface(env, place.x, place.z)
        least = min(least, place.y - height)
    return least


@kernel
def reach_share(k: int, sole: Vec3, turn: Quat, hip: Vec3, pitch: float, tables: Any) -> float:
    """Return how much of a pitch (rad) leaves the ankle within its leg's shortest and longest."""
    share = 1.0
    for _ in range(SHRINKS):
        ankle = effector_world(k, tables, sole, pitched(turn, pitch * share), 0.0)
        far = distance(ankle, hip)
        if tables.ik.shortest[k] * NEAREST <= far <= tables.ik.longest[k]:
            return share
        share *= SHRINK
    return 0.0


@kernel
def begin_roll(c: int, k: int, pace: float, state: Any) -> None:
    """Begin a swing's roll with the foot's present angles; as it stands it levels out.

    `pace` is the share of the swing that it goes in a second.
    """
    state.swing_begun[c, k] = 0.0
    state.roll_start[c, k, 0] = state.foot_pitch[c, k, 0]
    state.roll_start[c, k, 1] = state.foot_pitch[c, k, 1] / pace
    state.roll_start[c, k, 2] = state.foot_bend[c, k, 0]
    state.roll_start[c, k, 3] = state.foot_bend[c, k, 1] / pace
    for i in range(3):
        state.roll_plan[c, k, i] = 0.0


@kernel
def plan_roll(c: int, k: int, pace: float, state: Any, tables: Any, scratch: Any, env: Any) -> None:
    """Begin a swing's roll on the path just planned: as far as path and ground allow.

    Neither may a heel that comes first, nor toes that hang down, meet what the path passes over or
    what the foot lands on.
    """
    legs = tables.legs
    begin_roll(c, k, pace, state)
    plan = state.roll_plan[c, k]
    kind = legs.roll_kind[k]
    if kind == FLAT:
        return
    step = load_vec3(state.foot_target[c, k]) - load_vec3(state.foot[c, k])
    ahead = rotate(load_quat(state.foot_rotation_target[c, k]), Vec3(0.0, 0.0, 1.0))
    share = stride_share(step.x * ahead.x + step.z * ahead.z, legs.length[k])
    heel = legs.foot_behind[k] + legs.foot_half_size[k, 1]
    toes = legs.foot_half_size[k, 1] - legs.foot_behind[k]
    trail = TRAIL[kind] * share
    rolled = (state.foot_pitch[c, k, 0] + state.foot_bend[c, k, 0]) / HEEL_RISE[kind]
    trail *= TRAIL_FLAT + (1.0 - TRAIL_FLAT) * min(1.0, max(0.0, rolled))
    # The steepest of a piece of the curve is half as steep again as the whole.
    trail = min(trail, FASTEST_ROLL / tables.pendulum_time * TRAILING / (1.5 * pace))
    strike = STRIKE[kind] * share
    turn = load_quat(state.foot_rotation_target[c, k])
    wide = legs.foot_half_size[k, 0]
    for i in range(1, SAMPLES):
        gone = i / SAMPLES
        size = pitch_along(gone, 0.0, 0.0, 1.0, -1.0, 0.0)
        sole = sole_planned(c, k, gone, state, scratch)
        hip = mix(load_vec3(scratch.hip[0]), load_vec3(scratch.hip[1]), gone)
        if size > LEAST_SIZE:
            room = ROOM * room_below(sole, turn, wide, -toes, env)
            trail = min(trail, math.asin(min(1.0, max(0.0, room / toes))) / size)
            trail *= reach_share(k, sole, turn, hip, trail * size, tables)
        elif size < -LEAST_SIZE:
            room = ROOM * room_below(sole, turn, wide, heel, env) + SUNK * legs.length[k]
            strike = min(strike, math.asin(min(1.0, max(-1.0, room / heel))) / -size)
            strike *= reach_share(k, sole, turn, hip, strike * size, tables)
    plan[0] = trail
    # Less than none: over an edge the heel is lifted.
    plan[1] = TOES_DOWN[kind] * share - max(strike, -MOST_LIFT)
    plan[2] = TOES_DOWN[kind] * share
