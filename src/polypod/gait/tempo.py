"""How long a cycle lasts and how long a foot stands, from speed and morphology.

Upright animals: stride 2.3 h Fr^0.3 (Alexander 1976), contact 0.80 h^0.84 / v^0.87 s (Hoyt, Wickler
& Cogger 2000). Sprawling ones and arthropods: stride 2.1 L (v^2 / (g L))^0.275 and a constant swing
time, both fitted to the desert iguana (Fieler & Jayne 1998). Metres, seconds.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from polypod.compute import kernel
from polypod.gait.library import SPRAWLER_STRIDE, SPRAWLER_STRIDE_POWER, SPRAWLER_SWING

GRAVITY = 9.81  # m/s^2
# Slowest cycle, in units of sqrt(length / g): below it strides shorten instead. A man at .3 m/s
# takes 6 with h, a fly that creeps at 5 Hz 12 with L.
LONGEST_PERIOD_UPRIGHT = 6.0
LONGEST_PERIOD_SPRAWLING = 12.0
# Fastest cycle, in units of sqrt(L / g): cheetah .9, ant .9, cockroach, iguana and horse 1.0 to
# 1.2; film creatures may be a little quicker.
SHORTEST_PERIOD = 0.6
# Comfortable speeds: Froude numbers of .2 for upright legs and .06 for sprawling ones.
UPRIGHT_SPEED, SPRAWLING_SPEED = 0.45, 0.25
# Of a stance too long for upright legs so much is taken from the duty, in logarithms, and the rest
# from the period: both are then nearest to a racehorse's of 9 to 17 m/s (Witte 2006).
DUTY_SHORTENED = 0.3


class Tempo(NamedTuple):
    """How a creature steps: the cycle's duration in s, and the mean duty."""

    period: float
    duty: float


@kernel
def froude_number(speed: float, length: float) -> float:
    """Return v^2 / (g h) for a speed in m/s and a length in m."""
    return speed * speed / (GRAVITY * length)


@kernel
def natural_tempo(speed: float, hip_height: float, leg_length: float, upright: bool) -> Tempo:
    """Return the tempo that an animal of this build would take, whatever its gait; speed above 0.

    The period stays below the longest; the duty is the animal's own and within [.05, .95].
    """
    if upright:
        stride = 2.3 * hip_height * froude_number(speed, hip_height) ** 0.3
        contact = 0.80 * hip_height**0.84 / speed**0.87
        duty = contact * speed / stride
        longest = LONGEST_PERIOD_UPRIGHT * math.sqrt(hip_height / GRAVITY)
    else:
        froude = froude_number(speed, leg_length)
        stride = SPRAWLER_STRIDE * leg_length * froude**SPRAWLER_STRIDE_POWER
        duty = 1.0 - SPRAWLER_SWING * math.sqrt(leg_length / GRAVITY) * speed / stride
        longest = LONGEST_PERIOD_SPRAWLING * math.sqrt(leg_length / GRAVITY)
    return Tempo(min(stride / speed, longest), min(max(duty, 0.05), 0.95))


@kernel
def tempo(
    speed: float,
    hip_height: float,
    leg_length: float,
    upright: bool,
    duty_low: float,
    duty_high: float,
    stance_travel_limit: float,
    user_period: float,
) -> Tempo:
    """Return the cycle's duration and the mean duty at a speed.

    Args:
        speed: m/s over the ground of the fastest foot's rest place (turning on the spot counts).
        hip_height: m, from the ground to the hips as the creature stands.
        leg_length: m, hip to sole along the leg.
        upright: legs stand below their hips.
        duty_low: least mean duty of the gait.
        duty_high: greatest mean duty of the gait.
        stance_travel_limit: m, how far a foot may travel under the body while it stands.
        user_period: s, the cycle's duration that the user wants, NaN: as an animal would.

    Returns:
        Always a finite period, so that a stopping creature's feet come down; whether the needle
        turns at all is the controller's word. A period is shortened until the stance travel, speed
        x duty x period, is within its limit: `top_speed` says when that is no longer a walk. The
        duty falls too then, within its range: a sprawler keeps its swing time, upright legs share
        the shortening between stance and period.
    """
    # At rest the slowest walk: the laws have no limit at zero.
    slowest = 1e-3 * math.sqrt(GRAVITY * leg_length)
    animal = natural_tempo(max(speed, slowest), hip_height, leg_length, upright)
    period = animal.period if math.isnan(user_period) else user_period
    limit = max(stance_travel_limit, 1e-3 * leg_length)
    duty = animal.duty
    if not upright:
        swing = SPRAWLER_SWING * math.sqrt(leg_length / GRAVITY)
        duty = 1.0 - swing / period
        if speed * min(max(duty, duty_low), duty_high) * period > limit:
            # The longest period whose stance, swing kept and duty clamped, is the limit's.
            stance = limit / speed
            period = min(stance / duty_low, max(stance / duty_high, stance + swing))
            duty = 1.0 - swing / period
    duty = min(max(duty, duty_low), duty_high)
    excess = speed * duty * period / limit
    if excess > 1.0:
        if upright:
            duty = max(duty * excess**-DUTY_SHORTENED, duty_low)
        period = limit / (speed * duty)
    return Tempo(period, duty)


@kernel
def top_speed(leg_length: float, duty_low: float, stance_travel_limit: float) -> float:
    """Return the speed, m/s, beyond which legs would have to cycle faster than any animal's."""
    shortest = SHORTEST_PERIOD * math.sqrt(leg_length / GRAVITY)
    return max(stance_travel_limit, 1e-3 * leg_length) / (duty_low * shortest)


def comfortable_speed(hip_height: float, leg_length: float, upright: bool) -> float:
    """Return the speed, m/s, at which a creature walks when nobody says how fast; metres."""
    if upright:
        return UPRIGHT_SPEED * math.sqrt(GRAVITY * max(hip_height, 0.05 * leg_length))
    return SPRAWLING_SPEED * math.sqrt(GRAVITY * leg_length)
