"""A gait's steady motion in closed form: how far it would carry the body, and what legs allow.

Heave, nod, roll and sway as sums of harmonics of the feet's forces, without a sample of any orbit:
they are asked for in every step.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from polypod.body.particles import HARMONICS, cycle_shape, force_harmonic
from polypod.compute import kernel
from polypod.controller.steering import MOST_HURRY
from polypod.gait.tempo import GRAVITY

# A foot's own particle swings at most so many times as far as a stiff leg would lift the body. In
# steady gait the feet's particles cancel; on the way to another gait they do not quite.
ALONE = 8.0
# Girdles whose places vary by less than this, leg lengths squared, are one.
LEAST_SPREAD = 1e-4


class Beat(NamedTuple):
    """How far the feet's steady orbits carry the body at full gravity, peak to peak."""

    heave: float  # m
    alone: float  # m, of the foot that moves most
    nod: float  # rad, of the fit through the girdles
    roll: float  # rad, left against right
    sway_cosine: float  # m: sway at needle phase 0
    sway_sine: float  # m: and a quarter of a cycle later


class Wave(NamedTuple):
    """Cosine and sine of an angle."""

    cosine: float
    sine: float


@kernel
def turn_on(wave: Wave, by: Wave) -> Wave:
    """Return cosine and sine of the sum of two angles."""
    return Wave(
        wave.cosine * by.cosine - wave.sine * by.sine, wave.sine * by.cosine + wave.cosine * by.sine
    )


@kernel
def measure_beat(c: int, vault: float, state: Any, tables: Any) -> Beat:
    """Return the closed-form motion of the gait on its way, and keep its heave's harmonics.

    The sway is an inverted pendulum's over the feet's centre of pressure, so it is less the quicker
    the cycle.
    """
    legs = tables.legs
    girdles = tables.girdles
    period = state.beat_period[c] if state.beat_period[c] > 0.0 else 1.0 / state.cycle_rate[c]
    width = 0.0
    middle = 0.0
    spread = 0.0
    for k in range(legs.length.shape[0]):
        z = girdles.place[girdles.of_leg[k]]
        middle += legs.weight[k] * z
        spread += legs.weight[k] * z * z
        width += legs.weight[k] * abs(legs.sole_stance[k, 0])
    spread -= middle * middle
    nods = spread > LEAST_SPREAD * tables.leg_length * tables.leg_length
    beat = state.beat[c]
    for n in range(HARMONICS):
        for column in range(6):
            beat[n, column] = 0.0
    alone = 0.0
    sway_cosine = 0.0
    sway_sine = 0.0
    for k in range(legs.length.shape[0]):
        duty = 1.0 - state.goal_extent[c, k]
        shape = cycle_shape(duty, vault)
        middle_of_stance = 2.0 * math.pi * (state.goal_start[c, k] - 0.5 * duty)
        first = Wave(math.cos(middle_of_stance), math.sin(middle_of_stance))
        half = Wave(math.cos(math.pi * duty), math.sin(math.pi * duty))
        turned = Wave(1.0, 0.0)
        opened = Wave(1.0, 0.0)
        lever = girdles.place[girdles.of_leg[k]] - middle
        for n in range(1, HARMONICS + 1):
            turned = turn_on(turned, first)
            opened = turn_on(opened, half)
            harmonic = force_harmonic(shape, n, opened.cosine)
            slow = period / (2.0 * math.pi * n)
            size = -legs.weight[k] * GRAVITY * slow * slow * harmonic
            row = beat[n - 1]
            row[0] += size * turned.cosine
            row[1] += size * turned.sine
            row[2] += size * lever * turned.cosine
            row[3] += size * lever * turned.sine
            row[4] += size * legs.side[k] * turned.cosine
            row[5] += size * legs.side[k] * turned.sine
            if n == 1:
                alone = max(alone, 2.0 * abs(size / legs.weight[k]))
                across = legs.weight[k] * (legs.sole_stance[k, 0] + state.spacing[c, k, 0])
                sway_cosine += across * harmonic * turned.cosine
                sway_sine += across * harmonic * turned.sine
    heave = 0.0
    nod = 0.0
    roll = 0.0
    for n in range(HARMONICS):
        heave += beat[n, 0] ** 2 + beat[n, 1] ** 2
        nod += beat[n, 2] ** 2 + beat[n, 3] ** 2
        roll += beat[n, 4] ** 2 + beat[n, 5] ** 2
    quick = 2.0 * math.pi / period
    sway = 1.0 / (1.0 + quick * quick * tables.hip_height / GRAVITY)
    return Beat(
        2.0 * math.sqrt(heave),
        alone,
        2.0 * math.sqrt(nod) / spread if nods else 0.0,
        2.0 * math.sqrt(roll) / max(width, 0.02 * tables.leg_length),
        sway * sway_cosine,
        sway * sway_sine,
    )


@kernel
def ease(c: int, state: Any) -> float:
    """Return the share of the gait's motion that is left to who gets on badly.

    Whose legs hold it back, on what it climbs over, has none of their reach to spare.
    """
    return 1.0 - min(1.0, float(state.hurry[c]) / MOST_HURRY)


@kernel
def gravity_share(c: int, beat: Beat, state: Any, tables: Any) -> float:
    """Return the share of gravity at which the gait's bounce keeps to what legs do.

    Ballistic bounce grows with the period squared, and slow walkers' periods are long: a body that
    walks slowly rises by no more than a stiff leg lifts it in a step, s^2 / (8 h), as an inverted
    pendulum does over what it travels until the next foot takes over. The less is bounced the more
    is borne all the time: the force's mean stays g and it never pulls.
    """
    duty = min(state.duty[c], 0.5)
    travel = duty * abs(state.speed[c]) * state.beat_period[c]
    rise = 0.125 * travel * travel / tables.hip_height
    tiny = 1e-9 * tables.hip_height
    return min(1.0, rise / max(beat.heave, tiny), ALONE * rise / max(beat.alone, tiny))


@kernel
def heave_ahead(c: int, cycles: float, state: Any) -> float:
    """Return the heave, m, that the steady gait will have so many cycles ahead."""
    share = float(state.gravity_share[c])
    if share == 0.0:
        return 0.0
    angle = 2.0 * math.pi * (state.needle[c] + cycles)
    first = Wave(math.cos(angle), math.sin(angle))
    turned = Wave(1.0, 0.0)
    heave = 0.0
    for n in range(HARMONICS):
        turned = turn_on(turned, first)
        heave += state.beat[c, n, 0] * turned.cosine + state.beat[c, n, 1] * turned.sine
    return share * heave


@kernel
def bounded(most: float, size: float) -> float:
    """Return the share of a turn, `size` from peak to peak, that stays within `most` either way.

    Taken back gently, so that of two gaits the wilder one still moves more.
    """
    excess = 0.5 * size / most
    return 1.0 / math.sqrt(1.0 + excess * excess)
