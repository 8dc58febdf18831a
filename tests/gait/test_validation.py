from __future__ import annotations

import math
from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from walker import paired

from polypod import check_gait as exported
from polypod import load_rig
from polypod.controller.stride import StrideTable
from polypod.errors import GaitError, SettingError
from polypod.gait.balance import arcs_of, hull, margins_along, margins_of
from polypod.gait.build import Build
from polypod.gait.library import make_gait, names
from polypod.gait.limits import LIMITS, Demand, feet_needed, longest_stretch
from polypod.gait.pattern import Gait, wrapped
from polypod.gait.tempo import natural_tempo
from polypod.gait.validation import HARD, IMPLAUSIBLE, PLAUSIBLE, VERDICTS, GaitCheck, check_gait

# Who walks a gait in life, among the built-in creatures.
OWN = {
    "walk": ("wolf", "biped"),
    "stalk": ("wolf",),
    "walking-trot": ("lizard",),
    "trot": ("wolf",),
    "amble": ("wolf",),
    "pace": ("wolf",),
    "canter": ("wolf",),
    "transverse-gallop": ("wolf",),
    "rotary-gallop": ("wolf",),
    "half-bound": ("wolf",),
    "bound": ("wolf",),
    "pronk": ("wolf",),
    "run": ("biped",),
    "hop": ("biped",),
    "tripod": ("ant", "pentapod", "centaur"),
    "tetrapod": ("ant", "pentapod", "spider", "centaur"),
    "wave": ("ant", "pentapod", "spider"),
    "spider": ("spider", "crab"),
    "scorpion": ("spider",),
    "crab": ("crab",),
    "centipede": ("centipede",),
    "millipede": ("centipede",),
    "insect": ("ant", "pentapod"),
    "lizard": ("lizard",),
}


@cache
def build(rig: str) -> Build:
    return Build.of(load_rig(rig))


def of(name: str, creature: Build) -> Gait:
    return make_gait(name, creature.legs.side, creature.legs.row)


def natural_speed(creature: Build, duty: float) -> float:
    """Return the speed at which an animal of this build has a duty."""
    slow, fast = (share * math.sqrt(9.81 * creature.leg_length) for share in (1e-3, 20.0))
    for _ in range(60):
        middle = math.sqrt(slow * fast)
        tempo = natural_tempo(middle, creature.hip_height, creature.leg_length, creature.upright)
        slow, fast = (middle, fast) if tempo.duty > duty else (slow, middle)
    return slow


def sized(creature: Build, size: float) -> Build:
    """Return the same creature so many times as large."""
    legs, stride = creature.legs, creature.stride
    return replace(
        creature,
        hip_height=size * creature.hip_height,
        leg_length=size * creature.leg_length,
        legs=legs._replace(length=size * legs.length, sole_stance=size * legs.sole_stance),
        stride=StrideTable(*(size * np.asarray(field) for field in stride[:4]), size * stride.sink),
    )


def numbers(check: GaitCheck) -> list[float]:
    found: list[float] = []
    for field in fields(check):
        value = getattr(check, field.name)
        if isinstance(value, int | float):
            found.append(float(value))
        elif field.name in ("foot_peak", "foot_share"):
            found.extend(value)
    return found


def test_every_gait_has_somebody_who_walks_it() -> None:
    assert set(OWN) == set(names())


@pytest.mark.parametrize("name", names())
def test_no_gait_of_the_library_is_implausible_on_its_own_kind(name: str) -> None:
    for rig in OWN[name]:
        creature = build(rig)
        gait = of(name, creature)
        preferred = check_gait(gait, creature, speed=natural_speed(creature, gait.duty))
        assert preferred.verdict != IMPLAUSIBLE, preferred.sentence
        assert check_gait(gait, creature).verdict != IMPLAUSIBLE


@pytest.mark.parametrize(
    ("name", "rig"),
    [
        *(("walk", "wolf"), ("trot", "wolf"), ("transverse-gallop", "wolf"), ("tripod", "ant")),
        *(("tetrapod", "ant"), ("walk", "biped"), ("run", "biped"), ("spider", "spider")),
        *(("walking-trot", "lizard"), ("centipede", "centipede"), ("wave", "ant")),
    ],
)
def test_plain_gaits_at_their_own_speed_are_plausible(name: str, rig: str) -> None:
    creature = build(rig)
    gait = of(name, creature)
    check = check_gait(gait, creature, speed=natural_speed(creature, gait.duty))
    assert (check.verdict, check.reasons, check.change) == (PLAUSIBLE, (), None)


@pytest.mark.parametrize("rig", ["wolf", "spider", "biped"])
@pytest.mark.parametrize("size", [0.006, 8.0])
def test_a_fly_and_a_dinosaur_are_judged_alike(rig: str, size: float) -> None:
    creature = build(rig)
    for name in ("walk", "trot", "transverse-gallop", "pronk", "tripod", "spider"):
        # The law of contact times has a size of its own: the same duty at the same Froude number.
        gait = replace(of(name, creature), duty_low=math.nan, duty_high=math.nan)
        one = check_gait(gait, creature)
        other = check_gait(gait, sized(creature, size))
        assert other.verdict == one.verdict, name
        assert other.froude == pytest.approx(one.froude)
        assert other.speed == pytest.approx(one.speed * math.sqrt(size))
        assert other.period == pytest.approx(one.period * math.sqrt(size))
        assert other.excursion_hips == pytest.approx(one.excursion_hips, rel=1e-6)
        assert other.excursion == pytest.approx(one.excursion * size, rel=1e-6)
        assert other.body_peak == pytest.approx(one.body_peak, rel=1e-6)
        assert other.margin_least == pytest.approx(one.margin_least, abs=1e-9)


def all_at_once(feet: int, duty: float, family: str, period: float = math.nan) -> Gait:
    return Gait("hops", np.full(feet, 0.1), np.full(feet, 1.0 - duty), family=family, period=period)


def test_what_flies_too_long_is_implausible_with_its_peak_force() -> None:
    check = check_gait(all_at_once(4, 0.15, "run"))
    assert check.verdict == IMPLAUSIBLE
    assert check.body_peak == pytest.approx(math.pi / 0.3)
    assert check.foot_peak == pytest.approx([math.pi / 0.3] * 4)
    assert check.foot_share == pytest.approx([math.pi / 1.2] * 4)
    assert check.flight_share == pytest.approx(0.85)
    assert check.flight == pytest.approx(0.85 * check.period)
    assert "10.5 g" in check.reasons[0]
    assert "implausible, with 10.5 g at the peak" in check.sentence
    assert check.change is not None
    assert check.change.text in check.sentence


def test_a_long_flight_is_implausible_even_at_a_fair_force() -> None:
    check = check_gait(all_at_once(4, 0.35, "run", period=2.0), speed=0.3)
    assert check.verdict == IMPLAUSIBLE
    assert check.body_peak < LIMITS["body_peak"].fair
    assert any("flies for 1.3 s" in reason for reason in check.reasons)
    assert check.change is not None
    assert check.change.text == "a period of 0.42 s instead of 2 s"


@pytest.mark.parametrize(
    ("feet", "family", "period", "words"),
    [
        (8, "arthropod", math.nan, "three feet"),
        (4, "walk", math.nan, "two feet"),
        (2, "walk", math.nan, "no foot stands"),
    ],
)
def test_walks_that_leave_the_ground_are_told_so(
    feet: int, family: str, period: float, words: str
) -> None:
    check = check_gait(all_at_once(feet, 0.5, family, period))
    assert check.verdict == IMPLAUSIBLE
    assert any(words in reason for reason in check.reasons), check.reasons
    assert check.short_share == pytest.approx(0.5)
    assert check.unsupported == pytest.approx(0.5 * check.period)


def test_legs_cannot_be_hurried() -> None:
    creature = Build.plain(4, upright=True)
    check = check_gait(replace(of("trot", creature), period=0.05), creature)
    assert check.period == 0.05
    assert check.verdict == IMPLAUSIBLE
    assert any("a cycle takes 0.05 s" in reason for reason in check.reasons)
    assert check.change is not None
    assert check.change.gait.period == pytest.approx(0.17, abs=0.02)


def test_one_foot_out_of_step_is_found() -> None:
    creature = build("ant")
    gait = of("tripod", creature)
    start = gait.swing_start.copy()
    start[1] = (start[1] + 0.3) % 1.0
    check = check_gait(replace(gait, swing_start=start), creature)
    assert check.verdict == IMPLAUSIBLE
    assert check.change is not None
    assert "foot 1 (RightLeg3Foot) stepping 0." in check.change.text
    assert check.change.text.endswith("of a cycle earlier")
    assert np.flatnonzero(check.change.gait.swing_start != start).tolist() == [1]


def test_standing_on_one_side_topples() -> None:
    """Six feet, three always down, and always those of one side."""
    side, _ = paired(6)
    start = np.where(np.array(side) > 0, 0.0, 0.5)
    check = check_gait(Gait("sides", start, np.full(6, 0.45), family="arthropod"))
    assert check.short_share == 0.0
    assert check.margin_mean < -0.3
    assert check.verdict != PLAUSIBLE
    assert "not between them" in check.reasons[0]


gaits = st.builds(
    lambda feet, period, family: Gait(
        "any",
        np.array([start for start, _ in feet]),
        np.array([extent for _, extent in feet]),
        family=family,
        period=period,
    ),
    st.lists(
        st.tuples(st.floats(0.0, 1.0, exclude_max=True), st.floats(0.01, 0.99)),
        min_size=1,
        max_size=8,
    ),
    st.one_of(st.just(math.nan), st.floats(1e-3, 1e3)),
    st.sampled_from(["walk", "run", "arthropod"]),
)


@settings(max_examples=25, deadline=None)
@given(gaits, st.one_of(st.none(), st.floats(0.0, 20.0)), st.booleans())
@example(all_at_once(1, 0.5, "walk"), None, False)
@example(all_at_once(8, 0.01, "arthropod", 1000.0), 0.0, True)
@example(all_at_once(8, 0.99, "run", 0.001), 100.0, False)
def test_any_gait_is_judged_and_its_change_passes(
    gait: Gait, speed: float | None, heavy_first: bool
) -> None:
    weight = np.ones(gait.foot_count)
    weight[0] += 3.0 * heavy_first
    check = check_gait(gait, speed=speed, weight=weight)
    assert np.isfinite(numbers(check)).all()
    assert check.verdict in VERDICTS
    assert check.body_least >= -1e-12
    assert (check.verdict == PLAUSIBLE) == (check.reasons == ())
    assert check.sentence.isprintable()
    if check.change is None:
        return
    assert check.verdict != PLAUSIBLE
    creature = Build.plain(gait.foot_count, gait.family != "arthropod")
    change = check.change
    mended = check_gait(change.gait, creature, speed=change.speed, weight=weight)
    assert mended.verdict == PLAUSIBLE, (change.text, mended.reasons)
    if "period" in change.text:
        assert mended.period == change.gait.period


@settings(max_examples=60, deadline=None)
@given(gaits.filter(lambda gait: gait.foot_count % 2 == 0), st.floats(0.0, 1.0))
def test_turned_and_mirrored_gaits_ask_the_same(gait: Gait, turn: float) -> None:
    creature = Build.plain(gait.foot_count, gait.family != "arthropod")
    swapped = np.arange(gait.foot_count) ^ 1
    start, extent = gait.swing_start, gait.swing_extent
    changed = [
        replace(gait, swing_start=wrapped(start + turn)),
        replace(gait, swing_start=start[swapped], swing_extent=extent[swapped]),
    ]
    weight = np.full(gait.foot_count, 1.0 / gait.foot_count)
    one, *others = (
        Demand.of(each, creature, creature.comfortable_speed, weight) for each in (gait, *changed)
    )
    for other in others:
        for (name, value, _), (_, expected, _) in zip(other.values(), one.values(), strict=True):
            assert value == pytest.approx(expected, rel=1e-6, abs=1e-7), name


def test_a_gait_follows_the_speed_as_in_a_walk() -> None:
    creature = build("wolf")
    gait = of("trot", creature)
    slow, fast = (check_gait(gait, creature, speed=speed) for speed in (1.0, 3.0))
    assert slow.gait.duty == pytest.approx(0.5)
    assert 0.3 < fast.gait.duty < 0.45
    assert fast.period < slow.period
    pinned = check_gait(replace(gait, duty_low=math.nan, duty_high=math.nan), creature, speed=3.0)
    assert pinned.gait.duty == pytest.approx(gait.duty)


def test_an_own_period_is_kept_as_far_as_legs_reach() -> None:
    creature = build("wolf")
    gait = replace(of("trot", creature), period=0.5)
    assert check_gait(gait, creature, speed=1.0).period == 0.5
    assert check_gait(gait, creature, speed=4.0).period < 0.5


def test_the_library_call_is_the_same_for_a_rig_and_its_build() -> None:
    morphology = load_rig("wolf")
    gait = of("pronk", build("wolf"))
    one, other = exported(gait, morphology), check_gait(gait, build("wolf"))
    assert numbers(one) == numbers(other)
    assert one.sentence == other.sentence


def test_heavy_hind_legs_bear_more() -> None:
    gait = of("trot", Build.plain(4, upright=True))
    check = check_gait(gait, weight=[2, 2, 1, 1])
    assert check.foot_share[0] == pytest.approx(2.0 * check.foot_share[2])
    assert check.foot_peak[0] == pytest.approx(check.foot_peak[2])


@pytest.mark.parametrize(
    ("changes", "error", "words"),
    [
        ({"speed": -1.0}, SettingError, "from 0 to 100"),
        ({"speed": math.nan}, SettingError, "from 0 to 100"),
        ({"speed": 101.0}, SettingError, "from 0 to 100"),
        ({"weight": [1, 2]}, SettingError, "4 numbers"),
        ({"creature": "spider"}, GaitError, "is for 4 feet; spider has 8"),
    ],
)
def test_what_cannot_be_judged(changes: dict[str, object], error: type, words: str) -> None:
    gait = make_gait("trot", *paired(4))
    if "creature" in changes:
        changes = {"creature": build("spider")}
    with pytest.raises(error, match=words):
        check_gait(gait, **changes)  # type: ignore[arg-type]


def test_what_gaits_need() -> None:
    assert [feet_needed(make_gait("walk", *paired(count))) for count in (2, 4, 6, 8)] == [
        1,
        2,
        3,
        3,
    ]
    assert feet_needed(make_gait("stalk", *paired(4)).with_duty(0.8)) == 3
    assert feet_needed(make_gait("trot", *paired(6))) == 0
    assert feet_needed(make_gait("tripod", *paired(6))) == 3


def test_the_longest_stretch_goes_round() -> None:
    length = np.array([0.1, 0.2, 0.3, 0.4])
    for within, expected in (
        ([True, False, False, True], 0.5),
        ([False, True, True, False], 0.5),
        ([True, True, False, True], 0.7),
        ([False] * 4, 0.0),
        ([True] * 4, 1.0),
    ):
        assert longest_stretch(length, np.array(within)) == pytest.approx(expected)


places = st.lists(
    st.tuples(st.integers(-20, 20), st.integers(-20, 20)), min_size=1, max_size=7
).map(lambda feet: np.array(feet, np.float64))


@settings(deadline=None)
@given(places, st.floats(-30.0, 30.0))
def test_margins_are_the_least_support_in_any_direction(feet: np.ndarray, along: float) -> None:
    """The signed distance is the least, over directions, of how far the feet reach that way."""
    angle = np.linspace(0.0, 2.0 * math.pi, 20001)
    way = np.stack([np.cos(angle), np.sin(angle)])
    reach = ((feet - [0.0, along]) @ way).max(axis=0)
    found = margins_along(feet, np.array([along]))[0]
    assert found == pytest.approx(reach.min(), abs=2e-2)
    assert found <= reach.min() + 1e-9


@settings(deadline=None)
@given(places)
def test_a_hull_has_all_points_on_its_left(feet: np.ndarray) -> None:
    corners = hull(feet)
    assert {tuple(corner) for corner in corners} <= {tuple(foot) for foot in feet}
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        side = b - a
        left = side[0] * (feet[:, 1] - a[1]) - side[1] * (feet[:, 0] - a[0])
        assert (left >= -1e-9).all() or len(corners) < 3


@pytest.mark.parametrize("name", ["wave", "spider", "trot", "transverse-gallop"])
def test_margins_over_a_cycle_are_those_of_a_fine_sampling(name: str) -> None:
    creature = build("spider")
    gait = of(name, creature)
    plan, stride = creature.legs.sole_stance[:, [0, 2]], 0.3
    arcs = arcs_of(gait)
    margins = margins_of(gait, arcs, plan, stride)
    assert arcs.length.sum() == pytest.approx(1.0)
    sampled = []
    for phase in (np.arange(2000) + 0.5) / 2000:
        since = np.mod(phase - gait.touchdown, 1.0)
        duty = 1.0 - gait.swing_extent
        feet = plan + np.stack([np.zeros(8), stride * (0.5 * duty - since)], axis=1)
        assert np.count_nonzero(since < duty) == gait.feet_down(phase)
        if (since < duty).any():
            sampled.append(margins_along(feet[since < duty], np.zeros(1))[0])
    assert np.nanmin(margins.least) == pytest.approx(min(sampled), abs=5e-4)
    stands = arcs.feet_down > 0
    mean = np.average(margins.mean[stands], weights=arcs.length[stands])
    assert mean == pytest.approx(np.mean(sampled), abs=2e-3)


def test_verdicts_are_in_order() -> None:
    assert VERDICTS == (PLAUSIBLE, HARD, IMPLAUSIBLE)
    for limit in LIMITS.values():
        assert limit.excess(limit.fair) == 0.0
        assert limit.excess(limit.most) == pytest.approx(limit.most_excess)
