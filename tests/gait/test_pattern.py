from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.errors import GaitError
from polypod.gait.library import make_gait
from polypod.gait.needle import minimum_feet_down
from polypod.gait.pattern import Gait, wrapped

# Phases on a grid finer than any event must be told apart, coarse against rounding.
phases = st.integers(0, 9999).map(lambda i: i / 10000.0)
extents = st.integers(100, 9900).map(lambda i: i / 10000.0)
disks = st.lists(st.tuples(phases, extents), min_size=1, max_size=40)


def test_counts_of_a_gait_worked_out_by_hand() -> None:
    gait = Gait("three", [0.0, 0.25, 0.5], [0.5, 0.5, 0.5])
    # Swings [0, .5), [.25, .75), [.5, 1): one, two, two, one in the air in the four quarters.
    assert gait.feet_down([0.0, 0.2, 0.3, 0.6, 0.9]).tolist() == [2, 2, 1, 1, 2]
    length, down = gait.support()
    assert length == pytest.approx([0.25, 0.25, 0.25, 0.25])
    assert down.tolist() == [2, 1, 1, 2]
    assert (gait.minimum_feet_down, gait.maximum_feet_down, gait.flight_share) == (1, 2, 0.0)
    assert gait.duty == 0.5
    assert gait.duty_sum == 1.5
    assert gait.touchdown == pytest.approx([0.5, 0.75, 0.0])


def test_feet_that_change_places_leave_no_gap_through_rounding() -> None:
    # .1 + .2 is not .3: without care one of the two moments would have no foot down.
    gait = Gait("pair", [0.3, 0.1 + 0.7], [0.5, 0.5 + 1e-13])
    assert gait.minimum_feet_down == 1
    assert minimum_feet_down(gait.swing_start.copy(), gait.swing_extent.copy()) == 1
    assert gait.flight_share == 0.0


@given(disks)
def test_arcs_cover_the_cycle_and_agree_with_sampling(feet: list[tuple[float, float]]) -> None:
    gait = Gait("any", *np.array(feet).T)
    length, down = gait.support()
    assert length.sum() == pytest.approx(1.0, abs=1e-6)
    assert (length * down).sum() == pytest.approx(gait.duty_sum, abs=1e-6)
    # Events lie on the grid of ten-thousandths: half-way between them every arc is met.
    sampled = gait.feet_down((np.arange(10000) + 0.5) / 10000.0)
    assert gait.minimum_feet_down == sampled.min()
    assert gait.maximum_feet_down == sampled.max()
    assert gait.flight_share == pytest.approx(np.mean(sampled == 0), abs=1e-6)


@given(disks)
def test_the_kernel_counts_as_the_pattern_does(feet: list[tuple[float, float]]) -> None:
    gait = Gait("any", *np.array(feet).T)
    counted = minimum_feet_down(gait.swing_start.copy(), gait.swing_extent.copy())
    assert counted == gait.minimum_feet_down


@given(disks, st.floats(0.0, 1.0), st.floats(0.05, 0.95))
@settings(max_examples=200)
def test_turning_all_disks_changes_no_count(
    feet: list[tuple[float, float]], shift: float, phase: float
) -> None:
    start, extent = np.array(feet).T
    gait, turned = Gait("a", start, extent), Gait("a", wrapped(start + shift), extent)
    assert turned.minimum_feet_down == gait.minimum_feet_down
    assert turned.maximum_feet_down == gait.maximum_feet_down


def test_duty_moves_lift_offs_and_keeps_touchdowns_and_shares() -> None:
    gait = Gait("uneven", [0.6, 0.1], [0.4, 0.3], duty_low=0.3, duty_high=0.7)
    slower = gait.with_duty(0.5)
    assert slower.duty == pytest.approx(0.5)
    assert slower.touchdown == pytest.approx(gait.touchdown)
    assert (1 - slower.swing_extent) / 0.5 == pytest.approx((1 - gait.swing_extent) / gait.duty)
    assert gait.with_duty(0.01).duty == pytest.approx(0.3)
    assert gait.with_duty(0.99).duty == pytest.approx(0.7)
    assert gait.with_duty(0.4).with_duty(gait.duty).swing_start == pytest.approx(gait.swing_start)


def test_a_gait_without_a_range_keeps_its_duty() -> None:
    gait = Gait("own", [0.0, 0.5], [0.4, 0.4])
    assert gait.with_duty(0.2).swing_extent == pytest.approx([0.4, 0.4])


def test_the_needle_of_a_standing_creature_waits_where_no_foot_is_amid_a_swing() -> None:
    for name in ("walk", "trot", "tripod", "wave", "spider", "pronk"):
        gait = make_gait(name, [1, -1, 1, -1, 1, -1], [0, 0, 1, 1, 2, 2])
        before = gait.feet_down(gait.standing_phase - 1e-6)
        assert before == gait.maximum_feet_down
        assert np.isclose(gait.swing_start, gait.standing_phase).any()


def test_arrays_are_the_gaits_own() -> None:
    given_start = np.array([0.0, 0.5])
    gait = Gait("own", given_start, [0.4, 0.4])
    given_start[0] = 0.9
    assert gait.swing_start[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        gait.swing_start[0] = 0.3


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"name": ""}, "name must be printable"),
        ({"name": "a\nb"}, "name must be printable"),
        ({"name": 3}, "name must be printable"),
        ({"family": "swim"}, "choose from walk, run, arthropod"),
        ({"swing_start": [0.0]}, "one start and one extent for each foot"),
        ({"swing_start": [], "swing_extent": []}, "one start and one extent for each foot"),
        ({"swing_start": [0.0, math.nan]}, "swing_start must be a list of finite numbers"),
        ({"swing_start": [0.0, 1.0]}, "foot 1 starts its swing at 1;"),
        ({"swing_start": [-0.1, 0.0]}, "foot 0 starts its swing at -0.1;"),
        ({"swing_start": [[0.0, 0.5]]}, "list of finite numbers"),
        ({"swing_start": ["a", "b"]}, "swing_start must be a list of numbers"),
        ({"swing_extent": [0.5, math.inf]}, "swing_extent must be a list of finite numbers"),
        ({"swing_extent": [0.5, 0.0]}, "foot 1 swings for 0 of the cycle"),
        ({"swing_extent": [1.0, 0.5]}, "foot 0 swings for 1 of the cycle"),
        ({"swing_extent": [1e-300, 0.5]}, "foot 0 swings for 1e-300 of the cycle"),
        ({"lag_per_duty": [0.0, math.nan]}, "lag_per_duty must be a list of finite numbers"),
        ({"lag_per_duty": [0.0, 0.0, 0.0]}, "3 lags"),
        ({"duty_low": 0.7, "duty_high": 0.8}, "outside of its own range from 0.7 to 0.8"),
        ({"duty_low": 0.0, "duty_high": 0.6}, "no swing or no stance"),
        ({"duty_low": 0.3, "duty_high": 1.0}, "no swing or no stance"),
        ({"period": 0.0}, "a period of 0.0 s"),
        ({"period": math.inf}, "a period of inf s"),
    ],
)
def test_what_is_no_gait_is_refused_with_the_reason(change: dict[str, object], words: str) -> None:
    sound: dict[str, object] = {"name": "g", "swing_start": [0.0, 0.5], "swing_extent": [0.5, 0.5]}
    with pytest.raises(GaitError, match=words.replace("(", r"\(")):
        Gait(**{**sound, **change})  # type: ignore[arg-type]


def test_a_duty_that_is_no_number_is_refused() -> None:
    with pytest.raises(GaitError, match="cannot have a duty of nan"):
        Gait("g", [0.0], [0.5]).with_duty(math.nan)
