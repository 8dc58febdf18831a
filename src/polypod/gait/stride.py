"""How a creature steps at a speed: as an animal would, as far as legs and ground allow."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from polypod.compute import kernel
from polypod.controller.rest import level_height
from polypod.controller.stride import travel_limit
from polypod.gait.tempo import tempo
from polypod.math.intervals import wrap_phase
from polypod.math.vec3 import load_vec3

# A foot that has just lifted falls behind its body until it is as fast, and one that will land goes
# ahead: in a bell-shaped swing by .14 of a stride, times the share of the cycle for which it swings
# to this power. The leg is shorter meanwhile, and the body gives way: half of that counts.
SWING_LAG = 0.07
LAG_POWER = 1.5
# A front foot is out of the way of the one behind it when it has been up for so many cycles. With
# .1 a spider's hind feet found their places taken, landed short, and held the body back at each end
# of a stance: at 1.5 m/s its frames fell to .15 of the speed, now to .99.
GONE = 0.3
# Strides are shortest on ground as steep, or as uneven in hip heights, as this.
STEEP = 0.3
ROUGH = 0.1


class Stride(NamedTuple):
    """How a creature is to step."""

    period: float  # s a cycle
    duty: float  # mean duty factor
    sink: float  # m by which its body is to be lower than it stands


@kernel
def neighbour_limit(start: Any, extent: Any, direction: float, legs: Any) -> float:
    """Return the stance travel at which a foot just reaches the one behind it, metres.

    Of two neighbours on a side, the front one that stands since an earlier touchdown has come back
    toward the hind one: by the lag of their touchdowns times the stride. Arthropods do not let
    their legs cross there; long upright legs pass beside each other.
    """
    limit = math.inf
    across = math.sin(direction)
    along = math.cos(direction)
    for back in range(legs.length.shape[0]):
        if legs.upright[back] or legs.side[back] == 0:
            continue
        for front in range(legs.length.shape[0]):
            if legs.side[front] != legs.side[back] or legs.row[front] != legs.row[back] + 1:
                continue
            duty = 1.0 - extent[back]
            lag = wrap_phase(start[back] + extent[back] - (start[front] + extent[front]))
            left = 1.0 - max(lag - duty, 0.0) / GONE
            if left > 0.0:
                gap = (legs.sole_stance[front, 2] - legs.sole_stance[back, 2]) * along
                gap += (legs.sole_stance[front, 0] - legs.sole_stance[back, 0]) * across
                limit = min(limit, abs(gap) / max(lag, 1e-3) * duty / left)
    return limit


@kernel
def stance_share(duty: float) -> float:
    """Return the part of a leg's reach along the way that is left to the stance."""
    return duty / (duty + 2.0 * SWING_LAG * (1.0 - duty) ** LAG_POWER)


@kernel
def stride_of(
    speed: float, duty_low: float, duty_high: float, user_period: float, start: Any, extent: Any,
    direction: float, caution: float, yaw: float, hip_height: float, leg_length: float,
    upright: bool, legs: Any, stride: Any,
) -> Stride:  # fmt: skip
    """Return the stride at a speed: as an animal's would be, as far as the legs reach.

    Args:
        speed: m/s, of the fastest foot's rest place over the ground.
        duty_low: least mean duty factor.
        duty_high: greatest mean duty factor.
        user_period: s, the cycle's duration that the user wants, NaN: as an animal would.
        start: [K] the gait's disks.
        extent: [K] the gait's disks.
        direction: rad, of the travel from straight ahead.
        caution: share of what a lower body and girdles add to a stride that is not taken.
        yaw: how much girdles of sprawling legs yaw by their feet, 1: as animals' do.
        hip_height: m, from the ground to the hips as the creature stands.
        leg_length: m, hip to sole along the leg.
        upright: legs stand below their hips.
        legs: a LegTable.
        stride: a StrideTable.
    """
    free = tempo(
        speed, hip_height, leg_length, upright, duty_low, duty_high, math.inf, user_period
    )  # fmt: skip
    # Legs reach farther from a lower body, which sinks as far as the stride needs it. Girdles that
    # yaw by their feet are half way back when one of a pair lands long before the other lifts.
    share = stance_share(free.duty)
    yaw *= (1.0 - caution) * min(1.0, 0.5 / free.duty) ** 2
    standing = share * travel_limit(0, direction, yaw, stride)
    lowest = max(share * travel_limit(1, direction, yaw, stride), standing)
    lowest += caution * (standing - lowest)
    most = neighbour_limit(start, extent, direction, legs)
    wished = min(speed * free.duty * free.period, most)
    travel = min(max(wished, standing), lowest)
    sink = (travel - standing) / max(lowest - standing, 1e-12) * stride.sink
    asked = tempo(
        speed, hip_height, leg_length, upright, duty_low, duty_high, min(travel, most), user_period
    )  # fmt: skip
    return Stride(asked.period, asked.duty, sink)


@kernel
def stride_at(c: int, speed: float, state: Any, command: Any, tables: Any, settings: Any) -> Stride:
    """Return a creature's stride at a speed, m/s.

    The gait is that of the state; what the user pins of it is kept, a duty within its range.
    """
    low = state.gait_duty[c, 1]
    high = state.gait_duty[c, 2]
    if not math.isnan(command.duty[c]):
        low = min(max(command.duty[c], low), high)
        high = low
    yaw = state.spine_share[c, 1, 0] * settings.spine_yaw
    return stride_of(
        speed, low, high, command.period[c], state.goal_start[c], state.goal_extent[c],
        command.travel[c], state.caution[c], yaw, tables.hip_height, tables.leg_length,
        tables.upright, tables.legs, tables.stride,
    )  # fmt: skip


@kernel
def wished_caution(c: int, state: Any, tables: Any) -> float:
    """Return how much shorter than on level ground a creature's strides are to be, 0 to 1.

    On steep ground, on things that lie about, and where feet stand or are about to land above or
    below the plane that they make together: people, dogs and horses shorten their strides there.
    """
    most = 0.0
    for k in range(state.swinging.shape[1]):
        place = load_vec3(state.foot[c, k])
        support = state.foot_support[c, k]
        if state.swinging[c, k]:
            place = load_vec3(state.foot_target[c, k])
            support = state.landing_support[c, k]
        if support >= 0:
            return 1.0
        most = max(most, abs(place.y - level_height(c, place.x, place.z, state)))
    steep = math.hypot(state.slope[c, 0], state.slope[c, 1])
    rough = most / (ROUGH * tables.hip_height) + steep / STEEP
    share = min(rough, 1.0)
    return share * share * (3.0 - 2.0 * share)
