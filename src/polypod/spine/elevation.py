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

from polypod.body.reach import may_drag
from polypod.body.smoothing import follow
from polypod.body.support import LEVEL_WIDTH, FeetPlane, foot_on_its_way
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
# No girdle turns more than so many times as fast as one that takes all of a steady gait's swing to
# turn from side to side: a foot that catches up in two frames does not jerk it round. Feet are up
# to twice as fast. In runs it does as they do: strides are longer by it.
FASTEST_YAW = 1.5
# Who stands could step so many times in a leg pendulum time.
SLOWEST = 0.25
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
def roll_girdles(
    c: int, dt: float, seconds: float, plane: FeetPlane, state: Any, tables: Any, settings: Any,
    scratch: Any,
) -> None:  # fmt: skip
    """Let girdles lie along the slope across their own feet, away from the body's (P2 5.3).

    Where fore and hind feet stand on banks that fall to opposite sides the spine shares the twist
    between its girdles, as far as it rolls. The body lies along what they have in common.
    """
    roll = scratch.wish
    count = roll.shape[0]
    share = settings.tilt_share * tables.tilt_scale * state.spine_share[c, 1, 0]
    mean = 0.0
    for i in range(count):
        g = count - 1 - i
        roll[g] = share * math.atan(own_slope(c, g, plane, state, tables))
        if i > 0:
            gap = tables.bend.roll_gap[g]
            roll[g] = min(max(roll[g], roll[g + 1] - gap), roll[g + 1] + gap)
        mean += roll[g] / count
    for g in range(count):
        follow(state.girdle_bend[c, g, 4], roll[g] - mean, seconds, dt)


@kernel
def own_slope(c: int, g: int, plane: FeetPlane, state: Any, tables: Any) -> float:
    """Return the slope to the left across a girdle's own feet, beside the plane's under all feet.

    It leans to that plane as that leans to level ground.
    """
    sine = math.sin(state.heading[c])
    cosine = math.cos(state.heading[c])
    feet = 0
    x = 0.0
    up = 0.0
    xx = 0.0
    xy = 0.0
    for k in range(tables.girdles.of_leg.shape[0]):
        if tables.girdles.of_leg[k] != g:
            continue
        place = foot_on_its_way(c, k, state)
        off_x = place.x - state.position[c, 0]
        off_z = place.z - state.position[c, 2]
        forward = off_x * sine + off_z * cosine
        left = off_x * cosine - off_z * sine
        over = place.y - plane.height - plane.slope_forward * forward - plane.slope_left * left
        feet += 1
        x += left
        up += over
        xx += left * left
        xy += left * over
    lean = (LEVEL_WIDTH * tables.leg_length) ** 2
    return (xy - x * up / feet) / (xx - x * x / feet + lean * feet)


@kernel
def slope_at(g: int, up: Any, tables: Any) -> float:
    """Return the slope along the spine at a girdle where girdles are so far up [G], m."""
    place = tables.girdles.place
    behind = max(g - 1, 0)
    ahead = min(g + 1, place.shape[0] - 1)
    return (up[ahead] - up[behind]) / (place[ahead] - place[behind])


@kernel
def bounce_girdles(c: int, node: Any, state: Any, tables: Any) -> None:
    """Add to the nodes [G, 5] what their own particles move them by beside the whole trunk (P2 4).

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
def induce(
    c: int, dt: float, node: Any, state: Any, command: Any, tables: Any, settings: Any
) -> None:
    """Add to the nodes' [G, 5] yaw and pitch what their feet induce."""
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
        swing = 0.0
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
            swing += state.swing_extent[c, k]
        node[g, 3] += share * settings.spine_flexion * FLEXION * pitch / feet
        whole = tables.bend.apart * PELVIC_YAW
        part = min(whole * feet / max(size, LEAST_YAW), MOST_YAW_SHARE)
        most = whole * BEYOND
        turned = min(max(part * yaw / feet, -most), most)
        if swing > 0.0 and not may_drag(c, state):
            most = FASTEST_YAW * 2.0 * whole * dt * feet / swing * steady_rate(c, state, tables)
            was = state.girdle_sway[c, g, 1]
            turned = min(max(turned, was - most), was + most)
        state.girdle_sway[c, g, 0] = turned
        # Feet of a long body that turns on the spot would turn each girdle another way.
        yawing = min(share, state.spine_share[c, 0, 0]) if tables.bend.kept > 0.0 else share
        node[g, 2] += yawing * settings.spine_yaw * turned


@kernel
def steady_rate(c: int, state: Any, tables: Any) -> float:
    """Return the cycles a second of a creature's gait, were it not hurried by legs at their end."""
    rate = state.cycle_rate[c] / (1.0 + state.hurry[c])
    return float(max(rate, SLOWEST / tables.pendulum_time))


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
