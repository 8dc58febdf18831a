"""A push bends the spine: the struck girdle goes ahead of the others (P2 5.2, 6, Figure 22).

What a blow does to the trunk as a whole, that it moves and turns, is `polypod.body.blow`'s. Beside
that a trunk bends as a free beam in its first mode: where an end is struck, that end goes with the
push and the middle stays behind, where the middle is struck both ends do. It springs back,
critically damped and solved exactly, so that the frame rate does not matter.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from polypod.compute import kernel
from polypod.morphology.types import FloatArray, IntArray

# Share of the struck place's speed that goes into the bend.
BENDS = 0.5
# The trunk springs back at so many times the rate at which the body comes back to its path, and
# bends either way by no more than this, rad.
SPRING = 3.0
FARTHEST = 0.5


def bend_by_blow(velocity: FloatArray, at: float, rows: IntArray, state: Any, tables: Any) -> None:
    """Let an impulse bend the spines of the creatures of a herd's rows.

    Args:
        velocity: [N, 3] of the struck place, world, m/s.
        at: how far ahead of the body centre it is struck, m.
        rows: [N].
        state: of the herd.
        tables: of the herd.
    """
    half = half_span(tables)
    if half <= 0.0:
        return
    heading = state.heading[rows]
    left = velocity[:, 0] * np.cos(heading) - velocity[:, 2] * np.sin(heading)
    place = min(abs(at) / half, 1.0)
    rate = BENDS * left * (1.5 * place * place - 0.5) / half
    # What would bend it beyond that is lost.
    most = FARTHEST * math.e * SPRING * tables.recovery
    state.spine_struck[rows, 1] = np.clip(state.spine_struck[rows, 1] + rate, -most, most)


def half_span(tables: Any) -> float:
    """Return half of the way from the hindmost girdle to the foremost, m; 0: a rigid trunk."""
    place = tables.girdles.place
    return 0.5 * float(place[-1] - place[0]) if len(tables.spine.joint) else 0.0


@kernel
def yield_to_push(c: int, dt: float, node: Any, state: Any, tables: Any) -> None:
    """Bend the nodes [G, 5] by what pushes left of a bend, and let that spring back."""
    struck = state.spine_share[c, 1, 0] * spring_back(c, dt, state, tables)
    place = tables.girdles.place
    half = 0.5 * (place[place.shape[0] - 1] - place[0])
    if struck == 0.0 or half <= 0.0:
        return
    for g in range(place.shape[0]):
        node[g, 0] += 0.5 * struck * place[g] * place[g] / half
        node[g, 2] += struck * place[g] / half


@kernel
def spring_back(c: int, dt: float, state: Any, tables: Any) -> float:
    """Advance the bend that pushes gave a spine; return it: the foremost girdle's yaw, rad."""
    struck = state.spine_struck[c]
    if struck[0] == 0.0 and struck[1] == 0.0:
        return 0.0
    pole = SPRING * tables.recovery
    decay = math.exp(-pole * dt)
    drift = struck[1] + pole * struck[0]
    struck[0] = (struck[0] + drift * dt) * decay
    struck[1] = (struck[1] - pole * drift * dt) * decay
    if abs(struck[0]) + abs(struck[1]) / pole < 1e-9:
        struck[0] = 0.0
        struck[1] = 0.0
    return float(struck[0])
