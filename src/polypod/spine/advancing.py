"""Step 2: a spine advances along where it was, so its nodes follow the track of the one ahead.

P2 5.2 moves the head and puts the other nodes on the spine of the step before. Here the body is
what is steered, and a spine lies along its track: behind the body centre along the way that it has
come, ahead of it along the way that `steer` will take. So each girdle goes where the one ahead of
it went, at any frame rate, and the head is first in a turn. Who turns on the spot leaves no track:
there the back keeps its heading as far as limits allow, and comes round in its own time, which is
P2's relaxation of the back node. Long bodies are led by their heads: see `spine.leading`.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.controller.steering import PlanPose, steer, wrapped
from polypod.spine.leading import KEPT, follows_head, go_on, keep_bent, kept_yaw, lead_on

# The track behind is kept at so many places.
TRACK = 48
# The way ahead is looked at in so many moments, for so many leg pendulum times and as far as the
# foremost girdle will have come by then that is so many times as far ahead, but not farther.
MOMENTS = 6
FORESIGHT = 2.4
FARTHER = 1.5
FARTHEST = 16.0
# Who is held up is taken to go on at this share of the speed asked for.
HELD_UP = 0.5
# A body that stands straightens within so many pendulum times, a long one for each leg length that
# it reaches back; one that walks faster than this, leg lengths a pendulum time, by its way alone.
RELAX = 3.0
WALKING = 0.08


@kernel
def note_track(
    c: int, dt: float, pose: PlanPose, state: Any, command: Any, tables: Any, settings: Any
) -> None:
    """Take the track behind the body centre, and what is kept ahead of it, to the end of a step.

    `track[c]` are yaws against the present heading, the first `track_gone` behind the body centre
    and the others `track_step` apart.
    """
    # A push turns a body off its path, and not its path.
    heading = pose.heading - pose.aside.heading
    turned = wrapped(heading - state.track_from[c])
    state.track_from[c] = heading
    pendulum = tables.pendulum_time
    along = max(0.0, math.cos(command.travel[c]))
    speed = along * 0.5 * (state.speed[c] + pose.speed)
    # Who is to walk on and is held up stays bent.
    goes = max(speed, along * command.speed[c])
    slow = max(0.0, 1.0 - goes * pendulum / (WALKING * tables.leg_length))
    long = max(1.0, -tables.girdles.place[0] / tables.leg_length)
    left = math.exp(-slow * dt / (RELAX * long * pendulum))
    track = state.track[c]
    for i in range(TRACK):
        track[i] = (track[i] - turned) * left
    step = tables.bend.track_step
    gone = state.track_gone[c] + speed * dt
    while gone >= step:
        gone -= step
        # What the heading was where this sample lies: between here and the sample before.
        here = track[0] * gone / (gone + step)
        for i in range(TRACK - 1, 0, -1):
            track[i] = track[i - 1]
        track[0] = here
    state.track_gone[c] = gone
    led = state.led[c]
    state.led[c] = follows_head(c, pose.speed, state, command, tables, settings)
    if not state.led[c]:
        return
    if not led:
        keep_bent(c, state, tables)
    go_on(c, speed * dt, turned, state, tables)
    error = wrapped(command.heading[c] + pose.detour - heading - state.kept_way[c, KEPT + 1])
    lead_on(c, dt, error, speed, state, command, tables, settings)


@kernel
def note_way(c: int, pose: PlanPose, state: Any, command: Any, tables: Any, settings: Any) -> None:
    """Write where the way leads: for some moments ahead the arc, m, and the yaw against now.

    Who is to walk and is held up for the moment will go on: only who turns on the spot has all of
    its turn where it stands.
    """
    pendulum = tables.pendulum_time
    front = FARTHER * tables.girdles.place[tables.girdles.place.shape[0] - 1]
    slowest = front / (FARTHEST * pendulum)
    speed = max(pose.speed, command.speed[c])
    pace = max(pose.pace, HELD_UP)
    horizon = max(FORESIGHT * pendulum, front / max(speed, slowest))
    dt = horizon / MOMENTS
    along = max(0.0, math.cos(command.travel[c]))
    way = state.way_ahead[c]
    arc = 0.0
    begun = pose.heading - pose.aside.heading
    then = PlanPose(
        pose.x, pose.z, pose.heading, pose.turn_rate, speed, pose.waypoint, pose.corner,
        pose.detour, pace, pose.aside, 0.0,
    )  # fmt: skip
    for i in range(MOMENTS):
        before = then
        then = steer(before, c, state, command, tables, settings, dt, 1.0)
        arc += along * 0.5 * (before.speed + then.speed) * dt
        way[i, 0] = arc
        way[i, 1] = wrapped(then.heading - then.aside.heading - begun)


@kernel
def yaw_along(c: int, place: float, state: Any, tables: Any) -> float:
    """Return the track's yaw, rad against the body's heading, `place` metres ahead of its centre.

    Behind it where negative. Where the way is not known the last of it goes on straight.
    """
    if state.led[c] and 0.0 <= place < tables.bend.kept:
        return kept_yaw(c, place, state, tables)
    if place < 0.0:
        track = state.track[c]
        gone = float(state.track_gone[c])
        behind = -place
        if behind <= gone:
            return float(track[0] * behind / gone)
        along = min((behind - gone) / tables.bend.track_step, TRACK - 1.000001)
        i = int(along)
        return float(track[i] + (track[i + 1] - track[i]) * (along - i))
    way = state.way_ahead[c]
    arc = 0.0
    yaw = 0.0
    for i in range(MOMENTS):
        if way[i, 0] >= place:
            share = (place - arc) / max(way[i, 0] - arc, 1e-12)
            return yaw + (way[i, 1] - yaw) * share
        arc = way[i, 0]
        yaw = way[i, 1]
    return yaw


@kernel
def left_along(c: int, place: float, lead: float, ahead: float, state: Any, tables: Any) -> float:
    """Return how far to the left of the body's axis the track is, m, `place` ahead of its centre.

    Of a track that is looked at `ahead` metres farther on and taken on by a share, `lead`; by
    Simpson's rule, in pieces no longer than a leg.
    """
    here = yaw_along(c, ahead, state, tables)
    pieces = max(math.ceil(abs(place) / tables.leg_length), 1)
    piece = place / pieces
    left = 0.0
    before = 0.0
    for i in range(pieces):
        half = yaw_along(c, ahead + (i + 0.5) * piece, state, tables) - here
        whole = math.sin(lead * (yaw_along(c, ahead + (i + 1.0) * piece, state, tables) - here))
        left += piece * (before + 4.0 * math.sin(lead * half) + whole) / 6.0
        before = whole
    return left
