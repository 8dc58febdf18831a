from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from walker import Walker, paired

from polypod.gait.library import make_gait, names
from polypod.gait.pattern import Gait, wrapped
from polypod.gait.transition import (
    ALIGNMENTS,
    align_cycle,
    approach_disk,
    approach_disks,
    start_shift,
)
from polypod.math.intervals import sector_progress, wrap_phase

unit = st.floats(0.0, 1.0, exclude_max=True)
extents = st.floats(0.05, 0.95)


@pytest.mark.parametrize(
    ("start", "destination", "extent", "shift"),
    [
        (0.2, 0.2, 0.3, 0.0),
        # P1 Figure 9: from within the destination's sector back, from elsewhere forward.
        (0.3, 0.2, 0.3, -0.1),
        (0.1, 0.2, 0.3, 0.1),
        (0.6, 0.2, 0.3, 0.6),
        (0.05, 0.9, 0.3, -0.15),
        (0.25, 0.9, 0.3, 0.65),
        # The long way round rather than across the finish, however near it is by the other.
        (0.51, 0.0, 0.5, 0.49),
        (0.95, 0.0, 0.97, -0.95),
        # On the finish it passes it in neither direction: the shorter.
        (0.25, 0.0, 0.25, -0.25),
        (0.75, 0.0, 0.75, 0.25),
    ],
)
def test_a_start_travels_by_the_papers_rule(
    start: float, destination: float, extent: float, shift: float
) -> None:
    assert start_shift(start, destination, extent) == pytest.approx(shift)


@given(unit, unit, extents)
def test_a_start_arrives_and_never_passes_the_finish(
    start: float, destination: float, extent: float
) -> None:
    shift = start_shift(start, destination, extent)
    assert abs(shift) < 1.0
    arrived = wrap_phase(start + shift)
    assert abs((arrived - destination + 0.5) % 1.0 - 0.5) < 1e-9
    finish = wrap_phase(destination + extent)
    away = wrap_phase(finish - start) if shift > 0.0 else wrap_phase(start - finish)
    if min(away, 1.0 - away) > 1e-8:
        assert away > abs(shift) - 1e-9


@given(unit, extents, unit, extents, st.integers(1, 40), st.floats(0.3, 5.0))
def test_a_transition_is_linear_whatever_the_steps_and_exact_at_its_end(
    start: float, extent: float, to_start: float, to_extent: float, steps: int, cycles: float
) -> None:
    goal_start, goal_extent = np.array([start]), np.array([extent])
    aim_start, aim_extent = np.array([to_start]), np.array([to_extent])
    shift = start_shift(start, to_start, to_extent)
    left = cycles
    # Near the finish the direction is decided by rounding.
    if abs(wrap_phase(start - to_start) - to_extent) < 1e-6:
        return
    for i in range(1, steps):
        left = approach_disks(goal_start, goal_extent, aim_start, aim_extent, cycles / steps, left)
        expected = wrap_phase(start + shift * i / steps)
        assert abs((goal_start[0] - expected + 0.5) % 1.0 - 0.5) < 1e-9
        assert goal_extent[0] == pytest.approx(extent + (to_extent - extent) * i / steps)
    left = approach_disks(goal_start, goal_extent, aim_start, aim_extent, cycles, left)
    assert left == 0.0
    assert (goal_start[0], goal_extent[0]) == (to_start, to_extent)


def test_a_disk_half_way() -> None:
    half = approach_disk(0.9, 0.3, 0.1, 0.5, 0.5)
    assert half == pytest.approx((0.0, 0.4))
    assert approach_disk(0.9, 0.3, 0.1, 0.5, 1.0) == (0.1, 0.5)
    assert approach_disk(0.9, 0.3, 0.1, 0.5, 0.0) == pytest.approx((0.9, 0.3))


def check(walker: Walker, minimum: int, cycles: float, turn: float, destination: Gait) -> None:
    """Walk through a transition and check all that is promised of it."""
    began = int(np.count_nonzero(~walker.in_swing))
    source = walker.extent.copy()
    seen = walker.walk(cycles + 3.0, turn)
    # Who begins amid a step has what the disks gave; never fewer than the weaker gait's minimum.
    assert seen.fewest_down >= min(minimum, began)
    assert seen.arrived_after <= cycles + 1.0 + 2.0 * turn
    assert walker.start == pytest.approx(destination.swing_start)
    assert walker.extent == pytest.approx(destination.swing_extent)
    fair = 0.5 * (1.0 - np.maximum(source, destination.swing_extent))
    assert (seen.shortest_stance >= fair - turn).all()
    shortest = np.minimum(source, destination.swing_extent)
    assert (seen.shortest_swing >= 0.5 * shortest - turn - 1e-9).all()


@pytest.mark.parametrize("count", [2, 4, 5, 6, 8, 20])
def test_any_gait_changes_to_any_other(count: int) -> None:
    side, row = paired(count)
    gaits = [make_gait(name, side, row) for name in names()]
    for i, (one, other) in enumerate(itertools.permutations(gaits, 2)):
        walker = Walker(one, (i * 0.618) % 1.0)
        walker.change_to(other, 1.5)
        check(walker, min(one.minimum_feet_down, other.minimum_feet_down), 1.5, 1 / 30, other)


@given(
    st.integers(2, 40), st.sampled_from(names()), st.sampled_from(names()), unit,
    st.floats(0.5, 4.0), st.floats(0.01, 0.06), st.floats(0.1, 0.9), st.floats(0.1, 0.9),
    st.booleans(),
)  # fmt: skip
@settings(max_examples=150, deadline=None)
def test_transitions_hold_their_promises_for_any_legs_tempo_and_duty(
    count: int, source: str, aim: str, needle: float, cycles: float, turn: float, duty: float,
    aim_duty: float, align: bool,
) -> None:  # fmt: skip
    side, row = paired(count)
    one, other = make_gait(source, side, row, duty), make_gait(aim, side, row, aim_duty)
    walker = Walker(one, needle)
    walker.change_to(other, cycles, align)
    check(walker, min(one.minimum_feet_down, other.minimum_feet_down), cycles, turn, other)


@given(
    st.integers(2, 12), st.lists(st.sampled_from(names()), min_size=3, max_size=5), unit,
    st.lists(st.floats(0.05, 1.2), min_size=4, max_size=4),
)  # fmt: skip
@settings(max_examples=50, deadline=None)
def test_a_transition_may_be_redirected_at_any_moment(
    count: int, way: list[str], needle: float, after: list[float]
) -> None:
    side, row = paired(count)
    gaits = [make_gait(name, side, row) for name in way]
    walker = Walker(gaits[0], needle)
    began = int(np.count_nonzero(~walker.in_swing))
    for gait, cycles in zip(gaits[1:], after, strict=False):
        walker.change_to(gait, 1.5)
        seen = walker.walk(cycles, 1 / 60)
        assert seen.fewest_down >= min(began, *(gait.minimum_feet_down for gait in gaits))
    check(walker, min(gait.minimum_feet_down for gait in gaits), 1.5, 1 / 60, gaits[len(gaits) - 1])


def test_the_same_gait_is_no_transition() -> None:
    gait = make_gait("spider", *paired(8))
    walker, untouched = Walker(gait, 0.3), Walker(gait, 0.3)
    walker.change_to(gait, 1.5, align=True)
    for _ in range(100):
        assert walker.step(0.031) == untouched.step(0.031)
        assert (walker.start == gait.swing_start).all()


def test_a_swinging_foot_keeps_its_disk_until_it_lands() -> None:
    trot, wave = (make_gait(name, *paired(4)) for name in ("trot", "wave"))
    walker = Walker(trot, 0.1)
    walker.change_to(wave, 1.5)
    kept = {int(k): (walker.start[k], walker.extent[k]) for k in np.flatnonzero(walker.in_swing)}
    assert kept
    for _ in range(400):
        landed, lifted, _ = walker.step(1 / 100)
        for k in landed:
            kept.pop(int(k), None)
        for k in lifted:
            kept[int(k)] = (walker.start[k], walker.extent[k])
        for k, disk in kept.items():
            assert (walker.start[k], walker.extent[k]) == disk


def test_no_swing_begins_amid_its_sector() -> None:
    """A foot whose new sector the needle is in begins its swing there, at progress 0."""
    for source, aim in itertools.permutations(("pace", "tripod", "rotary-gallop", "wave"), 2):
        one, other = (make_gait(name, *paired(6)) for name in (source, aim))
        walker = Walker(one, 0.4)
        walker.change_to(other, 1.5)
        for _ in range(300):
            _, lifted, _ = walker.step(1 / 60)
            for k in lifted:
                late = wrap_phase(walker.needle - walker.lifted[k])
                assert late <= 1 / 60 + 1e-9
                assert sector_progress(walker.lifted[k], walker.start[k], walker.extent[k]) < 0.5


def test_aligning_changes_no_step_and_brings_the_gaits_near() -> None:
    one, other = (make_gait(name, *paired(6)) for name in ("millipede", "wave"))
    needle, lifted = 0.3, wrapped(one.swing_start + 0.05)
    start, goal = one.swing_start.copy(), one.swing_start.copy()

    def farthest(starts: np.ndarray) -> float:
        shift = map(start_shift, starts, other.swing_start, other.swing_extent)
        return max(max(each, -0.5 * each) for each in shift)

    far = farthest(start)
    tried = [farthest(wrapped(start + i / ALIGNMENTS)) for i in range(ALIGNMENTS)]
    aligned = align_cycle(needle, start, goal, lifted, other.swing_start, other.swing_extent)
    assert farthest(goal) == pytest.approx(min(tried))
    assert farthest(goal) < far - 0.1
    turn = wrap_phase(aligned - needle)
    assert turn > 0.0
    for turned, before in ((start, one.swing_start), (goal, one.swing_start)):
        assert wrapped(turned - before) == pytest.approx(np.full(6, turn))
    assert wrapped(lifted - one.swing_start - 0.05) == pytest.approx(np.full(6, turn))


def test_aligning_two_gaits_that_agree_turns_nothing() -> None:
    for name in names():
        gait = make_gait(name, *paired(8))
        start, goal = gait.swing_start.copy(), gait.swing_start.copy()
        lifted = start.copy()
        aligned = align_cycle(0.25, start, goal, lifted, gait.swing_start, gait.swing_extent)
        assert aligned == 0.25
        assert (start == gait.swing_start).all()


def test_a_duty_that_follows_speed_goes_the_same_way() -> None:
    """Duty creeps up and down in a named gait: support never breaks, disks keep up."""
    slow = make_gait("walking-trot", *paired(4), 0.75)
    fast = slow.with_duty(0.60)
    walker = Walker(slow, 0.2)
    for i in range(600):
        share = 0.5 - 0.5 * math.cos(2 * math.pi * i / 300)
        aim = slow.with_duty(0.75 - 0.15 * share)
        walker.change_to(aim, 0.3)
        walker.step(1 / 100)
        down = int(np.count_nonzero(~walker.in_swing))
        assert down >= min(slow.minimum_feet_down, fast.minimum_feet_down)
        # A follower with a time constant of .3 cycles lags by as much as its aim moves in it.
        assert np.abs(walker.goal_extent - aim.swing_extent).max() < 0.3 * 0.075 * 2 * math.pi / 3
