"""Whether a creature gets on: who treads on the spot stops and waits, and tries again later.

Feet that find no place ahead keep stepping where they are, and push the body back as often as it
leans forward. That is seen in how far it has gone, and only there.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.activity import ARRIVED, BLOCKED
from polypod.compute import kernel
from polypod.controller.steering import wrapped
from polypod.routes.aim import aim_at
from polypod.routes.state import BAD_PLACES

# Headway is judged after so many leg pendulum times, more than it takes to turn about, and sooner
# after a wait. Less than this share of the way asked for is none.
JUDGED = 16.0
JUDGED_AGAIN = 5.0
LEAST = 0.1
# Who makes none waits so many pendulum times, each time twice as long up to the longest; among
# others, who move on, less long.
FIRST_WAIT = 6.0
LONGEST_WAIT = 48.0
LONGEST_AMONG_OTHERS = 12.0
# Who keeps a heading among what is forbidden first tries other ways: so often, to one side and the
# other in turn, by so many radians and ever more.
TRIES = 6
ASIDE = 0.7
FARTHER_ASIDE = 0.35
# Something else is asked for where heading or goal are another by so much, rad and leg lengths.
TURNED = 0.2
MOVED = 0.5
# A place that was not got past is so far ahead of the front feet, leg lengths.
AHEAD = 0.3


@kernel
def is_asked_anew(c: int, state: Any, command: Any, tables: Any) -> bool:
    """Return whether something else is asked for than before, and note what."""
    asked = state.asked[c]
    x = 0.0
    z = 0.0
    if command.waypoint_count[c] > 0:
        x = command.waypoints[c, state.waypoint[c], 0]
        z = command.waypoints[c, state.waypoint[c], 1]
    anew = abs(wrapped(command.heading[c] + command.travel[c] - asked[0])) > TURNED
    anew = anew or abs(command.speed[c] - asked[1]) > LEAST * max(command.speed[c], asked[1])
    anew = anew or math.hypot(x - asked[2], z - asked[3]) > MOVED * tables.leg_length
    if anew:
        asked[0] = wrapped(command.heading[c] + command.travel[c])
        asked[1] = command.speed[c]
        asked[2] = x
        asked[3] = z
    return anew


@kernel
def avoid_ahead(c: int, state: Any, command: Any, tables: Any) -> None:
    """Note the place ahead as one that no way shall lead through, and have the way looked for."""
    ways = state.route
    x = state.position[c, 0]
    z = state.position[c, 2]
    aim = aim_at(x, z, state.waypoint[c], ways.corner[c], c, state, command)
    away = max(math.hypot(aim.to_x, aim.to_z), 1e-12)
    front = 0.0
    for k in range(state.swinging.shape[1]):
        front = max(front, tables.legs.sole_stance[k, 2])
    out = min(front + AHEAD * tables.leg_length, away)
    at = ways.bad_count[c] % BAD_PLACES
    ways.bad_place[c, at, 0] = x + aim.to_x / away * out
    ways.bad_place[c, at, 1] = z + aim.to_z / away * out
    ways.bad_count[c] += 1
    ways.clock[c] = math.inf


@kernel
def try_aside(c: int, state: Any) -> None:
    """Lead a creature that keeps a heading to a side, and then to the other."""
    side = -1.0 if state.shy[c] > 0.0 else 1.0
    state.shy[c] = side * (ASIDE + FARTHER_ASIDE * (state.halts[c] // 2))
    state.halts[c] += 1


@kernel
def note_headway(c: int, dt: float, state: Any, command: Any, tables: Any, env: Any) -> None:
    """Judge now and then whether a creature gets on; let it wait, or go another way, if not."""
    x = state.position[c, 0]
    z = state.position[c, 2]
    does = state.activity[c]
    if is_asked_anew(c, state, command, tables):
        state.halted[c] = 0.0
        state.halts[c] = 0
        state.route.bad_count[c] = 0
        state.judged[c, 2] = 0.0
    halted = state.halted[c] > 0.0
    state.halted[c] = max(state.halted[c] - dt, 0.0)
    if state.caught[c] == 0 or env.forbidden_count == 0:
        state.judged[c, 2] += dt
    if halted or does in (ARRIVED, BLOCKED) or command.speed[c] <= 0.0:
        state.judged[c, 2] = 0.0
    # Who has halted is judged from where that was: to shuffle to and fro there is no headway.
    if state.judged[c, 2] <= dt and state.halts[c] == 0:
        state.judged[c, 0] = x
        state.judged[c, 1] = z
    pendulum = tables.pendulum_time
    if state.judged[c, 2] < (JUDGED_AGAIN if state.halts[c] > 0 else JUDGED) * pendulum:
        return
    gone = math.hypot(x - state.judged[c, 0], z - state.judged[c, 1])
    if command.waypoint_count[c] == 0 and env.forbidden_count == 0:
        # Straight ahead: to go back for a foot is none.
        # Who is led by its head is still on the way that it took, when that has turned.
        course = state.heading[c] if state.led[c] else command.heading[c] + command.travel[c]
        gone = math.sin(course) * (x - state.judged[c, 0])
        gone += math.cos(course) * (z - state.judged[c, 1])
    least = LEAST * command.speed[c] * state.judged[c, 2]
    futile = gone < (max(least, MOVED * tables.leg_length) if state.halts[c] > 0 else least)
    state.judged[c, 2] = 0.0
    tries = TRIES if env.forbidden_count > 0 and not state.crowded[c] else 0
    if not futile:
        state.halts[c] = 0
    elif command.waypoint_count[c] > 0 and not state.crowded[c]:
        avoid_ahead(c, state, command, tables)
    elif state.halts[c] < tries:
        try_aside(c, state)
    else:
        longest = LONGEST_AMONG_OTHERS if state.crowded[c] else LONGEST_WAIT
        state.halted[c] = min(FIRST_WAIT * 2.0 ** (state.halts[c] - tries), longest) * pendulum
        state.halts[c] = min(state.halts[c] + 1, tries + 8)
