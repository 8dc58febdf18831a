"""Whole walks on flat ground: the body moves as its gait's particles say, and not by its reach."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from polypod.config import Settings
from polypod.morphology.load import load_rig
from polypod.recording import record_walk
from polypod.report.figures import measure
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
