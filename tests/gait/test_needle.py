from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from walker import Walker, paired

from polypod.gait.library import make_gait, names
from polypod.gait.needle import (
    lift_phase,
    next_foot_to_lift,
    progress_since_lift,
    step_count,
    swing_progress,
    turn_needle,
)
from polypod.math.intervals import sector_progress, wrap_phase

unit = st.floats(0.0, 1.0, exclude_max=True)


@given(st.floats(-1e6, 1e6))
def test_a_wrapped_phase_is_on_the_same_place_of_the_circle(phase: float) -> None:
    wrapped = wrap_phase(phase)
    assert 0.0 <= wrapped < 1.0
    assert abs((phase - wrapped) - round(phase - wrapped)) < 1e-9


def test_a_tiny_negative_phase_does_not_become_one() -> None:
    assert wrap_phase(-1e-18) == 0.0
    assert wrap_phase(1.0) == 0.0
    assert wrap_phase(-0.25) == 0.75


@pytest.mark.parametrize(
    ("needle", "progress"),
    [(0.875, 0.0), (0.0, 0.25), (0.125, 0.5), (0.25, 0.75), (0.375, -1.0), (0.5, -1.0)],
)
def test_progress_in_a_sector_across_zero(needle: float, progress: float) -> None:
    assert swing_progress(needle, 0.875, 0.5) == progress


@given(unit, unit, st.floats(0.01, 0.99))
def test_progress_is_below_one_and_the_sector_half_open(
    needle: float, start: float, extent: float
) -> None:
    progress = sector_progress(needle, start, extent)
    assert progress == -1.0 or 0.0 <= progress < 1.0
    assert sector_progress(start, start, extent) == 0.0


@given(st.lists(st.tuples(unit, st.floats(0.05, 0.95)), min_size=1, max_size=1), unit)
def test_two_sectors_that_meet_share_no_phase(
    feet: list[tuple[float, float]], needle: float
) -> None:
    start, extent = feet[0]
    inside = sector_progress(needle, start, extent) >= 0.0
    rest = sector_progress(needle, wrap_phase(start + extent), 1.0 - extent) >= 0.0
    edge = abs((needle - start - extent + 0.5) % 1.0 - 0.5) < 1e-12
    edge |= abs((needle - start + 0.5) % 1.0 - 0.5) < 1e-12
    assert inside != rest or edge


def test_the_needle_turns_once_a_period() -> None:
    needle, turned = 0.9, 0.0
    for _ in range(30):
        step = turn_needle(needle, 1.0 / 30.0, 0.4)
        needle, turned = step.needle, turned + step.turn
    assert turned == pytest.approx(2.5)
    assert needle == pytest.approx(0.4)
    assert turn_needle(0.3, 1.0, math.inf) == (0.3, 0.0)


@pytest.mark.parametrize(
    ("turn", "extent", "parts"),
    [
        (0.0, [0.5, 0.5], 1),
        (0.1, [0.5, 0.5], 1),
        (0.26, [0.5, 0.5], 2),
        (0.48, [0.2, 0.7], 5),
        (0.48, [0.7, 0.8], 5),
        (3.0, [0.5], 12),
        (1e9, [0.5], 256),
    ],
)
def test_a_long_turn_goes_in_parts_below_half_a_sector(
    turn: float, extent: list[float], parts: int
) -> None:
    assert step_count(turn, np.array(extent)) == parts


def test_a_late_swing_ends_with_its_sector() -> None:
    # Sector [.8, 1.2), left at .9: progress runs from there.
    for needle, progress in ((0.9, 0.0), (0.05, 0.5), (0.125, 0.75), (0.2, 1.0), (0.5, 1.0)):
        assert progress_since_lift(needle, 0.9, 0.8, 0.4) == pytest.approx(progress)
    assert progress_since_lift(0.0, 0.8, 0.8, 0.4) == pytest.approx(0.5)
    # A lift just before the sector, by rounding, is one at its start.
    assert progress_since_lift(0.0, 0.8 - 1e-17, 0.8, 0.4) == pytest.approx(0.5)
    assert progress_since_lift(0.9, 0.95, 0.8, 0.4) == 0.0


def test_a_swing_began_at_its_sector_or_late_where_the_needle_is() -> None:
    assert lift_phase(0.33, 0.05, 0.30) == 0.30
    assert lift_phase(0.02, 0.05, 0.98) == 0.98
    assert lift_phase(0.40, 0.05, 0.30) == 0.40


def lift(
    needle: float,
    *,
    in_swing: tuple[int, ...] = (),
    held: tuple[int, ...] = (),
    stood: float = 1.0,
    minimum: int = 0,
    window: float = 0.5,
    turn: float = 0.0,
) -> int:
    """Ask for the next foot of four whose sectors begin at 0, .1, .2 and .6, of extent .4."""
    swinging, holding = np.zeros(4, bool), np.zeros(4, bool)
    swinging[list(in_swing)] = True
    holding[list(held)] = True
    start, extent = np.array([0.0, 0.1, 0.2, 0.6]), np.full(4, 0.4)
    return next_foot_to_lift(
        needle, start, extent, swinging, np.full(4, stood), holding, minimum, window, turn
    )


def test_the_foot_that_is_due_for_longest_lifts_first() -> None:
    assert lift(0.05) == 0
    assert lift(0.15) == 0
    assert lift(0.15, in_swing=(0,)) == 1
    assert lift(0.15, held=(0,)) == 1
    assert lift(0.15, in_swing=(0,), held=(1,)) == -1
    assert lift(0.55) == -1


def test_a_late_lift_has_a_window_then_waits_for_the_next_cycle() -> None:
    assert lift(0.199, held=(1,)) == 0
    assert lift(0.201, held=(1, 2)) == -1
    assert lift(0.39, held=(1, 2), window=1.0) == 0
    assert lift(0.0, held=(1, 2)) == 0


def test_no_foot_lifts_that_would_leave_too_few_down() -> None:
    assert lift(0.15, minimum=3) == 0
    assert lift(0.15, minimum=4) == -1
    assert lift(0.15, in_swing=(3,), minimum=2) == 0
    assert lift(0.15, in_swing=(3,), minimum=3) == -1


def test_a_foot_whose_sector_ends_in_this_step_counts_as_down_where_it_lands_after() -> None:
    # Foot 3 swings over [.6, 1): at .02 it has just come to its end.
    for turn, foot in ((0.0, -1), (0.01, -1), (0.03, 0), (0.5, 0)):
        assert lift(0.02, in_swing=(3,), minimum=3, turn=turn) == foot
    # One that still swings does not.
    assert lift(0.98, in_swing=(3, 2), held=(1,), minimum=2, turn=0.5) == -1
    assert lift(0.10, in_swing=(3,), minimum=4, turn=0.5) == -1


def test_a_foot_that_just_landed_stands_first() -> None:
    # Its stance is .6 of the cycle; half of it is fair.
    assert lift(0.05, stood=0.29) == -1
    assert lift(0.05, stood=0.31) == 0


@pytest.mark.parametrize("turn", [1 / 200, 1 / 37, 1 / 12])
@pytest.mark.parametrize("name", names())
def test_a_steady_walk_is_its_disks(name: str, turn: float) -> None:
    """Every foot lifts once a cycle, on time, and the feet down are those the disks say."""
    gait = make_gait(name, *paired(6))
    walker = Walker(gait, 0.0321)
    lifts = np.zeros(6, int)
    for _ in range(round(5 / turn)):
        _, lifted, _ = walker.step(turn)
        lifts[lifted] += 1
        for k in lifted:
            assert walker.lifted[k] == walker.start[k]
        inside = (walker.needle - gait.swing_start) % 1.0
        edge = np.minimum(np.abs(inside - gait.swing_extent), np.minimum(inside, 1.0 - inside))
        sure = edge > 1e-9
        assert (walker.in_swing == (inside < gait.swing_extent))[sure].all()
    assert set(lifts.tolist()) <= {4, 5, 6}


@pytest.mark.parametrize("name", ["walk", "trot", "tripod", "wave", "rotary-gallop", "spider"])
def test_a_creature_that_starts_from_a_stand_is_in_step_within_two_cycles(name: str) -> None:
    gait = make_gait(name, *paired(8))
    walker = Walker(gait, gait.standing_phase)
    walker.in_swing[:] = False
    walker.stood[:] = 1.0
    fewest = walker.walk(1.0, 1 / 100).fewest_down
    assert fewest >= gait.minimum_feet_down
    walker.walk(1.0, 1 / 100)
    for _ in range(100):
        walker.step(1 / 100)
        inside = (walker.needle + 1e-6 - gait.swing_start) % 1.0
        assert (walker.in_swing == (inside < gait.swing_extent)).all()
