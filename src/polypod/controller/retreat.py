"""A body that goes back for a foot that is caught: its own way round is out of its leg's reach.

What is forbidden is passed around, and a leg that was carried on beside it may hang behind it: the
foot cannot follow its body, and the body is held by the foot. Then the body gives way.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.body.push import is_thrown, load_deflection
from polypod.compute import kernel
from polypod.controller.rest import rest_offset

# A foot is caught that found no place for so many cycles, or could not go on in the air. It is free
# once it has landed, or after so many leg pendulum times: then something else is in the way.
CAUGHT = 0.5
CAUGHT_IN_AIR = 0.2
# Where nothing is forbidden feet hang on what the body will soon have left behind, but seldom long.
CAUGHT_IN_THE_OPEN = 1.5
LONGEST = 24.0
# The body goes back by so many leg lengths a pendulum time, up to where the leg is at rest.
SPEED = 0.25
# Then the way leads to the other side, by so many radians for each time, up to a limit; that
# is forgotten within so many pendulum times.
SHY = 0.6
MOST_SHY = 1.2
FORGET = 30.0


@kernel
def note_caught(c: int, dt: float, state: Any, tables: Any, env: Any) -> None:
    """Note which foot is caught, if any: of several the one that has waited for longest.

    One that stands is so only by what is forbidden: if it waits before a trench, no way back helps.
    """
    count = state.swinging.shape[1]
    state.caught_clock[c] += dt
    state.shy[c] *= math.exp(-dt / (FORGET * tables.pendulum_time))
    caught = int(state.caught[c])
    if caught > 0:
        k = caught - 1
        landed = not state.swinging[c, k] and state.waiting[c, k] == 0.0
        if landed or state.caught_clock[c] > LONGEST * tables.pendulum_time:
            state.caught[c] = 0
            state.caught_clock[c] = 0.0
            away = -SHY * tables.legs.side[k]
            state.shy[c] = min(max(state.shy[c] + away, -MOST_SHY), MOST_SHY)
        return
    if is_thrown(load_deflection(c, state), tables):
        return  # its feet wait for the body to come to them
    most = 1.0
    for k in range(count):
        bound = CAUGHT_IN_AIR if state.swinging[c, k] else CAUGHT
        if env.forbidden_count == 0:
            bound = CAUGHT_IN_THE_OPEN if state.swinging[c, k] else math.inf
        cycles = state.waiting[c, k] * state.cycle_rate[c] / bound
        if cycles > most and not state.reaching[c, k]:
            most = cycles
            state.caught[c] = k + 1
            state.caught_clock[c] = 0.0


@kernel
def way_back(c: int, state: Any, tables: Any, settings: Any) -> tuple[float, float]:
    """Return the velocity, world x and z, at which the body goes back for a foot; 0: for none."""
    caught = int(state.caught[c])
    if caught == 0:
        return 0.0, 0.0
    k = caught - 1
    offset = rest_offset(c, k, state.heading[c], state, tables, settings)
    x = state.foot[c, k, 0] - offset.x - state.position[c, 0]
    z = state.foot[c, k, 2] - offset.z - state.position[c, 2]
    away = math.hypot(x, z)
    most = SPEED * tables.leg_length / tables.pendulum_time
    speed = min(most, away / tables.pendulum_time)
    share = speed / max(away, 1e-12)
    return x * share, z * share
