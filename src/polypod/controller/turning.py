"""How fast a creature turns, and how fast it walks meanwhile: on the spot, or on arcs."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from polypod.compute import kernel

# Who goes faster than this, leg lengths a pendulum time, walks on in a turn if its spine bends.
WALKING = 0.03
# It takes so many times as long to turn as it takes to walk to where its foremost girdle is. A body
# that reaches ahead half as far as this, leg lengths, or farther, takes less: it is led by its head
# (`spine.leading`), or its front swings in a time of its own (`spine.bend`).
FOLLOWING = 2.8
SLOW = 0.1  # leg lengths a pendulum time: who is slower turns as who stands
LONGEST_FRONT = 2.0
# Not so among what it does not get past, or where it passes to a side of that, by more than so
# many radians.
PASSING = 0.05
# And turns at this share of its turn rate at least, however slowly it gets on.
SLOWEST_TURN = 0.05


class TurnRule(NamedTuple):
    """How a creature turns."""

    share: float  # of the speed asked for, meanwhile
    response: float  # s in which the turn rate follows
    limit: float  # rad/s, the fastest


@kernel
def turn_rule(
    c: int, speed: float, speed_asked: float, error: float, free: float, state: Any, tables: Any,
    settings: Any,
) -> TurnRule:  # fmt: skip
    """Return how a creature at a speed, m/s, turns by an `error` of its heading, rad.

    `free` is how far ahead of it nothing is in the way that it knows of, m.
    """
    pendulum = tables.pendulum_time
    # Who must turn far turns first: full speed would circle round the place it is to go to.
    share = min(1.0, max(0.1, 1.4 * math.cos(error)))
    response = settings.turn_response * pendulum
    fastest = settings.turn_rate / pendulum
    front = tables.girdles.place[tables.girdles.place.shape[0] - 1]
    # On the spot no faster than the feet at a long body's ends can step.
    limit = fastest * (tables.leg_length / max(front, tables.leg_length))
    curl = min(settings.spine, 1.0) * tables.bend.tightest
    if state.halts[c] > 0 or state.caught[c] > 0 or abs(state.shy[c]) > PASSING:
        free = 0.0
    if curl <= 0.0 or free < 2.0 * abs(math.sin(min(abs(error), 0.5 * math.pi))) / curl:
        return TurnRule(share, response, limit)
    # Who bends walks on along an arc that its spine can lie on, and turns on the spot only where it
    # stands.
    share = max(share, min(1.0, fastest / (curl * max(speed_asked, 1e-9))))
    # The head is first in a turn, and the middle follows when it comes to where that began.
    front = max(min(front, LONGEST_FRONT * tables.leg_length - front), 0.0)
    pace = speed_asked * pendulum / tables.leg_length
    goes = max(pace, speed * pendulum / tables.leg_length)
    follows = FOLLOWING * front / tables.leg_length * goes / (goes * goes + SLOW * SLOW)
    response = max(response, follows * pendulum)
    limit = min(fastest, max(curl * speed, limit * max(1.0 - pace / WALKING, SLOWEST_TURN)))
    return TurnRule(share, response, limit)
