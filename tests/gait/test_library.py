from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from walker import paired

from polypod.errors import GaitError
from polypod.gait.library import default_gait, default_name, make_gait, names, natural_duty
from polypod.gait.pattern import wrapped
from polypod.math.intervals import wrap_phase

# LH, RH, LF, RF as the published table lists them.
QUADRUPED = ([1, -1, 1, -1], [0, 0, 1, 1])
HEXAPOD = ([1, -1, 1, -1, 1, -1], [0, 0, 1, 1, 2, 2])

# Touchdowns and duty ranges of BIOMECHANICS section 1; a pair is a range.
TABLE = {
    "walk": ((0, 0.5, 0.25, 0.75), (0.58, 0.70)),
    "stalk": ((0, 0.5, 0.20, 0.70), (0.70, 0.80)),
    "walking-trot": ((0, 0.5, (0.42, 0.50), (0.92, 1.0)), (0.60, 0.75)),
    "trot": ((0, 0.5, 0.5, 0), (0.30, 0.50)),
    "amble": ((0, 0.5, 0.25, 0.75), (0.40, 0.55)),
    "pace": ((0, 0.5, (0, 0.10), (0.50, 0.60)), (0.35, 0.50)),
    "canter": ((0, 0.28, 0.30, 0.57), (0.38, 0.45)),
    "transverse-gallop": ((0, 0.13, 0.37, 0.52), (0.16, 0.30)),
    "rotary-gallop": ((0, 0.12, 0.60, 0.48), (0.15, 0.25)),
    "half-bound": ((0, (0, 0.05), 0.45, 0.60), (0.25, 0.45)),
    "bound": ((0, 0, 0.5, 0.5), (0.25, 0.45)),
    "pronk": ((0, 0, 0, 0), (0.15, 0.35)),
}


def circular(a: float, b: float) -> float:
    return abs((a - b + 0.5) % 1.0 - 0.5)


@pytest.mark.parametrize("name", TABLE)
def test_quadrupeds_walk_by_the_published_table(name: str) -> None:
    phases, (low, high) = TABLE[name]
    gait = make_gait(name, *QUADRUPED)
    assert (gait.duty_low, gait.duty_high) == (low, high)
    assert low <= gait.duty <= high
    for touchdown, wanted in zip(gait.touchdown, phases, strict=True):
        if isinstance(wanted, tuple):
            assert wanted[0] - 1e-9 <= touchdown <= wanted[1] + 1e-9
        else:
            assert circular(touchdown, wanted) < 1e-9


@pytest.mark.parametrize(
    ("name", "right", "low", "high"),
    [("walk", 0.5, 0.57, 0.68), ("run", 0.5, 0.25, 0.40), ("hop", 0.0, 0.30, 0.50)],
)
def test_bipeds_walk_run_and_hop(name: str, right: float, low: float, high: float) -> None:
    gait = make_gait(name, [-1, 1], [0, 0])
    assert circular(gait.touchdown[1], 0.0) < 1e-9
    assert circular(gait.touchdown[0], right) < 1e-9
    assert (gait.duty_low, gait.duty_high) == (low, high)
    assert (gait.flight_share > 0.0) == (name != "walk")


@pytest.mark.parametrize(
    ("name", "lag", "duty", "down"),
    [("tripod", 1 / 2, 1 / 2, 3), ("tetrapod", 1 / 3, 2 / 3, 4), ("wave", 1 / 6, 5 / 6, 5)],
)
def test_insects_step_by_the_ideal_lag(name: str, lag: float, duty: float, down: int) -> None:
    gait = make_gait(name, *HEXAPOD)
    assert gait.duty == pytest.approx(duty)
    assert gait.touchdown == pytest.approx(
        wrapped([0, 0.5, lag, lag + 0.5, 2 * lag, 2 * lag + 0.5])
    )
    assert gait.minimum_feet_down == gait.maximum_feet_down == down


@pytest.mark.parametrize("name", ["tripod", "tetrapod", "wave"])
@pytest.mark.parametrize("count", [4, 6, 8, 14, 40])
def test_the_insects_lag_is_one_less_the_duty_at_every_duty(name: str, count: int) -> None:
    side, row = paired(count)
    preferred = make_gait(name, side, row)
    for duty in np.linspace(preferred.duty_low, preferred.duty_high, 7):
        gait = make_gait(name, side, row, float(duty))
        assert gait.duty == pytest.approx(duty)
        for k in range(2, count):
            lag = wrap_phase(gait.touchdown[k] - gait.touchdown[k - 2])
            assert circular(lag, 1.0 - duty) < 1e-9


def test_the_insects_continuum_has_no_seams() -> None:
    for slow, fast in (("wave", "tetrapod"), ("tetrapod", "tripod")):
        edge = make_gait(slow, *HEXAPOD).duty_low
        assert edge == make_gait(fast, *HEXAPOD).duty_high
        one, other = (make_gait(name, *HEXAPOD, edge) for name in (slow, fast))
        assert wrapped(one.swing_start - other.swing_start + 0.5) == pytest.approx(np.full(6, 0.5))
        assert one.swing_extent == pytest.approx(other.swing_extent)


@pytest.mark.parametrize(
    ("name", "lag_low", "lag_high", "right"),
    [
        ("spider", 0.40, 0.45, 0.5),
        ("scorpion", 0.60, 0.60, 0.5),
        ("crab", 0.5, 0.5, 0.5),
        # Waves from front to back: the leg behind is the next.
        ("centipede", 0.90, 0.90, 0.5),
        ("millipede", 0.04, 0.08, 0.0),
    ],
)
def test_other_arthropods_keep_their_lag(
    name: str, lag_low: float, lag_high: float, right: float
) -> None:
    side, row = paired(40)
    for duty in (0.0, 0.6, 1.0):
        gait = make_gait(name, side, row, duty)
        for k in range(2, 40):
            lag = wrap_phase(gait.touchdown[k] - gait.touchdown[k - 2])
            assert lag_low - 1e-9 <= lag <= lag_high + 1e-9
        for k in range(0, 40, 2):
            assert circular(gait.touchdown[k + 1] - gait.touchdown[k], right) < 1e-9


def test_a_crab_stands_longer_on_its_leading_side() -> None:
    gait = make_gait("crab", *paired(8))
    duty = 1.0 - gait.swing_extent
    assert (duty[0::2] > duty[1::2]).all()
    assert gait.duty == pytest.approx(0.65)


@pytest.mark.parametrize("name", names())
def test_every_name_is_a_sound_gait_for_every_number_of_legs(name: str) -> None:
    for count, duty in itertools.product(range(2, 41), (None, 0.0, 1.0)):
        gait = make_gait(name, *paired(count), duty)
        assert gait.foot_count == count
        assert gait.name == name
        low = gait.duty_low if duty == 0.0 else gait.duty_high if duty == 1.0 else gait.duty
        assert gait.duty == pytest.approx(low)
        if gait.family == "walk" or (gait.family == "arthropod" and name != "millipede"):
            # What walks never flies, and half of what stands can be counted on.
            assert gait.minimum_feet_down >= max(1, math.floor(0.45 * count))


@given(
    st.lists(st.tuples(st.sampled_from([-1, 0, 1]), st.integers(0, 60)), min_size=2, max_size=40),
    st.sampled_from(names()),
    st.floats(0.01, 0.99),
)
@settings(max_examples=300)
def test_uneven_sides_gaps_and_doubled_rows_make_a_gait_too(
    legs: list[tuple[int, int]], name: str, duty: float
) -> None:
    side, row = zip(*legs, strict=True)
    gait = make_gait(name, side, row, duty)
    assert gait.foot_count == len(legs)
    assert gait.duty_low - 1e-9 <= gait.duty <= gait.duty_high + 1e-9


@given(st.sampled_from(names()), st.integers(1, 20), st.data())
def test_order_of_legs_does_not_matter(name: str, pairs: int, data: st.DataObject) -> None:
    side, row = (np.array(each) for each in paired(2 * pairs))
    order = np.array(data.draw(st.permutations(range(2 * pairs))))
    straight, mixed = make_gait(name, side, row), make_gait(name, side[order], row[order])
    assert mixed.swing_start == pytest.approx(straight.swing_start[order])
    assert mixed.swing_extent == pytest.approx(straight.swing_extent[order])


@pytest.mark.parametrize("count", [2, 4, 6, 8, 20])
@pytest.mark.parametrize("name", names())
def test_in_a_mirror_sides_change_places(name: str, count: int) -> None:
    side, row = paired(count)
    gait, mirrored = make_gait(name, side, row), make_gait(name, [-s for s in side], row)
    partner = np.arange(count) ^ 1
    assert mirrored.swing_start == pytest.approx(gait.swing_start[partner])
    asymmetrical = ("canter", "transverse-gallop", "rotary-gallop", "half-bound", "crab")
    if name not in asymmetrical:
        # A symmetrical gait is its own mirror image, half a cycle later or at once.
        shift = wrapped(mirrored.swing_start - gait.swing_start)
        expected = 0.0 if name in ("bound", "pronk", "hop", "millipede") else 0.5
        assert shift == pytest.approx(np.full(count, expected), abs=1e-9)


def test_five_legs_step_round_the_ring_and_never_two_neighbours_in_turn() -> None:
    # In ring order: left hind, left fore, front, right fore, right hind.
    side, row = [1, 1, 0, -1, -1], [0, 1, 2, 1, 0]
    for name in ("tripod", "tetrapod", "wave"):
        gait = make_gait(name, side, row)
        assert sorted(gait.touchdown) == pytest.approx([0.0, 0.2, 0.4, 0.6, 0.8])
        order = np.argsort(gait.touchdown)
        apart = np.diff(np.append(order, order[0])) % 5
        assert set(apart.tolist()) <= {2, 3}
    assert make_gait("tetrapod", side, row, 0.6).minimum_feet_down == 3
    assert make_gait("wave", side, row, 0.8).minimum_feet_down == 4


def test_a_ring_with_its_odd_leg_behind_is_a_ring_too() -> None:
    front = make_gait("wave", [1, 1, 0, -1, -1], [0, 1, 2, 1, 0])
    # Left hind, left fore, right fore, right hind, behind.
    behind = make_gait("wave", [1, 1, -1, -1, 0], [1, 2, 2, 1, 0])
    assert behind.touchdown == pytest.approx(front.touchdown)


def test_legs_in_one_line_take_turns() -> None:
    gait = make_gait("walk", [0, 0, 0, 0], [0, 1, 2, 3])
    assert gait.minimum_feet_down == 2
    assert circular(gait.touchdown[1], 0.5) < 1e-9


def test_a_short_millipede_sends_one_whole_wave_along_its_body() -> None:
    gait = make_gait("millipede", *paired(8))
    assert gait.touchdown[0::2] == pytest.approx([0.0, 0.25, 0.5, 0.75])
    assert gait.minimum_feet_down >= 4


@pytest.mark.parametrize(
    ("side", "row", "words"),
    [
        ([1, -1], [0, 0, 0], "one whole number for side and one for row"),
        ([1], [0], "at least 2 feet, not 1"),
        ([], [], "one whole number for side"),
        ([1, 2], [0, 0], "side is 1"),
        ([1, -1], [0, -1], "row 0 or more"),
        ([1.0, -1.0], [0, 0], "one whole number for side"),
        ([[1, -1]], [[0, 0]], "one whole number for side"),
    ],
)
def test_what_are_no_legs_is_refused(side: list[int], row: list[int], words: str) -> None:
    with pytest.raises(GaitError, match=words):
        make_gait("walk", side, row)


def test_an_unknown_name_is_refused_with_the_names_there_are() -> None:
    with pytest.raises(GaitError, match=r"no gait 'gallop'; choose from walk, .*, millipede"):
        make_gait("gallop", *QUADRUPED)
    with pytest.raises(GaitError, match="cannot have a duty of nan"):
        make_gait("walk", *QUADRUPED, math.nan)


@pytest.mark.parametrize(
    ("count", "upright", "froude", "name"),
    [
        (2, True, 0.2, "walk"),
        (2, True, 0.6, "run"),
        (3, True, 0.0, "insect"),
        (4, True, 0.2, "walk"),
        (4, True, 0.5, "trot"),
        (4, True, 2.5, "canter"),
        (4, True, 9.0, "transverse-gallop"),
        (4, False, 0.1, "lizard"),
        (4, False, 5.0, "lizard"),
        (5, False, 0.01, "insect"),
        (6, False, 0.01, "insect"),
        (6, False, 2.0, "insect"),
        (8, False, 0.3, "spider"),
        (10, False, 0.3, "spider"),
        (14, False, 0.3, "centipede"),
        (40, False, 0.3, "centipede"),
    ],
)
def test_the_gait_a_creature_takes_by_itself(
    count: int, upright: bool, froude: float, name: str
) -> None:
    side, row = paired(count)
    assert default_name(side, row, upright, froude) == name
    assert default_name(side, row, [upright] * count, froude) == name
    assert default_gait(side, row, upright, froude).name == name


def test_by_default_duty_falls_as_speed_rises() -> None:
    # A canter's duty begins above a fast trot's: upright quadrupeds are looked at up to there.
    for count, upright, fastest in (
        (2, True, 30.0), (4, True, 1.9), (4, False, 30.0), (5, False, 30.0), (6, False, 30.0),
        (8, False, 30.0),
    ):  # fmt: skip
        speeds = np.geomspace(1e-3, fastest)
        duties = [default_gait(*paired(count), upright, froude).duty for froude in speeds]
        assert (np.diff(duties) <= 1e-9).all()
        assert duties[0] > duties[-1]


def test_a_gait_is_left_a_tenth_late() -> None:
    # Walk to trot at .35: in between it stays what it was.
    for current, froude, name in (
        ("walk", 0.37, "walk"),
        ("walk", 0.39, "trot"),
        ("trot", 0.33, "trot"),
        ("trot", 0.31, "walk"),
        ("", 0.34, "walk"),
        ("", 0.36, "trot"),
        ("pronk", 0.36, "trot"),
    ):
        assert default_name(*QUADRUPED, True, froude, current) == name


@pytest.mark.parametrize("froude", [-1.0, math.nan])
def test_a_froude_number_that_is_none_is_refused(froude: float) -> None:
    with pytest.raises(GaitError, match="Froude number"):
        default_name(*QUADRUPED, True, froude)


def test_natural_duty_is_the_published_one() -> None:
    # BIOMECHANICS section 2, hip 1 m high; sprawlers .75 slow to .50 fast.
    for froude, duty in ((0.1, 0.69), (0.2, 0.59), (0.5, 0.47), (1, 0.40), (3, 0.31), (12, 0.23)):
        assert natural_duty(froude, True) == pytest.approx(duty, abs=0.01)
    assert natural_duty(0.09, False) == pytest.approx(0.75, abs=0.01)
    assert natural_duty(2.0, False) == pytest.approx(0.50, abs=0.01)
