"""The tail: it lies along the way that its body came, and swings after it.

What the gait turns the hindmost girdle by runs down the tail and fades, each segment a little later
than the one before: a wave that travels, as the tails of lizards show.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.body.smoothing import follow
from polypod.compute import kernel
from polypod.math.vec3 import Vec3, store_vec3
from polypod.spine.advancing import yaw_along
from polypod.spine.chain import within

# Each segment follows the one before within so many leg pendulum times.
LAG = 0.9


@kernel
def swing_tail(
    c: int, dt: float, yaw: float, pitch: float, share: float, state: Any, tables: Any
) -> None:
    """Write the angles of the tail's joints.

    Args:
        c: the creature.
        dt: s.
        yaw: of the segment that the tail hangs on, by its gait, against the body's axis, rad.
        pitch: the same.
        share: how much the tail moves, 0: it is stiff.
        state: of the herd.
        tables: of the herd.
    """
    spine = tables.spine
    count = spine.joint.shape[0]
    tail = spine.tail_joint.shape[0]
    # It is longer than its lag is quick, whatever its number of segments.
    seconds = LAG * tables.pendulum_time / max(math.sqrt(float(tail)), 1.0)
    lead = state.spine_share[c, 0, 0]
    before = yaw_along(c, min(spine.girdle_rest[0, 2], 0.0), state, tables)
    for t in range(tail):
        was_yaw = yaw
        was_pitch = pitch
        yaw = follow(state.tail_sway[c, t, 0], yaw, seconds, dt)
        pitch = follow(state.tail_sway[c, t, 1], pitch, seconds, dt)
        middle = 0.5 * (spine.tail_pivot_rest[t, 2] + spine.tail_pivot_rest[t + 1, 2])
        along = yaw_along(c, min(middle, 0.0), state, tables)
        # A tail leads backward: its front is up where its girdle's is.
        angles = Vec3(
            share * (yaw - was_yaw + lead * (along - before)), share * (pitch - was_pitch), 0.0
        )
        before = along
        store_vec3(state.spine_wish[c, count + t], within(angles, spine.tail_limit[t]))
