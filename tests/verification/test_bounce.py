"""The trunk's motion over its feet: against measured animals, and what the user asks of it."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np
import pytest

from polypod.body.motion import LARGEST_NOD, LARGEST_ROLL, LARGEST_SWAY, move_trunk
from polypod.body.particles import HARMONICS
from polypod.config import Settings
from polypod.errors import SettingError
from polypod.gait.library import make_gait
from polypod.herd import Herd
from polypod.morphology.load import load_rig
from polypod.reference import by_reference

STEPS = 100  # a cycle
rig_of = functools.cache(load_rig)


@dataclass
class Stride:
    """Two cycles of a trunk's steady motion; arrays [2 STEPS]."""

    heave: np.ndarray  # m
    nod: np.ndarray  # slope forward
    roll: np.ndarray  # slope to the left
    sway: np.ndarray  # m to the left
    needle: np.ndarray
    middle: float  # the needle's phase at foot 0's mid-stance
    girdle: np.ndarray  # [G] m forward of the centre
    herd: Herd

    def at_mid_stance(self, values: np.ndarray) -> float:
        """Return a value at foot 0's mid-stance."""
        away = np.abs((self.needle - self.middle + 0.5) % 1.0 - 0.5)
        return float(values[int(np.argmin(away))])


def stride(
    rig: str, gait: str, speed: float, period: float, duty: float, hips: float,
    settings: Settings | None = None,
) -> Stride:  # fmt: skip
    """Drive the trunk of a creature of a rig's build, `hips` m high, by a steady gait."""
    herd = Herd(rig_of(rig), 1, settings or Settings())
    scale = hips / herd.tables.hip_height
    legs, girdles = herd.tables.legs, herd.tables.girdles
    legs = legs._replace(
        point_rest=legs.point_rest * scale,
        sole_stance=legs.sole_stance * scale,
        length=legs.length * scale,
    )
    girdles = girdles._replace(place=girdles.place * scale)
    length = herd.tables.leg_length * scale
    tables = by_reference(
        herd.tables._replace(
            legs=legs, girdles=girdles, hip_height=hips, leg_length=length,
            pendulum_time=math.sqrt(length / 9.81),
        )
    )  # fmt: skip
    made = make_gait(gait, legs.side, legs.row)
    herd.command.set_gait(made)
    state = herd.state
    stands = (1.0 - made.swing_extent) / made.duty * duty
    for start, extent in (
        (state.swing_start, state.swing_extent),
        (state.goal_start, state.goal_extent),
    ):
        start[0], extent[0] = (made.touchdown + stands) % 1.0, 1.0 - stands
    state.duty[0], state.speed[0], state.cycle_rate[0] = duty, speed, 1.0 / period
    state.turn[0] = 1.0 / STEPS
    state.gait_vault[0] = made.vault
    rows = []
    for _ in range(14 * STEPS):
        state.needle[0] = (state.needle[0] + 1.0 / STEPS) % 1.0
        sway = move_trunk(
            0, period / STEPS, herd.kernel_state, herd.kernel_command, tables, herd.kernel_settings
        )
        rows.append([state.heave[0], *state.nod[0], sway, state.needle[0]])
    heave, nod, roll, swayed, needle = np.array(rows[-2 * STEPS :]).T
    middle = (made.touchdown[0] + 0.5 * stands[0]) % 1.0
    return Stride(heave, nod, roll, swayed, needle, middle, girdles.place, herd)


@pytest.mark.parametrize(
    ("rig", "gait", "speed", "period", "duty", "hips", "measured", "highest"),
    [
        # Speeds, cycles and duty factors as the animals have them; cm (BIOMECHANICS 3).
        ("biped", "walk", 0.7, 1.40, 0.66, 0.90, 2.7, True),
        ("biped", "walk", 1.6, 0.97, 0.60, 0.90, 4.8, True),
        ("biped", "run", 3.0, 0.72, 0.35, 0.90, 7.5, False),
        ("wolf", "trot", 3.7, 0.70, 0.41, 1.40, 5.3, False),  # a horse
        ("wolf", "trot", 2.2, 0.46, 0.45, 0.50, 2.3, False),  # a dog
        ("ant", "tripod", 0.3, 0.10, 0.58, 0.01, 0.04, False),  # a cockroach
    ],
)
def test_bodies_rise_and_fall_as_animals_do(
    rig: str, gait: str, speed: float, period: float, duty: float, hips: float, measured: float,
    highest: bool,
) -> None:  # fmt: skip
    """Peak to peak within half of what was measured, and highest or lowest at mid-stance."""
    seen = stride(rig, gait, speed, period, duty, hips)
    excursion = float(np.ptp(seen.heave))
    assert 100.0 * excursion == pytest.approx(measured, rel=0.5)
    assert abs(seen.heave.mean()) < 1e-3 * hips
    middle = seen.at_mid_stance(seen.heave)
    # A cockroach's three feet are not quite in step.
    assert (middle if highest else -middle) > 0.25 * excursion
    weight = 1.0 + np.diff(seen.heave, n=2) * (STEPS / period) ** 2 / 9.81
    assert weight.min() > -1e-6
    assert weight.mean() == pytest.approx(1.0, abs=0.02)


def test_a_galloping_horse_nods_and_a_spider_hardly_moves() -> None:
    """Its trunk moves by 10 to 15 cm at the girdles, by 6 in the middle; a fast spider's not."""
    horse = stride("wolf", "transverse-gallop", 12.0, 0.42, 0.23, 1.4)
    assert 100.0 * np.ptp(horse.heave) == pytest.approx(6.4, rel=0.3)
    for place in horse.girdle:
        assert 100.0 * np.ptp(horse.heave + horse.nod * place) == pytest.approx(12.5, rel=0.5)
    # In flight the body falls freely: all four feet swing for a part of the cycle.
    weight = 1.0 + np.diff(horse.heave, n=2) * (STEPS / 0.42) ** 2 / 9.81
    assert weight.min() == pytest.approx(0.0, abs=0.05)
    spider = stride("spider", "spider", 0.4, 0.15, 0.65, 0.015)
    assert np.ptp(spider.heave) < 0.03 * 0.015
    assert np.ptp(spider.nod) == np.ptp(spider.roll) == np.ptp(spider.sway) == 0.0


def test_nod_and_roll_and_sway_stay_small() -> None:
    """However slow the cycle, and with legs of one side together."""
    for gait in ("pace", "transverse-gallop", "walk", "pronk", "bound"):
        for period in (0.3, 0.8, 2.0):
            seen = stride("wolf", gait, 1.2, period, 0.4, 0.5)
            # The bound is on the fundamental motion; harmonics add a little.
            assert np.abs(seen.nod).max() < 1.3 * LARGEST_NOD
            assert np.abs(seen.roll).max() < 1.3 * LARGEST_ROLL
            assert np.abs(seen.sway).max() < LARGEST_SWAY * 0.5
            # What a stiff leg of half a metre would lift it by.
            assert np.ptp(seen.heave) < 1.1 * (0.4 * 1.2 * period) ** 2 / (8.0 * 0.5)


def test_a_man_sways_over_the_foot_that_stands_and_less_when_he_is_quick() -> None:
    slow = stride("biped", "walk", 0.7, 1.4, 0.66, 0.9)
    quick = stride("biped", "walk", 1.6, 0.97, 0.60, 0.9)
    assert 0.02 < np.ptp(quick.sway) < np.ptp(slow.sway) < 0.05
    # Foot 0 is the left one.
    assert slow.at_mid_stance(slow.sway) > 0.45 * np.ptp(slow.sway)


def test_who_walks_slowly_does_not_bounce() -> None:
    """From nothing at rest on, with the square of the step, whatever the period."""
    sizes = [np.ptp(stride("wolf", "trot", v, 1.2, 0.48, 0.5).heave) for v in (0.0, 0.05, 0.1, 0.2)]
    assert sizes[0] == pytest.approx(0.0, abs=1e-9)
    assert sizes[2] == pytest.approx(4.0 * sizes[1], rel=0.02)
    assert sizes[3] == pytest.approx(4.0 * sizes[2], rel=0.02)
    rise = (0.48 * 0.2 * 1.2) ** 2 / (8.0 * 0.5)
    assert sizes[3] == pytest.approx(rise, rel=0.1)


def test_what_the_user_asks_for() -> None:
    """Bounce or vault by name and number, the scales, P1's sinusoid, nothing."""
    human = ("biped", "walk", 1.2, 1.08, 0.62, 0.9)
    plain = stride(*human)
    bounce = stride(*human, Settings(vaulting="bounce"))
    assert plain.at_mid_stance(plain.heave) > 0.0 > bounce.at_mid_stance(bounce.heave)
    asked = stride(*human, Settings(vaulting=0.4))
    assert asked.heave == pytest.approx(plain.heave, abs=1e-12)
    forced = stride("biped", "run", 3.0, 0.72, 0.35, 0.9, Settings(vaulting="vault"))
    usual = stride("biped", "run", 3.0, 0.72, 0.35, 0.9)
    assert np.ptp(forced.heave) < np.ptp(usual.heave)
    half = stride(*human, Settings(bounce=0.5, sway=0.5))
    assert np.ptp(half.heave) == pytest.approx(0.5 * np.ptp(plain.heave), rel=1e-3)
    assert np.ptp(half.sway) == pytest.approx(0.5 * np.ptp(plain.sway), rel=1e-3)
    level = stride("wolf", "bound", 3.0, 0.4, 0.3, 0.5, Settings(nod=0.0))
    assert np.ptp(level.nod) == 0.0 < np.ptp(level.heave)
    none = stride(*human, Settings(body_motion="none", sway=0.0))
    assert np.abs(none.heave).max() < 1e-12 > np.ptp(none.sway)
    sine = stride(*human, Settings(body_motion="sinusoid"))
    assert sine.at_mid_stance(sine.heave) < 0.0
    assert np.ptp(sine.heave) == pytest.approx(0.04 * 0.9, rel=0.05)  # P1's, at its bound
    for wrong in ({"body_motion": "bounce"}, {"body_motion": 2}, {"vaulting": "walk"},
                  {"vaulting": 1.1}, {"vaulting": -0.1}, {"vaulting": None},
                  {"bounce": -1.0}, {"sway": math.nan}, {"nod": "much"}):  # fmt: skip
        with pytest.raises(SettingError, match=next(iter(wrong))):
            Settings(**wrong)


def test_heavy_legs_count_for_more() -> None:
    """A wolf that carries itself on its hind legs moves as their particles do."""
    rig = rig_of("wolf")
    heavy = load_rig("wolf", weights=dict.fromkeys(rig.foot_name[:2], 1e6))
    assert rig.legs.weight == pytest.approx(0.25)
    assert heavy.legs.weight == pytest.approx([0.5, 0.5, 0.0, 0.0], abs=1e-6)
    assert heavy.legs.weight.sum() == pytest.approx(1.0)
    herd = Herd(heavy, 1, Settings())
    assert herd.tables.girdles.weight == pytest.approx([1.0, 0.0], abs=1e-6)


def test_the_steady_heave_is_foreseen() -> None:
    """The harmonics kept for what looks ahead add up to the particles' motion."""
    seen = stride("biped", "run", 3.0, 0.72, 0.35, 0.9)
    beat = seen.herd.state.beat[0]
    wave = np.zeros(2 * STEPS)
    for n in range(1, HARMONICS + 1):
        angle = 2.0 * np.pi * n * seen.needle
        wave += beat[n - 1, 0] * np.cos(angle) + beat[n - 1, 1] * np.sin(angle)
    assert wave == pytest.approx(seen.heave, abs=0.02 * np.ptp(seen.heave))
