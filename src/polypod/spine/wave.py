"""The wave of a sprawler's trunk: it stands while the animal walks and travels when it runs.

Girdles that yaw against each other bend the trunk between them to one side and to the other, about
points that stay where they are: a standing wave. In a fast lizard the bend runs from head to tail
(Ritter 1992): halfway between the girdles the trunk yaws as much as they do, a quarter of a stride
before the hind one. The curve through the girdles does so if they go from side to side by as much,
against each other: then the trunk is S-shaped as its feet pass each other, and C-shaped as before
when they are farthest apart.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.spine.elevation import PELVIC_YAW

# The wave stands at this duty factor and above, where a walk ends, and travels as a whole below
# the other.
STANDS = 0.5
TRAVELS = 0.38
# The slope halfway along a Hermite curve whose ends lead straight on, over that of its chord.
STEEPER = 1.5


@kernel
def travelling(duty: float) -> float:
    """Return the share of the wave that travels, 0 to 1, at a mean duty factor of the feet."""
    return min(max((STANDS - duty) / (STANDS - TRAVELS), 0.0), 1.0)


@kernel
def quadrature(needle: float, start: float, extent: float) -> float:
    """Return the rate at which a foot moves ahead of its girdle, as a share of the stride's most.

    1 in the middle of its swing and -1 in the middle of its stance, of a disk whose swing begins
    at `start` and goes on for `extent` of the cycle. Squared, so that hardly anything is left near
    touchdown and lift-off, where legs are at their longest.
    """
    since = (needle - start) % 1.0
    if since < extent:
        return math.sin(math.pi * since / extent) ** 2
    return -(math.sin(math.pi * (since - extent) / (1.0 - extent)) ** 2)


@kernel
def girdle_rate(g: int, c: int, state: Any, tables: Any) -> float:
    """Return the rate at which a girdle's feet yaw it to the left, as `quadrature` gives it.

    A right foot that swings ahead takes the right side along.
    """
    legs = tables.legs
    rate = 0.0
    feet = 0
    for k in range(legs.length.shape[0]):
        if tables.girdles.of_leg[k] == g and not legs.upright[k]:
            own = quadrature(state.needle[c], state.swing_start[c, k], state.swing_extent[c, k])
            rate += -own if legs.sole_stance[k, 0] > 0.0 else own
            feet += 1
    return rate / max(feet, 1)


@kernel
def send_wave(c: int, node: Any, state: Any, tables: Any, settings: Any, scratch: Any) -> None:
    """Add to the nodes' places [G, 5] what lets the wave of a fast sprawler's trunk travel."""
    girdles = tables.girdles
    legs = tables.legs
    swing = 0.0
    feet = 0
    for k in range(legs.length.shape[0]):
        if not legs.upright[k]:
            swing += state.swing_extent[c, k]
            feet += 1
    share = travelling(1.0 - swing / max(feet, 1)) * state.spine_share[c, 1, 0]
    share *= settings.spine_yaw * tables.bend.apart * PELVIC_YAW / STEEPER
    if share <= 0.0:
        return
    left = scratch.wish
    left[0] = 0.0
    mean = 0.0
    behind = girdle_rate(0, c, state, tables)
    for g in range(1, girdles.place.shape[0]):
        rate = girdle_rate(g, c, state, tables)
        span = girdles.place[g] - girdles.place[g - 1]
        left[g] = left[g - 1] + share * 0.5 * (behind - rate) * span
        mean += girdles.weight[g] * left[g]
        behind = rate
    for g in range(girdles.place.shape[0]):
        node[g, 0] += left[g] - mean
