from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from polypod.gait.library import natural_duty
from polypod.gait.tempo import GRAVITY, froude_number, natural_tempo, tempo, top_speed

FREE = math.inf  # a leg that reaches as far as one likes
ANY = math.nan  # no period asked for

lengths = st.floats(0.002, 10.0)
speeds = st.floats(0.0, 30.0)
periods = st.one_of(st.just(ANY), st.floats(0.01, 20.0))


@pytest.mark.parametrize("froude", [0.1, 0.2, 0.5, 1.0, 3.0, 12.0, 20.0])
def test_upright_animals_take_alexanders_stride_and_hoyts_contact(froude: float) -> None:
    height = 1.0
    speed = math.sqrt(froude * GRAVITY * height)
    period, duty = tempo(speed, height, 1.1, True, 0.05, 0.95, FREE, ANY)
    assert speed * period == pytest.approx(2.3 * froude**0.3)
    assert duty * period == pytest.approx(0.80 / speed**0.87)
    assert duty == pytest.approx(natural_duty(froude, True), rel=2e-3)


@pytest.mark.parametrize("speed", [0.5, 1.0, 2.0, 3.5])
def test_sprawlers_take_the_iguanas_stride_and_keep_their_swing(speed: float) -> None:
    length = 0.09
    period, duty = tempo(speed, 0.05, length, False, 0.05, 0.95, FREE, ANY)
    froude = speed**2 / (GRAVITY * length)
    assert speed * period == pytest.approx(2.1 * length * froude**0.275)
    assert (1.0 - duty) * period == pytest.approx(0.9 * math.sqrt(length / GRAVITY))
    assert duty == pytest.approx(natural_duty(froude, False))


@pytest.mark.parametrize(
    ("what", "speed", "height", "length", "upright", "low", "high", "measured"),
    [
        # Measured period in s and duty.
        ("iguana, slow", 0.5, 0.05, 0.09, False, 0.3, 0.8, (1 / 3.9, 0.63)),
        ("iguana, fast", 3.5, 0.05, 0.09, False, 0.3, 0.8, (1 / 8.6, 0.34)),
        ("racehorse, 9 m/s", 9.0, 1.3, 1.4, True, 0.15, 0.5, (4.46 / 9.0, 0.276)),
        ("racehorse, 17 m/s", 17.0, 1.3, 1.4, True, 0.15, 0.5, (7.12 / 17.0, 0.204)),
        ("man walking", 1.4, 0.9, 0.95, True, 0.5, 0.8, (1.05, 0.62)),
    ],
)
def test_tempo_is_as_measured_on_animals(
    what: str, speed: float, height: float, length: float, upright: bool, low: float, high: float,
    measured: tuple[float, float],
) -> None:  # fmt: skip
    period, duty = tempo(speed, height, length, upright, low, high, FREE, ANY)
    assert period == pytest.approx(measured[0], rel=0.25), what
    assert duty == pytest.approx(measured[1], abs=0.06), what


@given(speeds, lengths, lengths, st.booleans(), st.floats(0.01, 3.0), periods)
def test_stance_travel_stays_within_reach_and_duty_within_the_gait(
    speed: float, height: float, length: float, upright: bool, reach: float, asked: float
) -> None:
    low, high = 0.4, 0.7
    limit = reach * length
    period, duty = tempo(speed, height, length, upright, low, high, limit, asked)
    assert 0.0 < period < math.inf
    assert low <= duty <= high
    assert speed * duty * period <= limit * (1.0 + 1e-9)
    if not math.isnan(asked):
        assert period <= asked


@given(speeds, lengths, st.booleans())
def test_an_asked_period_is_kept_where_legs_reach(
    speed: float, length: float, upright: bool
) -> None:
    assert tempo(speed, length, length, upright, 0.4, 0.7, FREE, 0.8).period == 0.8


def test_a_creature_at_rest_has_a_finite_period() -> None:
    for upright, size in ((True, 1.0), (False, 1.0), (False, 0.003)):
        period, duty = tempo(0.0, size, size, upright, 0.5, 0.75, 0.5 * size, ANY)
        longest = (6.0 if upright else 12.0) * math.sqrt(size / GRAVITY)
        assert period == pytest.approx(longest)
        assert duty == 0.75


def test_a_sprawlers_swing_is_no_shorter_for_a_short_reach() -> None:
    # Reach halves the stance travel: stance shortens, swing does not, until the duty is lowest.
    length, limit = 0.5, 0.3
    swing = 0.9 * math.sqrt(length / GRAVITY)
    for speed in (0.8, 1.0, 1.4):
        period, duty = tempo(speed, 0.25, length, False, 0.5, 0.75, limit, ANY)
        assert 0.5 < duty < 0.75
        assert speed * duty * period == pytest.approx(limit)
        assert (1.0 - duty) * period == pytest.approx(swing)


@given(st.floats(0.01, 3.0), st.floats(0.1, 1.5), st.booleans())
def test_tempo_has_no_jumps(speed: float, reach: float, upright: bool) -> None:
    low, high = 0.4, 0.75
    one = tempo(speed, 0.3, 0.5, upright, low, high, reach * 0.5, ANY)
    other = tempo(speed * (1 + 1e-7), 0.3, 0.5, upright, low, high, reach * 0.5, ANY)
    assert other.period == pytest.approx(one.period, rel=1e-5)
    assert other.duty == pytest.approx(one.duty, abs=1e-5)


@given(st.floats(0.01, 3.0), st.floats(0.005, 10.0))
def test_sprawlers_of_all_sizes_walk_alike_at_one_froude_number(froude: float, size: float) -> None:
    def at(length: float) -> tuple[float, float]:
        speed = math.sqrt(froude * GRAVITY * length)
        return tempo(speed, 0.5 * length, length, False, 0.5, 0.75, 0.6 * length, ANY)

    one, other = at(1.0), at(size)
    assert other[0] / math.sqrt(size) == pytest.approx(one[0], rel=1e-9)
    assert other[1] == pytest.approx(one[1], rel=1e-9)


@pytest.mark.parametrize("upright", [True, False])
@pytest.mark.parametrize("size", [0.003, 0.25, 1.0, 9.0])
def test_faster_is_quicker_and_longer(size: float, upright: bool) -> None:
    speed = np.geomspace(0.01, 2.0) * math.sqrt(GRAVITY * size)
    period = np.array([natural_tempo(v, size, size, upright).period for v in speed])
    assert (np.diff(period) <= 0.0).all()
    assert (np.diff(speed * period) > 0.0).all()


def test_froude_and_top_speed() -> None:
    assert froude_number(3.0, 1.0) == pytest.approx(9.0 / 9.81)
    # At the top speed the cycle takes .6 sqrt(L / g).
    fastest = top_speed(0.5, 0.5, 0.3)
    period = tempo(fastest, 0.25, 0.5, False, 0.5, 0.75, 0.3, ANY).period
    assert period == pytest.approx(0.6 * math.sqrt(0.5 / GRAVITY))
