"""Step 3: how high each girdle is carried, and what its own feet turn it by (P2 5.3, 6).

P2 gives each pelvis node its own physics, and the mean of the pitches that its feet induce: for
each foot the perpendicular to the way from the node to the foot. Feet that are all ahead of their
girdle raise its front, feet behind lower it; feet that take turns cancel. So a gallop flexes a
spine while the hind feet swing forward and the fore feet are behind, and stretches it after they
have pushed off, and a trot does little, as in life (BIOMECHANICS 4). Seen from above it is P2's
visual yaw effect: the angle at its girdle between a foot's rest and its present place.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.body.smoothing import follow
from polypod.body.support import FeetPlane
from polypod.compute import kernel
from polypod.controller.rest import place_body

# Share of a foot's pitch that its girdle takes on: erect legs flex their spine.
FLEXION = 0.35
# Sprawling legs yaw their girdles: a lizard's pelvis by so much either way whatever its speed
# (Ritter 1992), rad. Less where its steps are so short that it would yaw so many times as far as
# its feet, and where girdles are close together, as a centipede's.
PELVIC_YAW = math.radians(18.0)
MOST_YAW_SHARE = 2.0
LEAST_YAW = 0.02
# Feet that step far for once yaw a girdle by no more than so many times that.
BEYOND = 1.15


@kernel
def carry_girdles(
    c: int, dt: float, seconds: float, plane: FeetPlane, state: Any, tables: Any
) -> None:
    """Let girdles follow the ground under their own feet, away from the plane under all feet.

    Two girdles are on that plane; of more each has its own height, and its pitch by the next ones'.
    """
    girdles = tables.girdles
    count = girdles.place.shape[0]
    if count < 3:
        return
    share = state.spine_share[c, 1, 0]
    mean = 0.0
    middle = 0.0
    for k in range(tables.legs.length.shape[0]):
        mean += state.foot_target[c, k, 1] / tables.legs.length.shape[0]
        middle += girdles.place[girdles.of_leg[k]] / tables.legs.length.shape[0]
    bend = state.girdle_bend[c]
    for g in range(count):
        up = 0.0
        feet = 0
        for k in range(tables.legs.length.shape[0]):
            if girdles.of_leg[k] == g:
                up += state.foot_target[c, k, 1]
                feet += 1
        level = mean + plane.slope_forward * (girdles.place[g] - middle)
        follow(bend[g, 1], share * (up / feet - level), seconds, dt)
    for g in range(count):
        bend[g, 3, 0] = math.atan(slope_at(g, bend[:, 1, 0], tables))


@kernel
def slope_at(g: int, up: Any, tables: Any) -> float:
    """Return the slope along the spine at a girdle where girdles are so far up [G], m."""
    place = tables.girdles.place
    behind = max(g - 1, 0)
    ahead = min(g + 1, place.shape[0] - 1)
    return (up[ahead] - up[behind]) / (place[ahead] - place[behind])


@kernel
def bounce_girdles(c: int, node: Any, state: Any, tables: Any) -> None:
    """Add to the nodes [G, 4] what their own particles move them by beside the whole trunk (P2 4).

    Heave and nod are the body's own; of two girdles nothing is left.
    """
    girdles = tables.girdles
    count = girdles.place.shape[0]
    if count < 3:
        return
    mean = 0.0
    middle = 0.0
    for g in range(count):
        mean += girdles.weight[g] * state.girdle_offset[c, g]
        middle += girdles.weight[g] * girdles.place[g]
    along = 0.0
    spread = 0.0
    for g in range(count):
        lever = girdles.place[g] - middle
        along += girdles.weight[g] * lever * state.girdle_offset[c, g]
        spread += girdles.weight[g] * lever * lever
    share = state.spine_share[c, 1, 0]
    for g in range(count):
        own = state.girdle_offset[c, g] - mean - along / spread * (girdles.place[g] - middle)
        node[g, 1] += share * own


@kernel
def induce(c: int, node: Any, state: Any, command: Any, tables: Any, settings: Any) -> None:
    """Add to the nodes' yaw and pitch [G, 4] what their feet induce."""
    girdles = tables.girdles
    legs = tables.legs
    share = state.spine_share[c, 1, 0]
    sine = math.sin(state.heading[c])
    cosine = math.cos(state.heading[c])
    for g in range(girdles.place.shape[0]):
        rest = tables.spine.girdle_rest[g]
        own = state.girdle_bend[c, g, 2, 0]
        yaw = 0.0
        pitch = 0.0
        size = 0.0
        feet = 0
        for k in range(legs.length.shape[0]):
            if girdles.of_leg[k] != g:
                continue
            feet += 1
            x = state.foot[c, k, 0] - state.position[c, 0]
            z = state.foot[c, k, 2] - state.position[c, 2]
            left = x * cosine - z * sine - state.girdle_bend[c, g, 0, 0]
            ahead = x * sine + z * cosine - rest[2]
            at_left = left * math.cos(own) - ahead * math.sin(own)
            at_ahead = left * math.sin(own) + ahead * math.cos(own)
            stand = place_body(c, k, state, tables)
            stand_ahead = stand.z - rest[2]
            if legs.upright[k]:
                height = rest[1] - stand.y
                pitch += math.atan2(at_ahead, height) - math.atan2(stand_ahead, height)
                continue
            yaw += math.atan2(
                at_left * stand_ahead - at_ahead * stand.x,
                at_ahead * stand_ahead + at_left * stand.x,
            )
            size += step_yaw(c, k, stand.x, state, command)
        node[g, 3] += share * settings.spine_flexion * FLEXION * pitch / feet
        whole = tables.bend.apart * PELVIC_YAW
        part = min(whole * feet / max(size, LEAST_YAW), MOST_YAW_SHARE)
        most = whole * BEYOND
        turned = min(max(part * yaw / feet, -most), most)
        # Feet of a long body that turns on the spot would turn each girdle another way.
        yawing = min(share, state.spine_share[c, 0, 0]) if tables.bend.kept > 0.0 else share
        node[g, 2] += yawing * settings.spine_yaw * turned


@kernel
def step_yaw(c: int, k: int, beside: float, state: Any, command: Any) -> float:
    """Return how far to either side a foot turns about its girdle with its partner in turns, rad.

    `beside` is how far beside the girdle it rests, m. While one foot is at its end the partner,
    half a cycle behind, is the nearer to the other end the less they overlap.
    """
    rate = state.cycle_rate[c]
    if rate <= 0.0:
        return 0.0
    duty = 1.0 - state.swing_extent[c, k]
    way = state.speed[c] * math.cos(command.travel[c]) * duty / rate
    return math.atan2(0.5 * abs(way), abs(beside)) * min(1.0, 0.5 / duty)
