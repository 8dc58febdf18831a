"""Per-foot particles: the vertical motion that each foot would give the body alone (P2 4).

Each foot drives a virtual particle of its own, as if alone (P2's Figure 11): reception brings its
fall to a stall at mid-stance, propulsion gives it the speed at which it falls into the next stance
as a steady gait would (5c), and it flies while the foot swings. The body is their weighted mean.

A foot's force through stance, in g, u from -1/2 at touchdown to 1/2 at lift-off:

    f(u) = A (cos(pi u) - q cos(3 pi u)),  A = pi / (2 beta (1 + q / 3))

so that a cycle's mean is 1 g, whatever the duty factor beta. q is Alexander's: 0 bounces, 0.4 has
the two humps of a human walk and its body highest at mid-stance (BIOMECHANICS 3). -1/3 <= q <= 1
keeps it from pulling.

A steady gait has a closed-form orbit, centred on the preferred height. What a particle does besides
is its deviation from it, which obeys `deviation'' = c g f(u)` in stance and flies on straight in
swing: c, the force added to the steady one, removes it within a cycle. So each piece between two
events of the foot (touchdown, mid-stance, lift-off) is integrated exactly, and the frame rate only
samples the motion. A tempo or a strength that changes takes the orbit along; disks that are
replaced leave the particle where it is, and it deviates from its new orbit.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from polypod.compute import kernel
from polypod.gait.tempo import GRAVITY

# The force added to the steady one is at most so many times the steady one: about what an animal
# adds that leaps.
LARGEST_PUSH = 1.5
# What is left of a half of the stance counts as at least this share of it: a deviation that comes
# up just before its end is left to the next half.
LEAST_LEFT = 0.2
# A foot that stands for good brings its particle to rest with this pole, 1 / leg pendulum times.
REST_POLE = 2.5
HARMONICS = 4


class Particle(NamedTuple):
    """A foot's particle: where it is about the preferred height, and how fast it rises."""

    offset: float  # m
    rise: float  # m/s


class Shape(NamedTuple):
    """One cycle of a foot in steady gait: times in cycles T, heights in g T^2, speeds in g T."""

    duty: float
    vault: float  # Alexander's q
    peak: float  # A, in g
    middle: float  # height at mid-stance; the cycle's mean is 0
    half: float  # what the force of half a stance lifts by, in it


@kernel
def stance_impulse(shape: Shape, u: float) -> float:
    """Return the force's integral from mid-stance to `u`, g T; 1/2 at lift-off."""
    sine = math.sin(math.pi * u)
    triple = sine * (3.0 - 4.0 * sine * sine)
    return shape.duty * shape.peak * (sine - shape.vault / 3.0 * triple) / math.pi


@kernel
def stance_lift(shape: Shape, u: float) -> float:
    """Return the integral of `stance_impulse` from mid-stance to `u`, g T^2."""
    cosine = math.cos(math.pi * u)
    triple = cosine * (4.0 * cosine * cosine - 3.0)
    one = 1.0 - cosine - shape.vault / 9.0 * (1.0 - triple)
    return shape.duty * shape.duty * shape.peak * one / (math.pi * math.pi)


@kernel
def cycle_shape(duty: float, vault: float) -> Shape:
    """Return a foot's steady cycle for its duty factor and Alexander's q."""
    peak = 0.5 * math.pi / (duty * (1.0 + vault / 3.0))
    swing = 1.0 - duty
    half = duty * duty * peak * (1.0 - vault / 9.0) / (math.pi * math.pi)
    # Heights over the one at mid-stance: their mean through stance, then through swing.
    cubed = 2.0 / math.pi**3
    stance_mean = peak * ((1.0 - vault / 9.0) / (math.pi * math.pi) - cubed - vault / 27.0 * cubed)
    stance_mean = duty * duty * (stance_mean - 1.0 / 24.0)
    swing_mean = half - 0.125 * duty * duty + swing * swing / 12.0
    return Shape(duty, vault, peak, -(duty * stance_mean + swing * swing_mean), half)


@kernel
def steady(shape: Shape, phase: float) -> Particle:
    """Return height (g T^2) and speed (g T) on the steady orbit, `phase` cycles after touchdown."""
    duty = shape.duty
    if phase < duty:
        u = phase / duty - 0.5
        bent = duty * u
        height = shape.middle + stance_lift(shape, u) - 0.5 * bent * bent
        return Particle(height, stance_impulse(shape, u) - bent)
    flown = phase - duty
    launch = 0.5 * (1.0 - duty)
    lifted = shape.middle + shape.half - 0.125 * duty * duty
    return Particle(lifted + launch * flown - 0.5 * flown * flown, launch - flown)


class Orbit(NamedTuple):
    """The steady motion of one foot's particle."""

    shape: Shape
    period: float  # s a cycle
    share: float  # of gravity that the bounce takes: the rest of the weight is borne all the time


@kernel
def added_force(orbit: Orbit, u: float, offset: float, rise: float) -> float:
    """Return the force, in g times `stance_impulse`'s, that removes a deviation from the orbit.

    In reception what stalls the particle at mid-stance (P2 4b). In propulsion what gives the speed
    with which it comes to the steady height at the next mid-stance: P2's 5c, its fall reckoned
    through the reception to come, where the height at touchdown alone is approached in turns from
    above and below, ever slower the longer a foot stands. The whole force is never below 0.
    """
    shape = orbit.shape
    period = orbit.period
    duty = shape.duty
    impulse = stance_impulse(shape, u)
    if u < 0.0:
        wanted = -rise / (GRAVITY * period * max(-impulse, 0.5 * LEAST_LEFT))
    else:
        # The stall costs height in proportion to the speed at touchdown.
        fall = 1.0 - duty + 2.0 * shape.half
        left = duty * (0.5 - u)
        lift = shape.half - stance_lift(shape, u) - impulse * left
        lift += (0.5 - impulse) * fall
        lift = max(lift, LEAST_LEFT * (shape.half + 0.5 * fall))
        ahead = offset + rise * period * (left + fall)
        wanted = -ahead / (GRAVITY * period * period * lift)
    least = -orbit.share - (1.0 - orbit.share) / (shape.peak * (1.0 + abs(shape.vault)))
    return max(min(least, 0.0), min(LARGEST_PUSH, wanted))


@kernel
def on_orbit(orbit: Orbit, phase: float) -> Particle:
    """Return the particle of a steady gait, `phase` cycles after its foot's touchdown."""
    place = steady(orbit.shape, phase)
    fast = orbit.share * GRAVITY * orbit.period
    return Particle(place.offset * fast * orbit.period, place.rise * fast)


@kernel
def advance_particle(
    particle: Particle, phase: float, turn: float, before: Orbit, orbit: Orbit
) -> Particle:
    """Advance one foot's particle while its cycle goes on from `phase` by `turn` cycles.

    Args:
        particle: where it is.
        phase: cycles since the foot's touchdown, in [0, 1).
        turn: cycles.
        before: the steady orbit at the step's beginning.
        orbit: that at its end, by which the particle is driven.
    """
    shape = orbit.shape
    period = orbit.period
    place = on_orbit(before, phase)
    offset = particle.offset - place.offset
    rise = particle.rise - place.rise
    half = 0.5 * shape.duty
    while turn > 0.0:
        event = half if phase < half else shape.duty if phase < shape.duty else 1.0
        part = min(turn, event - phase)
        if phase < shape.duty:
            u = phase / shape.duty - 0.5
            after = u + part / shape.duty
            force = added_force(orbit, u, offset, rise) * GRAVITY * period
            begun = stance_impulse(shape, u)
            lift = stance_lift(shape, after) - stance_lift(shape, u) - begun * part
            offset += rise * period * part + force * period * lift
            rise += force * (stance_impulse(shape, after) - begun)
        else:
            offset += rise * period * part
        phase = event if part == event - phase else phase + part
        turn -= part
        if phase >= 1.0:
            phase = 0.0
    place = on_orbit(orbit, phase)
    return Particle(place.offset + offset, place.rise + rise)


@kernel
def settle_particle(particle: Particle, dt: float, pendulum_time: float) -> Particle:
    """Bring a particle to rest at the preferred height, critically damped: its foot stands."""
    pole = REST_POLE / pendulum_time
    decay = math.exp(-pole * dt)
    drift = particle.rise + pole * particle.offset
    return Particle(
        (particle.offset + drift * dt) * decay, (particle.rise - pole * drift * dt) * decay
    )


@kernel
def force_harmonic(shape: Shape, n: int, cosine: float) -> float:
    """Return the amplitude, in g, of the force's n-th harmonic about mid-stance.

    `cosine` is that of pi n times the duty factor, which callers have from the one before.
    """
    angle = 2.0 * math.pi * n * shape.duty
    one = _beside_pole(angle, cosine, math.pi, 1.0)
    three = _beside_pole(angle, cosine, 3.0 * math.pi, -1.0)
    both = 2.0 * math.pi * (one + 3.0 * shape.vault * three)
    return 2.0 * shape.duty * shape.peak * both


@kernel
def _beside_pole(angle: float, cosine: float, pole: float, sign: float) -> float:
    """Return cos(angle / 2) / (pole^2 - angle^2), finite where both are 0; sin(pole / 2) = sign."""
    if abs(angle - pole) < 1e-5:
        return sign / (4.0 * pole)
    return cosine / (pole * pole - angle * angle)
