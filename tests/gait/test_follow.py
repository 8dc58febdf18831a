"""Gaits that follow speed: when they change, how, and what is pinned; strides that vary."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from walker import paired

from polypod.config import Settings
from polypod.errors import SettingError
from polypod.gait.follow import PINNED, next_rung, note_gait_speed
from polypod.gait.library import gait_ladder
from polypod.gait.tempo import GRAVITY
from polypod.gait.variation import period_factor
from polypod.herd import Herd
from polypod.math.intervals import covered_share
from polypod.morphology.load import load_rig
from polypod.world import World

QUADRUPED = (0.35, 2.0, 3.0)
LIMIT = np.array([*QUADRUPED, math.inf])


def speed_of(froude: float, length: float = 0.5) -> float:
    return math.sqrt(froude * GRAVITY * length)


@settings(deadline=None)  # the first call loads a kernel
@given(st.lists(st.floats(0.0, 30.0), min_size=1, max_size=40), st.floats(0.01, 5.0))
def test_a_rung_is_left_a_tenth_late_and_never_twice_for_one_wobble(
    froudes: list[float], length: float
) -> None:
    rung = next_rung(PINNED, 0.0, length, LIMIT)
    assert rung == 0
    for froude in froudes:
        before = rung
        for _ in QUADRUPED:
            # Upward one at a time.
            last, rung = rung, next_rung(rung, speed_of(froude, length), length, LIMIT)
            assert rung <= last + 1
        # Where the speed has not passed the band about a limit, nothing changes.
        for place, limit in enumerate(QUADRUPED):
            if froude > 1.1001 * limit:
                assert rung > place
            elif froude < 0.8999 * limit:
                assert rung <= place
            elif 0.9001 * limit < froude < 1.0999 * limit:
                assert (rung > place) == (before > place)


def test_who_has_no_rung_takes_the_one_of_its_speed() -> None:
    for froude, rung in ((0.0, 0), (0.34, 0), (0.36, 1), (2.5, 2), (9.0, 3)):
        assert next_rung(PINNED, speed_of(froude), 0.5, LIMIT) == rung


@pytest.mark.parametrize(
    ("count", "upright", "names"),
    [
        (2, True, ("walk", "run")),
        (4, True, ("walk", "trot", "canter", "transverse-gallop")),
        (4, False, ("lizard",)),
        (6, False, ("insect",)),
        (8, False, ("spider",)),
        (30, False, ("centipede",)),
    ],
)
def test_the_ladder_of_a_build(count: int, upright: bool, names: tuple[str, ...]) -> None:
    found, limits = gait_ladder(*paired(count), upright)
    assert found == names
    assert len(limits) == len(names) - 1
    assert list(limits) == sorted(limits)


def test_who_is_held_back_for_a_moment_keeps_its_gait() -> None:
    herd = Herd(load_rig("wolf"), 1, Settings())
    state, length = herd.state, herd.tables.hip_height
    state.cycle_rate[:] = 2.0
    state.gait_speed[:] = 1.6

    def rung_after(speed: float, cycles: float) -> int:
        for _ in range(round(cycles / 0.05)):
            note_gait_speed(0, speed, 0.05, herd.kernel_state)
        return next_rung(1, float(state.gait_speed[0]), length, herd.tables.ladder.limit)

    for _ in range(10):
        # Half as fast for half a cycle, and up to speed again.
        assert rung_after(0.8, 0.5) == 1
        assert rung_after(1.6, 0.5) == 1
    assert rung_after(0.8, 4.0) == 0
    # Who stands has no speed to choose by.
    state.cycle_rate[:] = 0.0
    note_gait_speed(0, 1.6, 0.05, herd.kernel_state)
    assert state.gait_speed[0] == 0.0


@settings(deadline=None)
@given(
    st.lists(st.tuples(st.floats(0.0, 0.999), st.floats(0.0, 0.9)), min_size=1, max_size=8),
    st.booleans(),
)
def test_the_share_of_the_circle_that_sectors_cover(
    sectors: list[tuple[float, float]], doubled: bool
) -> None:
    if doubled:
        sectors = sectors * 2
    start, extent = (np.array(part) for part in zip(*sectors, strict=True))
    phase = (np.arange(4000) + 0.5) / 4000
    inside = (phase[:, None] - start) % 1.0 < extent
    measured = inside.any(axis=1).mean()
    assert covered_share(start, extent) == pytest.approx(measured, abs=len(sectors) / 1500)


def test_strides_vary_as_much_as_asked_and_by_the_seed_alone() -> None:
    def factors(seed: int, creature: int) -> np.ndarray:
        return np.array([period_factor(seed, creature, n, 0.03) for n in range(800)])

    one = factors(1, 0)
    assert one.mean() == pytest.approx(1.0, abs=0.004)
    assert one.std() == pytest.approx(0.03, rel=0.1)
    assert np.abs(one - 1.0).max() <= 0.03 * 3.5
    assert np.array_equal(one, factors(1, 0))
    for other in (factors(2, 0), factors(1, 1)):
        assert abs(np.corrcoef(one, other)[0, 1]) < 0.15
    assert abs(np.corrcoef(one[1:], one[:-1])[0, 1]) < 0.15


@pytest.mark.parametrize("seed", [-1, 1.5, 2**31, "one"])
def test_a_seed_that_is_none_is_refused(seed: object) -> None:
    with pytest.raises(SettingError, match="seed"):
        World(seed=seed)  # type: ignore[arg-type]
