"""A spine bends: P2's four steps for one creature in a step (P2 5, Figure 15)."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.smoothing import follow
from polypod.body.support import FeetPlane
from polypod.compute import kernel
from polypod.controller.steering import PlanPose
from polypod.math.quat import Quat
from polypod.math.vec3 import Vec3, store_vec3
from polypod.spine.advancing import MOMENTS, RELAX, left_along, note_track, note_way, yaw_along
from polypod.spine.chain import place_segments
from polypod.spine.curve import draw_curve, room_for
from polypod.spine.elevation import bounce_girdles, carry_girdles, induce, roll_girdles
from polypod.spine.leading import is_walking
from polypod.spine.orientation import pass_back, turn_neck, wished_gaze
from polypod.spine.struck import yield_to_push
from polypod.spine.tail import swing_tail
from polypod.spine.wave import send_wave

# Girdles follow what they are to do within so many leg pendulum times, and the head.
SMOOTH = 0.6
SMOOTH_GAZE = 0.5
# One that is farther ahead than this, leg lengths, within the time in which it walks the rest, if
# it does so faster than this, leg lengths a pendulum time.
AT_ONCE = 0.4
STANDING = 0.03
# What `follow` lags behind what moves steadily by, shares of its time.
LAG = 0.75
# What is left of it below this share, of a spine that shall not bend, is nothing.
STRAIGHT = 1e-9
# How much a spine bends follows settings and course within so many leg pendulum times.
ADOPT = 2.0


@kernel
def bend_spine(
    c: int, dt: float, pose: PlanPose, plane: FeetPlane, state: Any, command: Any, tables: Any,
    settings: Any, scratch: Any,
) -> None:  # fmt: skip
    """Say how the spine is to bend by the end of a step, at the end of which the body has `pose`.

    The angles of its joints are left in `spine_wish`, and its segments are where these put them.
    """
    rigid = settings.spine <= 0.0 and state.spine_share[c, 1, 0] < STRAIGHT
    if tables.spine.joint.shape[0] == 0 or rigid:
        return
    pendulum = tables.pendulum_time
    along = max(0.0, math.cos(command.travel[c]))
    follow_way(c, dt, pose, settings.spine * along, state, command, tables)
    follow(state.spine_share[c, 1], settings.spine, ADOPT * pendulum, dt)
    note_track(c, dt, pose, state, command, tables, settings)
    note_way(c, pose, state, command, tables, settings)
    guide_girdles(c, dt, pose, state, tables, scratch)
    seconds = 4.0 * pendulum
    if state.cycle_rate[c] > 0.0:
        seconds = min(seconds, 1.0 / state.cycle_rate[c])
    carry_girdles(c, dt, settings.height_smoothing * seconds, plane, state, tables)
    roll_girdles(c, dt, settings.tilt_smoothing * seconds, plane, state, tables, settings, scratch)
    node = scratch.node
    more = scratch.more
    for g in range(node.shape[0]):
        for axis in range(node.shape[1]):
            node[g, axis] = state.girdle_bend[c, g, axis, 0]
            more[g, axis] = node[g, axis]
    bounce_girdles(c, more, state, tables)
    induce(c, dt, more, state, command, tables, settings)
    send_wave(c, more, state, tables, settings, scratch)
    yield_to_push(c, dt, more, state, tables)
    chest, inside = draw_curve(c, more, state, tables)
    # The way comes first: the gait bends the spine by what the limits leave.
    share = 1.0 if inside else room_for(node, more, tables)
    for g in range(node.shape[0]):
        for axis in range(node.shape[1]):
            node[g, axis] += share * (more[g, axis] - node[g, axis])
    if not inside:
        chest, _ = draw_curve(c, node, state, tables)
    move_ends(c, dt, chest, node, state, tables, settings)
    place_segments(c, 1.0, state, tables)


@kernel
def follow_way(
    c: int, dt: float, pose: PlanPose, share: float, state: Any, command: Any, tables: Any
) -> None:
    """Let a spine take on more or less of the track, up to a share of it.

    A long body that stands takes on nothing: legs that step on the spot could follow neither a
    front that swings where it is to go nor a back that stays behind. It straightens, and turns as
    it is, as slowly as it would relax.
    """
    seconds = ADOPT * tables.pendulum_time
    if tables.bend.kept > 0.0 and not is_walking(c, pose.speed, command, tables):
        share = 0.0
        seconds = RELAX * tables.bend.kept / tables.leg_length * tables.pendulum_time
    follow(state.spine_share[c, 0], share, seconds, dt)


@kernel
def swing_seconds(c: int, place: float, speed: float, state: Any, tables: Any) -> float:
    """Return the time in which a girdle follows, s; `place` is how far it is ahead, m.

    One far ahead swings aside no faster than it walks: its feet are to follow it. Who turns on the
    spot steps with all of them, and who is led by its head never swings aside.
    """
    pendulum = tables.pendulum_time
    if state.led[c]:
        return float(SMOOTH * pendulum)
    far = max(place - AT_ONCE * tables.leg_length, 0.0)
    slow = STANDING * tables.leg_length / pendulum
    return float(max(SMOOTH * pendulum, far * speed / (speed * speed + slow * slow)))


@kernel
def guide_girdles(c: int, dt: float, pose: PlanPose, state: Any, tables: Any, scratch: Any) -> None:
    """Let each girdle follow the track: steps 1 and 2 (P2 5.1, 5.2)."""
    place = tables.girdles.place
    lead = state.spine_share[c, 0, 0]
    wish = scratch.wish
    for g in range(place.shape[0]):
        # Where the track is by the time that the filter has caught up.
        seconds = swing_seconds(c, place[g], pose.speed, state, tables)
        ahead = LAG * seconds * pose.speed * min(1.0, lead)
        here = yaw_along(c, ahead, state, tables)
        wish[g] = lead * (yaw_along(c, ahead + place[g], state, tables) - here)
    pass_back(c, wish, state, tables)
    for g in range(place.shape[0]):
        seconds = swing_seconds(c, place[g], pose.speed, state, tables)
        ahead = LAG * seconds * pose.speed * min(1.0, lead)
        left = left_along(c, place[g], lead, ahead, state, tables)
        # No farther than a bend within the limits leads.
        most = abs(0.5 * tables.bend.most_yaw[g] * place[g])
        follow(state.girdle_bend[c, g, 0], min(max(left, -most), most), seconds, dt)
        follow(state.girdle_bend[c, g, 2], wish[g], seconds, dt)


@kernel
def move_ends(
    c: int, dt: float, chest: Quat, node: Any, state: Any, tables: Any, settings: Any
) -> None:
    """Turn neck and head toward the way ahead, and let the tail follow."""
    spine = tables.spine
    share = state.spine_share[c, 1, 0]
    seconds = SMOOTH_GAZE * tables.pendulum_time
    gaze = wished_gaze(c, state.way_ahead[c, MOMENTS - 1, 1], share * settings.gaze, state)
    yaw = follow(state.gaze[c], gaze.x, seconds, dt)
    for s in range(spine.neck, spine.joint.shape[0]):
        store_vec3(state.spine_wish[c, s], Vec3(0.0, 0.0, 0.0))
    if settings.gaze > 0.0:
        turn_neck(c, chest, Vec3(yaw, gaze.y, gaze.z), state, tables)
    swing_tail(
        c,
        dt,
        node[0, 2] - state.girdle_bend[c, 0, 2, 0],
        node[0, 3] - state.girdle_bend[c, 0, 3, 0],
        share * settings.tail,
        state,
        tables,
    )
