"""The feet's particles against closed forms, at every size and frame rate (P2 4)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.body.particles import (
    HARMONICS,
    LARGEST_PUSH,
    Orbit,
    Particle,
    advance_particle,
    cycle_shape,
    force_harmonic,
    on_orbit,
    settle_particle,
    steady,
)
from polypod.compute import kernel
from polypod.gait.library import make_gait, names
from polypod.gait.pattern import Gait
from polypod.gait.tempo import GRAVITY

# A fly, a dog and a dinosaur: height of the hips, m.
SIZES = (0.003, 0.5, 4.0)
RATES = (24.0, 30.0, 60.0, 240.0)
# A cycle of a brisk walk or run, in units of sqrt(h / g); no whole number of frames at any rate.
CYCLE = 2.7
SETTLING = 8  # cycles
SAMPLES = 300  # frames, at least, on the steady orbit


@kernel
def ride(
    offset: float, rise: float, phase: float, turn: float, period: float, duty: float, vault: float,
    share: float, out: Any,
) -> None:  # fmt: skip
    """Write offset and rise [frames, 2] of a particle after each frame of `turn` cycles."""
    orbit = Orbit(cycle_shape(duty, vault), period, share)
    particle = Particle(offset, rise)
    for frame in range(out.shape[0]):
        particle = advance_particle(particle, phase, turn, orbit, orbit)
        phase = (phase + turn) % 1.0
        out[frame, 0] = particle.offset
        out[frame, 1] = particle.rise


@kernel
def retime(
    phase: float, dt: float, periods: Any, duties: Any, shares: Any, vaults: Any, out: Any
) -> None:
    """Write offset and rise [frames, 2] of a particle from its orbit on, all [frames] changing."""
    before = Orbit(cycle_shape(duties[0], vaults[0]), periods[0], shares[0])
    particle = on_orbit(before, phase)
    for frame in range(out.shape[0]):
        duty = duties[frame]
        before = Orbit(cycle_shape(duty, before.shape.vault), before.period, before.share)
        orbit = Orbit(cycle_shape(duty, vaults[frame]), periods[frame], shares[frame])
        turn = dt / periods[frame]
        particle = advance_particle(particle, phase, turn, before, orbit)
        phase = (phase + turn) % 1.0
        before = orbit
        out[frame, 0] = particle.offset
        out[frame, 1] = particle.rise


def force(duty: float, vault: float, phase: np.ndarray) -> np.ndarray:
    """Return Alexander's force in g by its definition, scaled to a mean of 1 by quadrature."""
    u = np.linspace(-0.5, 0.5, 4001)
    pulse = np.cos(np.pi * u) - vault * np.cos(3.0 * np.pi * u)
    scale = duty * float(np.trapezoid(pulse, u))
    u = phase / duty - 0.5
    shape = np.cos(np.pi * u) - vault * np.cos(3.0 * np.pi * u)
    return np.where(phase < duty, shape / scale, 0.0)


duties = st.floats(0.1, 0.95)
vaults = st.floats(0.0, 1.0)


@settings(max_examples=40, deadline=None)
@given(duties, vaults)
def test_the_closed_form_obeys_the_force_and_closes(duty: float, vault: float) -> None:
    shape = cycle_shape(duty, vault)
    phase = (np.arange(2000) + 0.5) / 2000
    orbit = np.array([steady(shape, p) for p in phase])
    pushed = force(duty, vault, phase)
    assert pushed.mean() == pytest.approx(1.0, abs=1e-3)
    assert pushed.min() >= -1e-12
    assert orbit.mean(axis=0) == pytest.approx([0.0, 0.0], abs=2e-6)
    # A particle flung along by the force alone, from the orbit's start.
    begin = steady(shape, 0.0)
    steps = 20000
    dense = force(duty, vault, (np.arange(steps) + 0.5) / steps) - 1.0
    rise = begin.rise + np.cumsum(dense) / steps
    offset = begin.offset + np.cumsum(rise - 0.5 * dense / steps) / steps
    every = steps // 100
    for i in range(every - 1, steps - 1, every):
        there = steady(shape, (i + 1) / steps)
        assert (offset[i], rise[i]) == pytest.approx((there.offset, there.rise), abs=2e-5)
    assert (offset[-1], rise[-1]) == pytest.approx((begin.offset, begin.rise), abs=2e-5)
    assert steady(shape, 0.5 * duty).rise == pytest.approx(0.0, abs=1e-12)


def harmonic(duty: float, vault: float, n: int) -> float:
    """Return the amplitude of a foot's n-th harmonic, in g."""
    return force_harmonic(cycle_shape(duty, vault), n, math.cos(math.pi * n * duty))


@settings(max_examples=40, deadline=None)
@given(duties, vaults)
def test_harmonics_are_those_of_the_force(duty: float, vault: float) -> None:
    phase = np.linspace(0.0, 1.0, 8001)
    pushed = force(duty, vault, phase)
    for n in range(1, HARMONICS + 1):
        wave = np.cos(2.0 * np.pi * n * (phase - 0.5 * duty))
        expected = 2.0 * float(np.trapezoid(pushed * wave, phase))
        assert harmonic(duty, vault, n) == pytest.approx(expected, abs=2e-3)


def test_harmonics_are_finite_where_their_formula_is_not() -> None:
    for n in range(1, HARMONICS + 1):
        for duty in (0.5 / n, 1.5 / n):
            if duty < 1.0:
                near = harmonic(duty + 1e-4, 0.4, n)
                assert harmonic(duty, 0.4, n) == pytest.approx(near, abs=2e-3)


def gaits() -> list[tuple[Gait, float]]:
    """Return every gait of the library, on legs that it is usual for, with its vault."""
    two, four = ([1, -1], [0, 0]), ([1, -1] * 2, [0, 0, 1, 1])
    six, eight = ([1, -1] * 3, [0, 0, 1, 1, 2, 2]), ([1, -1] * 4, [0, 0, 1, 1, 2, 2, 3, 3])
    usual = {"tripod": six, "tetrapod": six, "wave": six, "run": two, "hop": two}
    usual |= dict.fromkeys(("spider", "scorpion", "crab", "centipede", "millipede"), eight)
    found = [(make_gait(name, *usual.get(name, four)), 0.0) for name in names()]
    walks = [gait for gait, _ in found if gait.family == "walk"]
    return [*found, *((gait, 0.4) for gait in [*walks, make_gait("walk", *two)])]


GAITS = gaits()


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("size", SIZES)
def test_every_gait_keeps_to_its_orbit_at_every_size_and_rate(size: float, rate: float) -> None:
    """Set off from rest: mean force 1 g, mean height 0, never a pull, the closed form's shape."""
    period = CYCLE * math.sqrt(size / GRAVITY)
    turn = 1.0 / (rate * period)
    settling = math.ceil(SETTLING / turn)
    frames = settling + max(SAMPLES, math.ceil(2.0 / turn))
    unit = GRAVITY * period * period
    for gait, vault in GAITS:
        body = np.zeros((frames, 2))
        exact = np.zeros(frames)
        for touchdown, duty in zip(gait.touchdown, 1.0 - gait.swing_extent, strict=True):
            path = np.zeros((frames, 2))
            begin = (0.3 - touchdown) % 1.0
            ride(0.0, 0.0, begin, turn, period, duty, vault, 1.0, path)
            shape = cycle_shape(duty, vault)
            phase = (begin + turn * np.arange(1, frames + 1)) % 1.0
            closed = unit * np.array([steady(shape, p).offset for p in phase[settling:]])
            exact[settling:] += closed / gait.foot_count
            body += path / gait.foot_count
            # From frame to frame no foot pulls, not even on its way from rest to its orbit.
            pushed = 1.0 + np.diff(path[:, 1]) * rate / GRAVITY
            assert pushed.min() > -1e-9
            # On to the same phase again: a cycle's mean force.
            start, flown = path[-1], np.zeros((1, 2))
            ride(start[0], start[1], phase[-1], 1.0, period, duty, vault, 1.0, flown)
            mean = 1.0 + (flown[0, 1] - start[1]) / (GRAVITY * period)
            assert mean == pytest.approx(1.0, abs=1e-3)
        height = body[settling:, 0]
        cycles = math.floor(len(height) * turn)
        assert abs(height[: round(cycles / turn)].mean()) < 0.01 * size
        one_foot = np.ptp(unit * np.array([steady(shape, p).offset for p in np.linspace(0, 1, 99)]))
        assert np.abs(height - exact[settling:]).max() < 0.01 * max(np.ptp(height), 0.01 * one_foot)


def test_excursion_goes_with_g_t_squared_alone() -> None:
    """Every gait's body excursion over g T^2 is the same at each size and frame rate."""
    found = []
    for size in SIZES:
        for rate in RATES:
            period = CYCLE * math.sqrt(size / GRAVITY)
            frames = max(6 * SAMPLES, math.ceil(3.0 * rate * period))
            ratios = []
            for gait, vault in GAITS:
                body = np.zeros(frames)
                for touchdown, duty in zip(gait.touchdown, 1.0 - gait.swing_extent, strict=True):
                    orbit = Orbit(cycle_shape(duty, vault), period, 1.0)
                    begin = (-touchdown) % 1.0
                    start = on_orbit(orbit, begin)
                    path = np.zeros((frames, 2))
                    turn = 1.0 / (rate * period)
                    ride(start.offset, start.rise, begin, turn, period, duty, vault, 1.0, path)
                    body += path[:, 0] / gait.foot_count
                ratios.append(np.ptp(body) / (GRAVITY * period * period))
            found.append(ratios)
    table = np.array(found)
    spread = np.ptp(table, axis=0) / table.mean(axis=0)
    assert spread.max() < 0.02
    by_name = {(gait.name, vault): table[:, i].mean() for i, (gait, vault) in enumerate(GAITS)}
    # Two beats a cycle: g P (.125 P - .0908 t), P = T / 2 and t a contact (BIOMECHANICS 3).
    assert by_name["tripod", 0.0] == pytest.approx(0.0085, rel=0.02)
    assert by_name["trot", 0.0] == pytest.approx(0.25 * 0.5 * 0.25 - 0.5 * 0.0908 * 0.45, rel=0.03)
    assert by_name["spider", 0.0] < 0.15 * by_name["tripod", 0.0]


@settings(max_examples=60, deadline=None)
@given(
    st.floats(0.15, 0.9), st.sampled_from([0.0, 0.4]), st.floats(0.05, 1.0),
    st.floats(-0.1, 0.1), st.floats(-0.3, 0.3), st.floats(0.0, 0.99), st.floats(0.01, 0.4),
)  # fmt: skip
def test_a_particle_that_was_moved_or_pushed_comes_back(
    duty: float, vault: float, share: float, moved: float, pushed: float, phase: float, turn: float
) -> None:
    """A tenth of g T^2 off, or pushed by a third of g T: on its orbit again, and it never pulls."""
    period = 0.6
    unit = GRAVITY * period * period
    shape = cycle_shape(duty, vault)
    begin = steady(shape, phase)
    frames = math.ceil(12.0 / turn)
    path = np.zeros((frames, 2))
    ride(
        (share * begin.offset + moved) * unit, (share * begin.rise + pushed) * GRAVITY * period,
        phase, turn, period, duty, vault, share, path,
    )  # fmt: skip
    end = on_orbit(Orbit(shape, period, share), (phase + turn * frames) % 1.0)
    assert path[-1] == pytest.approx([end.offset, end.rise], abs=2e-3 * unit)
    weight = 1.0 + np.diff(path[:, 1]) / (turn * period * GRAVITY)
    assert weight.min() > -1e-9
    assert weight.max() < 1.0 + (1.0 + LARGEST_PUSH) * shape.peak * 1.5


def test_pieces_do_not_depend_on_how_a_step_is_cut() -> None:
    """Deviating particles too: force is added from event to event, not from frame to frame."""
    for duty, vault in ((0.3, 0.0), (0.5, 0.0), (0.7, 0.4)):
        whole, cut = np.zeros((12, 2)), np.zeros((1200, 2))
        ride(0.05, 0.2, 0.02, 0.25 * duty, 0.5, duty, vault, 0.8, whole)
        ride(0.05, 0.2, 0.02, 0.0025 * duty, 0.5, duty, vault, 0.8, cut)
        unit = GRAVITY * 0.25
        assert np.abs(whole[:, 0] - cut[99::100, 0]).max() < 0.01 * unit


def test_tempo_duty_and_strength_may_change_on_the_way() -> None:
    """Height and speed do not jump, and the new orbit is taken up."""
    frames, dt = 1200, 1.0 / 240.0
    ramp = np.clip((np.arange(frames) - 200) / 200.0, 0.0, 1.0)
    periods = 0.7 - 0.3 * ramp
    # Disks are replaced at once.
    duties = np.where(np.arange(frames) < 300, 0.62, 0.42)
    path = np.zeros((frames, 2))
    retime(0.1, dt, periods, duties, 0.4 + 0.6 * ramp, 0.4 - 0.4 * ramp, path)
    jump = np.diff(path[:, 0]) - 0.5 * (path[1:, 1] + path[:-1, 1]) * dt
    fastest = np.abs(path[:, 1]).max()
    assert np.abs(jump).max() < 0.15 * fastest * dt
    assert np.abs(np.diff(path[:, 1])).max() < 6.0 * GRAVITY * dt
    phase = (0.1 + float(np.sum(dt / periods))) % 1.0
    end = on_orbit(Orbit(cycle_shape(0.42, 0.0), 0.4, 1.0), phase)
    assert path[-1] == pytest.approx([end.offset, end.rise], abs=1e-6)


@given(st.floats(-0.2, 0.2), st.floats(-1.0, 1.0), st.floats(1e-4, 1.0))
def test_a_standing_particle_comes_to_rest(offset: float, rise: float, dt: float) -> None:
    particle = Particle(offset, rise)
    pole = 2.5 / 0.25
    whole = settle_particle(particle, dt, 0.25)
    for _ in range(4):
        particle = settle_particle(particle, 0.25 * dt, 0.25)
    assert particle == pytest.approx(whole, abs=1e-12)
    rest = settle_particle(particle, 10.0, 0.25)
    assert rest == pytest.approx((0.0, 0.0), abs=1e-9)
    # Critically damped: it passes the preferred height once at most.
    times = np.linspace(0.0, 3.0, 200)
    heights = np.array([settle_particle(Particle(offset, rise), t, 0.25).offset for t in times])
    away = heights[np.abs(heights) > 1e-9]
    assert np.count_nonzero(np.diff(np.sign(away))) <= 1
    assert np.abs(heights).max() <= abs(offset) + abs(rise) / pole + 1e-9
