"""Whole walks on flat ground: the body moves as its gait's particles say, and not by its reach."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from polypod.config import Settings
from polypod.gait.library import make_gait
from polypod.gait.validation import check_gait
from polypod.morphology.load import load_rig
from polypod.recording import record_walk
from polypod.report.arrays import runs_of
from polypod.report.figures import measure
from polypod.report.record import Recording
from polypod.world import World

RATE = 60
SECONDS = 3


def walk(
    rig: str, gait: str, speed: float, settings: Settings
) -> tuple[dict[str, Any], np.ndarray]:
    """Return the figures of a walk once it is steady, and its wished heave [F], m."""
    world = World(threads=1)
    herd = world.add(load_rig(rig), speed=speed, gait=gait, position=[0.0, 0.0], settings=settings)
    for _ in range(SECONDS * RATE):
        world.step(1.0 / RATE)
    heave = []
    recording = record_walk(
        world, SECONDS, RATE, lambda done, total: heave.append(herd.state.heave[0])
    )[0]
    return measure(recording, world.environment.table), np.array(heave)


@pytest.mark.parametrize(
    ("rig", "gait", "speed", "highest"),
    [("biped", "walk", 1.3, True), ("biped", "run", 2.5, False), ("wolf", "trot", 2.0, False)],
)
def test_the_body_rises_and_falls_as_wished(
    rig: str, gait: str, speed: float, highest: bool
) -> None:
    """Highest or lowest at mid-stance as in life, by what its particles say, and its feet pull not.

    Legs at their end neither flatten the motion nor add one of their own.
    """
    figures, heave = walk(rig, gait, speed, Settings())
    wished = float(np.ptp(heave))
    assert figures["body_excursion_m"] == pytest.approx(wished, rel=0.2)
    at_mid_stance = figures["body_mid_stance"]
    assert (at_mid_stance if highest else -at_mid_stance) > 0.5
    assert figures["body_force_least_g"] > -0.05
    assert figures["body_force_mean_g"] == pytest.approx(1.0, abs=0.02)
    assert figures["body_tremor_share"] < 0.02
    assert figures["stance_slip_of_leg"] < 1e-9


def test_without_a_motion_the_body_stays_level() -> None:
    figures, heave = walk("biped", "walk", 1.3, Settings(body_motion="none", sway=0.0))
    assert np.ptp(heave) == 0.0
    assert figures["body_excursion_m"] < 0.002


def test_a_spider_hardly_bounces() -> None:
    figures, _ = walk("spider", "spider", 0.55, Settings())
    assert figures["body_excursion_m"] < 0.02 * 0.25


def test_it_starts_and_stops_without_a_jolt() -> None:
    """From standing to a run and back: the body's height bends, and ends where it began."""
    world = World(threads=1)
    herd = world.add(load_rig("biped"), speed=2.2, gait="run", position=[0.0, 0.0])
    before = float(herd.state.position[0, 1])
    heights, heaves = [], []
    for frame in range(7 * RATE):
        if frame == 3 * RATE:
            herd.command.speed = 0.0
        world.step(1.0 / RATE)
        heights.append(herd.state.position[0, 1])
        heaves.append(herd.state.heave[0])
    force = 1.0 + np.diff(heaves, n=2) * RATE**2 / 9.81
    assert force.min() > -0.05
    assert force.max() < 4.0
    assert np.abs(herd.state.particle_offset[0]).max() < 1e-6
    assert abs(herd.state.sway[0]) < 1e-4
    assert heights[-1] == pytest.approx(before, abs=0.01)


def flights(recording: Recording) -> list[tuple[int, int]]:
    """Return the whole flights of a walk: frames from and to, no foot down."""
    runs = runs_of(~recording.foot_stance.any(axis=1))
    return [(a, b) for a, b in runs if a > 0 and b < len(recording.time)]


@pytest.mark.parametrize(
    ("gait", "gathered_and_stretched"),
    [("transverse-gallop", (True, False)), ("rotary-gallop", (True, True))],
)
def test_a_gallop_flies_where_animals_do(
    gait: str, gathered_and_stretched: tuple[bool, bool]
) -> None:
    """With its feet gathered under it, and a rotary one stretched out as well (Hildebrand 1977).

    It falls freely there, no leg comes to its end, and none meets another.
    """
    wolf = load_rig("wolf")
    world = World(threads=1)
    herd = world.add(wolf, speed=5.0, gait=gait, position=[0.0, 0.0])
    rate = 120.0
    for _ in range(round(4.0 * rate)):
        world.step(1.0 / rate)
    recording = record_walk(world, 2.0, rate)[0]
    figures = measure(recording, world.environment.table)
    along = recording.foot_position[:, :, 2]
    fore, hind = (along[:, herd.tables.legs.row == row].mean(axis=1) for row in (1, 0))
    rest = wolf.legs.sole_stance[:, 2]
    reach = (fore - hind) - (rest[2] - rest[0])
    flown = flights(recording)
    middle = np.array([reach[(a + b) // 2] for a, b in flown])
    assert ((middle < 0.0).any(), (middle > 0.0).any()) == gathered_and_stretched
    cycles = 2.0 * float(herd.state.cycle_rate[0])
    assert len(flown) == pytest.approx(sum(gathered_and_stretched) * cycles, abs=1.5)
    asked = check_gait(make_gait(gait, wolf.legs.side, wolf.legs.row), wolf, speed=5.0)
    share = np.mean(~recording.foot_stance.any(axis=1))
    assert share == pytest.approx(asked.flight_share, abs=0.06)
    force = 1.0 + np.diff(recording.body_position[:, 1], n=2) * rate * rate / 9.81
    for start, stop in flown:
        assert np.abs(force[start + 1 : stop - 3]).max(initial=0.0) < 0.1
    assert figures["body_force_least_g"] > -0.1
    assert figures["legs_touching_share"] == 0.0
    assert figures["stance_slip_of_leg"] < 1e-9
