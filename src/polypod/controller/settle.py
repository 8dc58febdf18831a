"""How far the body and the swinging feet really get in a frame: as far as every leg allows."""

from __future__ import annotations

from typing import Any

from polypod.body.motion import trunk_rotation
from polypod.body.reach import (
    EARLY,
    EARLY_PULL,
    LATE_PULL,
    TOLERANCE,
    body_within_reach,
    foot_shift,
    may_drag,
    pitched,
    shift_as_it_is,
    shift_as_wished,
    waits_little,
)
from polypod.compute import kernel
from polypod.controller.roll import roll_standing, roll_swinging
from polypod.controller.steering import PlanPose, sideways, wrapped
from polypod.controller.swing import foot_along, wished_progress
from polypod.crowd.avoid import apart_from, list_neighbours
from polypod.environment.movers import clear_of_movers, depth_in_mover
from polypod.environment.table import is_forbidden, penetration_at
from polypod.math.quat import Quat, angle_of, conjugate, load_quat, slerp, store_quat
from polypod.math.vec3 import Vec3, length, load_vec3, mix, store_vec3
from polypod.morphology.roll import FLAT
from polypod.spine.chain import keep_bend, place_segments
from polypod.spine.yielding import yields

# Shares of a frame's advance that are tried in turn; 0, the pose before, is always possible.
ADVANCES = (1.0, 0.75, 0.5, 0.3, 0.15, 0.05, 0.0)
# A body is moved so often to where its feet have been carried.
CARRIED_TRIES = 4
# The body rises or sinks at most so many leg lengths a pendulum time, and turns so many radians.
FASTEST_RISE = 0.4
FASTEST_TILT = 0.8
# A frame's chord is looked at in so many places, and is halved so often.
CHORD_SAMPLES = 8
SHORTER = 4
# A step must be seen: between two frames in which a foot stands it is shown in the air, or its
# stances would look like a slip.
FRAMES_AIRBORNE = 1.001
NEARLY_DOWN = 0.95
# So many moments of a frame are looked at for what comes without warning.
PUSHES = 4
# And so far is a foot pushed for those between two frames, leg lengths.
LARGEST_PUSH = 0.05
# A foot that its leg could not carry on goes on by so much of its way that it pulls at the body by
# this share of what may be pulled: that draws the body back out of a pocket.
DRAWN = 0.9
# How deep the straight way between two frames may cut into what is stepped on, leg lengths.
CUT = 0.006


@kernel
def chord_is_free(dt: float, accepted: float, before: Vec3, after: Vec3, env: Any) -> bool:
    """Return whether the straight way of a foot in one frame crosses nothing forbidden.

    Nor goes deeper than `accepted` (m) into anything on its way.
    """
    for i in range(1, CHORD_SAMPLES + 1):
        share = i / CHORD_SAMPLES
        place = mix(before, after, share)
        if is_forbidden(env, place.x, place.z, 0.0):
            return False
        if i < CHORD_SAMPLES:
            depth, _ = penetration_at(env, place, (share - 1.0) * dt)
            if depth > accepted:
                return False
    return True


@kernel
def cleared(env: Any, place: Vec3, ahead: float, own: int, accepted: float) -> Vec3:
    """Return a place, or the one by it that nothing that moves takes up `ahead` s from now.

    What the foot is to land on, `own`, is left alone up to a depth of `accepted`, m.
    """
    if own >= 0 and depth_in_mover(env, own, place, ahead) > accepted:
        own = -1
    return clear_of_movers(env, place, ahead, own)


@kernel
def pushed_aside(c: int, k: int, sole: Vec3, state: Any, tables: Any, env: Any) -> Vec3:
    """Return where a foot gets in a frame in which something comes without warning, world.

    What is played between two frames is a straight line: it is cleared at four moments.
    """
    own = state.landing_support[c, k]
    before = load_vec3(state.foot_shown[c, k])
    dt = state.frame[c]
    accepted = CUT * tables.legs.length[k]
    sole = cleared(env, sole, 0.0, own, accepted)
    for j in range(1, PUSHES):
        share = j / PUSHES
        place = mix(before, sole, share)
        push = (cleared(env, place, (share - 1.0) * dt, own, accepted) - place) * (1.0 / share)
        size = length(push)
        most = LARGEST_PUSH * tables.legs.length[k]
        sole = sole + push * (min(size, most) / max(size, 1e-12))
    return sole


@kernel
def may_go(
    c: int, k: int, progress: float, sole: Vec3, turn: Quat, state: Any, tables: Any, env: Any,
    scratch: Any,
) -> bool:  # fmt: skip
    """Return whether a foot may be at `sole` at the end of the frame.

    What is played of the frame is a straight way; and where its leg could not carry the foot on
    before, the body is drawn along, but by no more than a frame's worth.
    """
    unit = tables.legs.length[k]
    if not chord_is_free(state.frame[c], CUT * unit, load_vec3(state.foot_shown[c, k]), sole, env):
        return False
    if state.waiting[c, k] == 0.0 and state.caught[c] != k + 1:
        return True
    foot_turn = pitched(turn, scratch.pitch[k, 0])
    position = load_vec3(state.position[c])
    body_turn = load_quat(state.rotation[c])
    bend = scratch.bend[k, 0]
    shift = foot_shift(c, k, sole, foot_turn, bend, state, tables, position, body_turn)
    return length(shift) <= DRAWN * (EARLY_PULL if progress < EARLY else LATE_PULL) * unit


@kernel
def wish_feet(
    c: int, dt: float, state: Any, command: Any, tables: Any, env: Any, scratch: Any
) -> None:
    """Write to the scratch where every foot should be at the end of the frame.

    A foot that catches up takes frames farther apart than it was planned with: where their chord
    cuts the corner of something forbidden that the path goes round, it goes less far.
    """
    for k in range(state.swinging.shape[1]):
        scratch.progress[k] = 0.0
        sole = load_vec3(state.foot[c, k])
        turn = load_quat(state.foot_rotation[c, k])
        if state.swinging[c, k] and not state.reaching[c, k]:
            now = state.swing_progress[c, k]
            progress = wished_progress(c, k, dt, state)
            if state.airborne[c, k] + dt <= FRAMES_AIRBORNE * state.frame[c]:
                progress = min(progress, NEARLY_DOWN)
            for attempt in range(SHORTER + 1):
                sole, turn = foot_along(c, k, progress, state, env)
                roll_swinging(c, k, dt, progress, state, scratch)
                if attempt == SHORTER or may_go(
                    c, k, progress, sole, turn, state, tables, env, scratch
                ):
                    break
                progress = 0.5 * (now + progress)
            if env.mover_count > 0:
                sole = pushed_aside(c, k, sole, state, tables, env)
            scratch.progress[k] = progress
        else:
            roll_standing(c, k, dt, state, command, tables, scratch)
        store_vec3(scratch.sole[k], sole)
        store_quat(scratch.turn[k], turn)


@kernel
def comes_along(
    c: int, k: int, shift: Vec3, state: Any, tables: Any, env: Any, scratch: Any
) -> bool:
    """Return whether a swinging foot may come along with its body, off its path by `shift`."""
    unit = tables.legs.length[k]
    if not state.swinging[c, k] or scratch.progress[k] >= NEARLY_DOWN:
        return False
    sole = load_vec3(scratch.sole[k]) + shift
    return chord_is_free(state.frame[c], CUT * unit, load_vec3(state.foot_shown[c, k]), sole, env)


@kernel
def feet_fit(
    c: int, goes_on: bool, position: Vec3, turn: Quat, state: Any, tables: Any, env: Any,
    scratch: Any,
) -> bool:  # fmt: skip
    """Return whether every foot is within reach of a body pose, swinging ones as far as they may.

    A swinging foot goes on along its path if its leg can follow, and a standing one rolls on. Else
    they wait as they are: that is noted in `scratch.held`. The feet themselves are not moved. In
    runs the body does not wait for swinging feet, nor where it `goes_on` for those that may come
    along: see `landing.dragged`.
    """
    tolerance = TOLERANCE * tables.leg_length
    for k in range(state.swinging.shape[1]):
        scratch.held[k] = False
        if state.reaching[c, k]:
            continue
        sole = load_vec3(scratch.sole[k])
        shift = shift_as_wished(c, k, sole, state, tables, scratch, position, turn)
        if length(shift) <= 2.0 * tolerance or (state.swinging[c, k] and may_drag(c, state)):
            continue
        if goes_on and comes_along(c, k, shift, state, tables, env, scratch):
            continue
        if not state.swinging[c, k] and tables.legs.roll_kind[k] == FLAT:
            return False
        scratch.held[k] = True
        sole = load_vec3(state.foot[c, k])
        shift = shift_as_it_is(c, k, sole, state, tables, position, turn)
        if length(shift) > 2.0 * tolerance:
            return False
    return True


@kernel
def settle_body(
    c: int, dt: float, pose: PlanPose, height: float, sway: float, state: Any, command: Any,
    tables: Any, env: Any, scratch: Any,
) -> None:  # fmt: skip
    """Move the body as far toward its wished pose as its legs allow, and the swinging feet along.

    The body first moves least so that all soles are within reach. Where that is not enough, shares
    of the frame's advance are tried down to none: the pose before was within reach of every foot,
    so a pose that keeps all soles always exists. First of all it is tried to wait but little for
    feet in the air. `sway` is how far left of that pose it shall be.
    """
    before = load_vec3(state.position[c])
    turn_before = load_quat(state.rotation[c])
    turn = trunk_rotation(c, pose.heading, state)
    # A body that was held back does not jump to where it would be by now.
    pendulum = tables.pendulum_time
    most = FASTEST_RISE * tables.leg_length / pendulum * dt + abs(state.heave_step[c])
    asked = height
    height = min(before.y + most, max(before.y - most, height))
    angle = angle_of(turn * conjugate(turn_before))
    turn = slerp(turn_before, turn, min(1.0, FASTEST_TILT / pendulum * dt / max(angle, 1e-9)))
    wished = sideways(Vec3(pose.x, height, pose.z), pose.heading, sway)
    wish_feet(c, dt, state, command, tables, env, scratch)
    asked_for = wished
    wished = body_within_reach(c, True, state, tables, scratch, wished, turn)
    if yields(c, wished, turn, state, tables, scratch):
        wished = body_within_reach(c, True, state, tables, scratch, asked_for, turn)
    heading_before = state.heading[c]
    turning = wrapped(pose.heading - heading_before)
    near = list_neighbours(c, tables.leg_length, state, scratch) if state.crowded[c] else 0
    going = waits_little(c, asked_for, wished, before, state, tables, scratch, turn)
    for attempt in range(-1, len(ADVANCES)):
        goes_on = attempt < 0
        if goes_on and going == wished:
            continue
        share = ADVANCES[max(attempt, 0)]
        position = going if goes_on else mix(before, wished, share)
        turned = slerp(turn_before, turn, share)
        heading = heading_before + share * turning
        apart = True
        if share < 1.0:
            place_segments(c, share, state, tables)
        if near > 0 and share > 0.0:
            x, z, apart = apart_from(c, near, position.x, position.z, heading, state, scratch)
            position = Vec3(x, position.y, z)
        fits = apart and feet_fit(c, goes_on, position, turned, state, tables, env, scratch)
        if share == 0.0 and not fits and env.mover_count > 0:
            # What some feet stand on has carried the body away from the others.
            for _ in range(CARRIED_TRIES):
                position = body_within_reach(c, True, state, tables, scratch, position, turned)
                fits = feet_fit(c, False, position, turned, state, tables, env, scratch)
                if fits:
                    break
        if fits or share == 0.0:
            state.held[c] = share
            keep_bend(c, share, state, tables)
            store_vec3(state.position[c], position)
            store_quat(state.rotation[c], turned)
            state.heading[c] = wrapped(heading)
            state.sway[c] += share * (sway - state.sway[c])
            # What smooths the height goes on from where the body is, or it would snap back.
            if abs(position.y - asked) > TOLERANCE * tables.leg_length:
                state.lift[c, 0] += position.y - asked
            break
