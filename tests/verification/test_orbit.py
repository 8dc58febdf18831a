"""The motion that a gait implies, against its own closed form, free fall and measured animals."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.config import WALKING_VAULT as VAULT
from polypod.errors import SettingError
from polypod.gait.build import Build
from polypod.gait.library import make_gait, names
from polypod.gait.orbit import GRAVITY, Orbit, normal_weight, orbit_of, vault_of
from polypod.gait.pattern import Gait
from polypod.gait.validation import check_gait

FEET = st.lists(
    st.tuples(st.floats(0.0, 1.0, exclude_max=True), st.floats(0.01, 0.99), st.floats(0.1, 10.0)),
    min_size=1,
    max_size=8,
)
VAULTS = st.sampled_from([0.0, 0.05, 0.2, VAULT, 1.0])
PERIODS = st.floats(1e-3, 1e2)


def orbit(feet: list[tuple[float, float, float]], period: float, vault: float) -> Orbit:
    touchdown, duty, weight = np.array(feet).T
    return Orbit(touchdown, duty, normal_weight(weight, len(feet)), period, vault)


def named(name: str, count: int, duty: float, period: float, vault: float = 0.0) -> Orbit:
    """Return the motion of a gait at any duty, beyond its own range too."""
    legs = Build.plain(count, upright=True).legs
    gait = make_gait(name, legs.side, legs.row)
    low, high = min(gait.duty_low, duty), max(gait.duty_high, duty)
    return orbit_of(
        replace(gait, duty_low=low, duty_high=high).with_duty(duty), period, vault=vault
    )


def gauss(low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes and weights that integrate what is smooth from low to high to the last digit."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    return 0.5 * (low + high) + 0.5 * (high - low) * nodes, 0.5 * (high - low) * weights


@settings(deadline=None)
@given(FEET, PERIODS, VAULTS)
def test_over_a_cycle_a_foot_pushes_with_one_g_and_its_height_is_0(
    feet: list[tuple[float, float, float]], period: float, vault: float
) -> None:
    motion = orbit(feet, period, vault)
    for foot, (touchdown, duty, _) in enumerate(feet):
        stance, stance_weight = gauss(touchdown, touchdown + duty)
        swing, swing_weight = gauss(touchdown + duty, touchdown + 1.0)
        force = motion.foot_force(stance)[:, foot]
        assert stance_weight @ force == pytest.approx(1.0, abs=1e-12)
        assert (motion.foot_force(swing)[:, foot] == 0.0).all()
        unit = GRAVITY * period**2
        height = stance_weight @ motion.foot_height(stance)[:, foot]
        height += swing_weight @ motion.foot_height(swing)[:, foot]
        assert height / unit == pytest.approx(0.0, abs=1e-14)
        speed = stance_weight @ motion.foot_speed(stance)[:, foot]
        speed += swing_weight @ motion.foot_speed(swing)[:, foot]
        assert speed / (GRAVITY * period) == pytest.approx(0.0, abs=1e-14)


@settings(deadline=None)
@given(FEET, PERIODS, VAULTS)
def test_feet_never_pull_and_fall_freely_in_the_air(
    feet: list[tuple[float, float, float]], period: float, vault: float
) -> None:
    motion = orbit(feet, period, vault)
    phase = np.linspace(-1.0, 1.0, 801)
    force = motion.foot_force(phase)
    assert (force >= -1e-12).all()
    assert motion.weakest.value >= -1e-12
    assert motion.strongest.value >= 1.0 - 1e-9
    assert (force.max(axis=0) <= motion.foot_peak * (1.0 + 1e-9)).all()
    for foot, (touchdown, duty, _) in enumerate(feet):
        flight = touchdown + duty + (1.0 - duty) * np.linspace(0.01, 0.99, 21)
        speed = motion.foot_speed(flight)[:, foot]
        fallen = -GRAVITY * period * (flight - flight[0])
        assert speed - speed[0] == pytest.approx(fallen, abs=1e-9 * GRAVITY * period)


@settings(deadline=None)
@given(FEET, PERIODS, VAULTS, st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_what_pushes_makes_speed_and_speed_makes_height(
    feet: list[tuple[float, float, float]], period: float, vault: float, low: float, high: float
) -> None:
    """Between any two phases of a stance, also when it is many turns of the needle ago."""
    motion = orbit(feet, period, vault)
    for foot, (touchdown, duty, _) in enumerate(feet):
        begin, end = touchdown + duty * low, touchdown + duty * high
        phase, weight = gauss(begin, end)
        pushed = weight @ (motion.foot_force(phase)[:, foot] - 1.0)
        speed = motion.foot_speed([begin, end])[:, foot] / (GRAVITY * period)
        assert speed[1] - speed[0] == pytest.approx(pushed, abs=1e-9)
        risen = weight @ motion.foot_speed(phase)[:, foot] / (GRAVITY * period)
        height = motion.foot_height([begin - 3.0, end + 7.0])[:, foot] / (GRAVITY * period**2)
        assert height[1] - height[0] == pytest.approx(risen, abs=1e-11)


@settings(deadline=None)
@given(FEET, PERIODS, VAULTS)
def test_neither_height_nor_speed_jumps_where_a_foot_lands_or_lifts(
    feet: list[tuple[float, float, float]], period: float, vault: float
) -> None:
    motion = orbit(feet, period, vault)
    step = 1e-9
    for foot, (touchdown, duty, _) in enumerate(feet):
        for event in (touchdown, touchdown + duty):
            near = [event - step, event + step]
            speed = motion.foot_speed(near)[:, foot] / (GRAVITY * period)
            height = motion.foot_height(near)[:, foot] / (GRAVITY * period**2)
            assert speed[1] == pytest.approx(speed[0], abs=1e-8)
            assert height[1] == pytest.approx(height[0], abs=1e-8)


@settings(deadline=None)
@given(FEET, PERIODS, VAULTS, st.floats(0.0, 1.0))
def test_where_the_needle_starts_changes_nothing(
    feet: list[tuple[float, float, float]], period: float, vault: float, turn: float
) -> None:
    one = orbit(feet, period, vault)
    other = orbit([(touchdown + turn, d, w) for touchdown, d, w in feet], period, vault)
    unit = GRAVITY * period**2
    assert other.excursion == pytest.approx(one.excursion, abs=1e-9 * unit)
    assert other.strongest.value == pytest.approx(one.strongest.value, abs=1e-9)
    phase = np.linspace(0.0, 1.0, 101)
    assert other.height(phase + turn) == pytest.approx(one.height(phase), abs=1e-12 * unit)


@settings(max_examples=50, deadline=None)
@given(FEET, VAULTS, PERIODS)
def test_extremes_are_those_of_a_fine_sampling(
    feet: list[tuple[float, float, float]], vault: float, period: float
) -> None:
    motion = orbit(feet, period, vault)
    phase = np.linspace(0.0, 1.0, 20001)
    height, force = motion.height(phase), motion.force(phase)
    unit = GRAVITY * period**2
    assert motion.highest.value == pytest.approx(height.max(), abs=1e-7 * unit)
    assert motion.lowest.value == pytest.approx(height.min(), abs=1e-7 * unit)
    assert motion.highest.value >= height.max() - 1e-9 * unit
    assert motion.strongest.value == pytest.approx(force.max(), rel=1e-3)
    assert motion.strongest.value >= force.max() * (1.0 - 1e-6)
    assert motion.height(motion.lowest.phase) == pytest.approx(motion.lowest.value, abs=1e-12)


@pytest.mark.parametrize("vault", [0.0, 0.1, 1.0 / 9.0, VAULT, 1.0])
def test_a_foots_peak(vault: float) -> None:
    motion = Orbit(np.array([0.2]), np.array([0.35]), np.ones(1), 1.0, vault)
    force = motion.foot_force(np.linspace(0.2, 0.55, 100001)).max()
    assert motion.foot_peak[0] == pytest.approx(force, rel=1e-9)
    if vault == 0.0:
        assert motion.foot_peak[0] == pytest.approx(math.pi / (2 * 0.35), rel=1e-12)


def test_a_lone_foot_takes_off_with_half_the_swings_fall() -> None:
    """P2's equation 5c."""
    for duty in (0.1, 0.35, 0.6):
        motion = Orbit(np.array([0.0]), np.array([duty]), np.ones(1), 0.7)
        swing = 0.7 * (1.0 - duty)
        assert motion.speed(duty) == pytest.approx(0.5 * GRAVITY * swing, rel=1e-12)
        assert motion.speed(0.5 * duty) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("duty", [0.25, 0.35, 0.42, 0.5])
@pytest.mark.parametrize(("name", "count"), [("run", 2), ("trot", 4), ("trot", 6)])
def test_two_equal_beats(name: str, count: int, duty: float) -> None:
    """A = g P (P / 8 - (1/4 - 1 / (2 pi)) t_c), of a beat P with a contact t_c within it."""
    period = 0.6
    beat, contact = period / 2, duty * period
    expected = GRAVITY * beat * (beat / 8 - (0.25 - 0.5 / math.pi) * contact)
    assert named(name, count, duty, period).excursion == pytest.approx(expected, rel=1e-9)


def test_the_design_s_own_figures() -> None:
    unit = GRAVITY**-0.5
    assert named("trot", 4, 0.5, unit).excursion == pytest.approx(0.0085, abs=5e-5)
    assert named("tripod", 6, 0.5, unit).excursion == pytest.approx(0.0085, abs=5e-5)
    assert named("trot", 4, 0.42, unit).excursion == pytest.approx(0.0122, abs=5e-5)


# Stride time in s, duty, q; then the excursion in cm: as the closed form has it, and as measured.
ANIMALS = [
    ("man walking, 1.4 m/s", "walk", 2, 1.06, 0.62, VAULT, 4.2, (4.0, 5.0)),
    ("man running, 3 m/s", "run", 2, 0.72, 0.347, 0.0, 7.8, (7.0, 8.0)),
    ("horse at a trot", "trot", 4, 0.68, 0.40, 0.0, 5.9, (4.7, 5.9)),
    ("middling dog at a trot", "trot", 4, 0.47, 0.45, 0.0, 2.4, (2.3, 2.3)),
    ("cockroach, 13 steps a second", "tripod", 6, 1 / 13, 0.5, 0.0, 0.05, (0.03, 0.05)),
]


@pytest.mark.parametrize(
    ("what", "name", "count", "period", "duty", "vault", "computed", "measured"), ANIMALS
)
def test_bodies_rise_as_far_as_measured_on_animals(
    what: str, name: str, count: int, period: float, duty: float, vault: float, computed: float,
    measured: tuple[float, float],
) -> None:  # fmt: skip
    motion = named(name, count, duty, period, vault)
    found = 100.0 * motion.excursion
    assert found == pytest.approx(computed, rel=0.03), what
    assert 0.5 * measured[0] <= found <= 1.5 * measured[1], what
    middle = (motion.touchdown[0] + 0.5 * duty) % 0.5
    turning = motion.highest if vault else motion.lowest
    assert turning.phase % 0.5 == pytest.approx(middle, abs=1e-6), what


def test_many_feet_hardly_bounce() -> None:
    # Elephants and spiders: their feet take turns, and the bounces cancel.
    assert named("amble", 4, 0.5, 1.0).excursion < 0.005
    assert named("spider", 8, 0.55, 0.15).excursion < 0.001
    # A gallop gathers: once a stride, highest after the fore feet have pushed off.
    gallop = named("transverse-gallop", 4, 0.25, 0.45)
    assert gallop.excursion == pytest.approx(0.064, abs=0.001)
    assert 0.77 < gallop.highest.phase < 1.0


@pytest.mark.parametrize("name", names())
def test_size_and_tempo_only_scale_it(name: str) -> None:
    count = 6 if name in ("tripod", "tetrapod", "wave") else 4
    legs = Build.plain(count, upright=True).legs
    gait = make_gait(name, legs.side, legs.row)
    excursion = [orbit_of(gait, period).excursion / period**2 for period in (0.02, 0.7, 6.0)]
    assert excursion == pytest.approx([excursion[0]] * 3, rel=1e-9)


def test_weights_shift_the_body_toward_heavy_feet() -> None:
    legs = Build.plain(4, upright=True).legs
    gait = make_gait("bound", legs.side, legs.row)
    even, hind = orbit_of(gait, 0.5), orbit_of(gait, 0.5, weight=[3.0, 3.0, 1.0, 1.0])
    assert hind.strongest.value == pytest.approx(1.5 * even.strongest.value)
    assert hind.excursion > even.excursion
    scaled = orbit_of(gait, 0.5, weight=[3e300, 3e300, 1e300, 1e300])
    assert scaled.excursion == pytest.approx(hind.excursion, rel=1e-12)


def test_who_vaults() -> None:
    legs = Build.plain(4, upright=True).legs
    walk, trot = (make_gait(name, legs.side, legs.row) for name in ("walk", "trot"))
    assert vault_of(walk, upright=True) == VAULT
    assert vault_of(walk, upright=False) == vault_of(trot, upright=True) == 0.0
    assert check_gait(walk).orbit.vault == VAULT


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"period": 0.0}, "above 0"),
        ({"period": math.nan}, "above 0"),
        ({"period": math.inf}, "above 0"),
        ({"vault": 1.5}, "from 0 to 1"),
        ({"vault": math.nan}, "from 0 to 1"),
        ({"weight": [1.0]}, "2 numbers, one for each foot"),
        ({"weight": [1.0, 0.0]}, "above 0"),
        ({"weight": [1.0, math.nan]}, "above 0"),
        ({"weight": ["a", "b"]}, "list of numbers"),
        ({"weight": [[1.0], [2.0, 3.0]]}, "list of numbers"),
    ],
)
def test_numbers_that_cannot_be_used(changes: dict[str, object], words: str) -> None:
    gait = Gait("two", np.array([0.75, 0.25]), np.array([0.25, 0.5]))
    with pytest.raises(SettingError, match=words):
        orbit_of(gait, **{"period": 0.5, **changes})  # type: ignore[arg-type]
