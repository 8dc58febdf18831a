"""The body's own motion over its feet: heave, nod, roll and sway that the gait implies (P2 4).

It comes on top of the height and tilt that follow the ground (P1 3.2, `pose.py`). Particles
(`particles.py`) give the offset of each girdle, and the rigid trunk goes through these as well as
it can; P1's sinusoid is there by name. Everything here is a deviation from where the body would be
without it, kept in the state, so that what looks ahead can leave it out.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.body.beat import LEAST_SPREAD, Beat, bounded, ease, gravity_share, measure_beat
from polypod.body.particles import (
    Orbit,
    Particle,
    advance_particle,
    cycle_shape,
    settle_particle,
)
from polypod.body.smoothing import follow
from polypod.body.support import body_rotation
from polypod.compute import kernel
from polypod.config import MOTION_PARTICLES, MOTION_SINUSOID, WALKING_VAULT
from polypod.gait.tempo import GRAVITY
from polypod.math.intervals import wrap_phase
from polypod.math.quat import Quat

# Strength and shape of the bounce follow gait and speed within about so many cycles.
ADOPT_CYCLES = 0.4
# Largest nod and roll, radians to either side, and sway, hip heights: horse and dog at a gallop
# nod by about 5 to 8 degrees, a man sways by 4 to 5 cm, peak to peak.
LARGEST_NOD = 0.07
LARGEST_ROLL = 0.03
LARGEST_SWAY = 0.025
# Sway is full from this speed on, leg lengths a pendulum time, and comes within so many cycles.
SWAYING = 0.1
SWAY_CYCLES = 1.0
# P1's sinusoid is never larger than this, hip heights.
LARGEST_BOB = 0.02


@kernel
def adopt_motion(c: int, beat: Beat, state: Any, tables: Any, settings: Any) -> None:
    """Let the bounce's strength and shape follow gait, speed and settings."""
    follows = 1.0 - math.exp(-state.turn[c] / ADOPT_CYCLES)
    period = 1.0 / state.cycle_rate[c]
    # Who sets out has no bounce yet to carry over.
    if state.gravity_share[c] == 0.0:
        state.beat_period[c] = period
    state.beat_period[c] += (period - state.beat_period[c]) * follows
    bounce = 0.0
    sinusoid = 0.0
    if settings.body_motion == MOTION_PARTICLES:
        bounce = settings.bounce * ease(c, state) * gravity_share(c, beat, state, tables)
    elif settings.body_motion == MOTION_SINUSOID:
        sinusoid = settings.bounce
    state.gravity_share[c] += (bounce - state.gravity_share[c]) * follows
    state.sinusoid_share[c] += (sinusoid - state.sinusoid_share[c]) * follows
    vault = wished_vault(c, state, tables, settings)
    state.vault[c] += (vault - state.vault[c]) * follows


@kernel
def wished_vault(c: int, state: Any, tables: Any, settings: Any) -> float:
    """Return Alexander's q: as set, or what the gait has where legs are upright."""
    if not math.isnan(settings.vaulting):
        return float(settings.vaulting)
    return float(state.gait_vault[c]) if tables.upright else 0.0


@kernel
def advance_particles(
    c: int, dt: float, share: float, period: float, vault: float, state: Any, tables: Any
) -> None:
    """Advance the particles of all feet by the step's turn of the needle, or `dt` s of standing.

    `share`, `period` and `vault` are those of the state as they were before the step.
    """
    walks = state.cycle_rate[c] > 0.0
    for k in range(state.swinging.shape[1]):
        particle = Particle(state.particle_offset[c, k], state.particle_rise[c, k])
        # Standing counts as propelling; a leg out of the gait carries nothing of its own either.
        if not walks or state.reaching[c, k]:
            particle = settle_particle(particle, dt, tables.pendulum_time)
        else:
            touchdown = state.swing_start[c, k] + state.swing_extent[c, k]
            phase = wrap_phase(state.needle[c] - state.turn[c] - touchdown)
            duty = 1.0 - state.swing_extent[c, k]
            before = Orbit(cycle_shape(duty, vault), period, share)
            shape = cycle_shape(duty, state.vault[c])
            orbit = Orbit(shape, state.beat_period[c], state.gravity_share[c])
            particle = advance_particle(particle, phase, state.turn[c], before, orbit)
        state.particle_offset[c, k] = particle.offset
        state.particle_rise[c, k] = particle.rise


@kernel
def fit_girdles(c: int, beat: Beat, state: Any, tables: Any, settings: Any) -> None:
    """Fit heave, nod and roll of the rigid trunk to the offsets of its girdles.

    Weighted least squares along the trunk. Of nod and roll it takes on what a trunk does: girdles
    that move freely would turn it by as much as their feet do.
    """
    legs = tables.legs
    girdles = tables.girdles
    for g in range(girdles.place.shape[0]):
        state.girdle_offset[c, g] = 0.0
    across = 0.0
    width = 0.0
    for k in range(legs.length.shape[0]):
        g = girdles.of_leg[k]
        offset = state.particle_offset[c, k]
        state.girdle_offset[c, g] += legs.weight[k] / girdles.weight[g] * offset
        across += legs.weight[k] * legs.side[k] * offset
        width += legs.weight[k] * abs(legs.sole_stance[k, 0])
    before = state.heave[c]
    heave = 0.0
    middle = 0.0
    for g in range(girdles.place.shape[0]):
        heave += girdles.weight[g] * state.girdle_offset[c, g]
        middle += girdles.weight[g] * girdles.place[g]
    along = 0.0
    spread = 0.0
    for g in range(girdles.place.shape[0]):
        lever = girdles.place[g] - middle
        along += girdles.weight[g] * lever * state.girdle_offset[c, g]
        spread += girdles.weight[g] * lever * lever
    if state.cycle_rate[c] > 0.0:
        strong = max(state.gravity_share[c], 1e-9)
        # Bouncing sinks onto the side that stands, as camels do; who vaults carries that side high,
        # and sprawlers stand broad.
        bounces = 0.0
        if tables.upright:
            bounces = max(0.0, 1.0 - state.vault[c] / WALKING_VAULT) * tables.tilt_scale
        state.nod_share[c, 0] = settings.nod * bounded(LARGEST_NOD, strong * beat.nod)
        state.nod_share[c, 1] = settings.nod * bounces * bounded(LARGEST_ROLL, strong * beat.roll)
    nod = 0.0
    if spread > LEAST_SPREAD * tables.leg_length * tables.leg_length:
        nod = state.nod_share[c, 0] * along / spread
    state.nod[c, 0] = nod
    state.nod[c, 1] = state.nod_share[c, 1] * across / max(width, 0.02 * tables.leg_length)
    state.heave[c] = heave - nod * middle + state.sinusoid_share[c] * sinusoid(c, state, tables)
    state.heave_step[c] = state.heave[c] - before


@kernel
def sinusoid(c: int, state: Any, tables: Any) -> float:
    """Return P1's sinusoidal movement of the body, metres (P1 3.2).

    Each foot pulls the body along a cosine that is lowest at its mid-stance, once a cycle; its
    size is what a ballistic hop between two beats would be at duty factor one half (0.0085 g T^2
    for two beats a cycle, BIOMECHANICS 3). Many feet out of step cancel, as in life.
    """
    rate = state.cycle_rate[c]
    if rate <= 0.0:
        return 0.0
    count = state.swinging.shape[1]
    first_cosine = 0.0
    second_cosine = 0.0
    for k in range(count):
        middle = state.swing_start[c, k] + 0.5 * (1.0 + state.swing_extent[c, k])
        angle = 2.0 * math.pi * (state.needle[c] - middle)
        first_cosine += math.cos(angle) / count
        second_cosine += math.cos(2.0 * angle) / count
    beat = GRAVITY / (rate * rate)
    most = LARGEST_BOB * tables.hip_height
    one = min(most, 0.5 * 0.0340 * beat)
    two = min(most, 0.5 * 0.0085 * beat)
    slow = min(1.0, abs(state.speed[c]) / (0.1 * tables.leg_length / tables.pendulum_time))
    height: float = -slow * (one * first_cosine + two * second_cosine)
    return height


@kernel
def wished_sway(c: int, dt: float, beat: Beat, state: Any, tables: Any, settings: Any) -> float:
    """Return how far the body is to be to its left of its course, m, for the feet that stand.

    For upright animals alone: sprawlers' feet are wide apart, and they sway little.
    """
    wanted = 0.0
    seconds = SWAY_CYCLES * 4.0 * tables.pendulum_time
    sway = 0.0
    if tables.upright and state.cycle_rate[c] > 0.0:
        fast = SWAYING * tables.leg_length / tables.pendulum_time
        wanted = settings.sway * ease(c, state) * min(1.0, abs(state.speed[c]) / fast)
        seconds = min(seconds, SWAY_CYCLES / state.cycle_rate[c])
        angle = 2.0 * math.pi * state.needle[c]
        sway = beat.sway_cosine * math.cos(angle) + beat.sway_sine * math.sin(angle)
        size = math.hypot(beat.sway_cosine, beat.sway_sine)
        sway *= bounded(LARGEST_SWAY * tables.hip_height, 2.0 * size)
        state.swayed[c] = sway
    return follow(state.sway_share[c], wanted, seconds, dt) * state.swayed[c]


@kernel
def move_trunk(c: int, dt: float, state: Any, command: Any, tables: Any, settings: Any) -> float:
    """Bring heave, nod and roll to the end of the step; return the sway wished for, m to the left.

    `state.sway` is written by who moves the body, for its legs may hold it back.
    """
    beat = Beat(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    share = state.gravity_share[c]
    period = state.beat_period[c]
    vault = state.vault[c]
    if state.cycle_rate[c] > 0.0:
        beat = measure_beat(c, vault, state, tables)
        adopt_motion(c, beat, state, tables, settings)
    else:
        # Who sets out begins without a bounce, and it grows with speed.
        state.gravity_share[c] = 0.0
        state.sinusoid_share[c] = 0.0
    advance_particles(c, dt, share, period, vault, state, tables)
    fit_girdles(c, beat, state, tables, settings)
    return wished_sway(c, dt, beat, state, tables, settings)


@kernel
def trunk_rotation(c: int, heading: float, state: Any) -> Quat:
    """Return the body's rotation: by the ground's slope, and by its gait's nod and roll."""
    return body_rotation(
        heading, state.tilt[c, 0, 0] + state.nod[c, 0], state.tilt[c, 1, 0] + state.nod[c, 1]
    )
