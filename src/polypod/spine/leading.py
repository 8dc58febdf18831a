"""A long body goes where its head went: the way from the middle to the head, as the head took it.

P2 5.2 moves the head, and the nodes behind it follow along the spine of the step before. A body
that reaches far ahead of its middle must be steered so: were its middle the first to turn, its
head would be beside a way that it never took, and would have to swing there sideways. So its way
is kept as headings from the middle to beyond the foremost girdle. Turning is done at that far end;
the middle turns as the kept way does, and so does everything between them and behind.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.controller.turning import PASSING, WALKING, turn_rule

# The way ahead is kept at so many places and at its far end, which is so many times as far ahead as
# the foremost girdle: filters look a little beyond that.
KEPT = 24
BEYOND = 1.1
# Bodies that reach farther ahead than this, leg lengths, are led by their heads; shorter ones get
# their middle to follow by turning it late (`controller.turning`).
LONG = 2.0


@kernel
def is_walking(c: int, speed: float, command: Any, tables: Any) -> bool:
    """Return whether a creature walks at a speed, m/s, or is asked to."""
    goes = max(speed, command.speed[c])
    return bool(goes * tables.pendulum_time > WALKING * tables.leg_length)


@kernel
def follows_head(
    c: int, speed: float, state: Any, command: Any, tables: Any, settings: Any
) -> bool:
    """Return whether a creature's head leads it on, at a speed, m/s.

    It is long, bends, and walks forward with a heading to keep. Who has waypoints knows all of its
    way, and its head is on it before; who stands, or does not get past something, turns otherwise.
    """
    if tables.bend.kept <= 0.0 or settings.spine <= 0.0:
        return False
    if command.waypoint_count[c] > 0 or command.travel[c] != 0.0:
        return False
    if state.halts[c] > 0 or state.caught[c] > 0 or abs(state.shy[c]) > PASSING:
        return False
    return is_walking(c, speed, command, tables)


@kernel
def kept_yaw(c: int, place: float, state: Any, tables: Any) -> float:
    """Return the kept way's yaw, rad against `track_from`, `place` metres ahead of the middle."""
    way = state.kept_way[c]
    step = tables.bend.kept / KEPT
    along = max(place + float(state.kept_gone[c]), 0.0) / step
    if along < KEPT:
        i = int(along)
        return float(way[i] + (way[i + 1] - way[i]) * (along - i))
    # Between the last place and the far end, where the head is.
    share = (place - (tables.bend.kept - state.kept_gone[c])) / max(state.kept_gone[c], 1e-12)
    return float(way[KEPT] + (way[KEPT + 1] - way[KEPT]) * min(share, 1.0))


@kernel
def go_on(c: int, way_gone: float, turned: float, state: Any, tables: Any) -> None:
    """Take the kept way to the end of a step in which the middle goes and turns, m and rad."""
    way = state.kept_way[c]
    for i in range(KEPT + 2):
        way[i] -= turned
    step = tables.bend.kept / KEPT
    gone = state.kept_gone[c] + way_gone
    while gone >= step:
        gone -= step
        for i in range(KEPT):
            way[i] = way[i + 1]
        way[KEPT] += (way[KEPT + 1] - way[KEPT]) * step / (step + gone)
    state.kept_gone[c] = gone


@kernel
def lead_on(
    c: int, dt: float, error: float, speed: float, state: Any, command: Any, tables: Any,
    settings: Any,
) -> None:  # fmt: skip
    """Turn the far end of the kept way, where the head goes at a speed, m/s.

    Toward what it is in `error` of, rad, along an arc on which the whole body can follow.
    """
    rule = turn_rule(
        c, speed, max(speed, command.speed[c]), error, math.inf, state, tables, settings
    )
    curl = min(settings.spine, 1.0) * tables.bend.tightest
    limit = min(rule.limit, curl * speed)
    response = max(rule.response, dt)
    asked = min(max(error / response, -limit), limit)
    rate = state.front_rate[c]
    rate += (asked - rate) * (1.0 - math.exp(-4.0 * dt / response))
    state.front_rate[c] = min(max(rate, -limit), limit)
    state.kept_way[c, KEPT + 1] += state.front_rate[c] * dt


@kernel
def keep_bent(c: int, state: Any, tables: Any) -> None:
    """Let the kept way be that on which the body lies now, for who begins to be led by its head."""
    place = tables.girdles.place
    last = place.shape[0] - 1
    state.kept_gone[c] = 0.0
    state.front_rate[c] = 0.0
    g = 0
    for i in range(KEPT + 1):
        at = tables.bend.kept * i / KEPT
        while g < last and place[g] < at:
            g += 1
        yaw = state.girdle_bend[c, g, 2, 0]
        if g > 0 and place[g] > at:
            share = (at - place[g - 1]) / (place[g] - place[g - 1])
            before = state.girdle_bend[c, g - 1, 2, 0]
            yaw = before + (yaw - before) * share
        state.kept_way[c, i] = yaw
    state.kept_way[c, KEPT + 1] = state.kept_way[c, KEPT]
