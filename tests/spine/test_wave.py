"""The wave of a sprawler's trunk stands in a walk and travels in a run (Ritter 1992)."""

from __future__ import annotations

import math

import numpy as np
import pytest

from polypod.config import Settings
from polypod.morphology.load import load_rig
from polypod.recording import record_walk
from polypod.report.backbone import backbone_figures, joint_angles, travelling
from polypod.report.record import Recording
from polypod.spine.wave import STANDS, TRAVELS, quadrature
from polypod.spine.wave import travelling as share
from polypod.world import World

FPS = 120.0


def walked(speed: float, **settings: float) -> Recording:
    world = World(threads=1)
    world.add(load_rig("lizard"), speed=speed, settings=Settings(**settings))
    return record_walk(world, 4.0, FPS)[0]


@pytest.mark.parametrize("strides", [1, 3])
def test_a_standing_wave_does_not_travel_and_a_travelling_one_does(strides: int) -> None:
    turn = 2.0 * math.pi * strides * np.arange(300)[:, None] / 300
    place = math.pi * np.arange(8) / 8
    standing = np.cos(place) * np.cos(turn) + 0.2
    running = np.cos(turn + place)
    assert travelling(standing, strides) < 1e-9
    assert travelling(running, strides) == pytest.approx(1.0)
    assert 0.2 < travelling(0.5 * (standing + running), strides) < 0.8
    assert travelling(np.zeros((300, 8)), strides) == 0.0


@pytest.mark.parametrize("extent", [0.2, 0.5, 0.7])
def test_feet_move_fastest_in_the_middle_of_swing_and_stance(extent: float) -> None:
    start = 0.9
    assert quadrature((start + 0.5 * extent) % 1.0, start, extent) == pytest.approx(1.0)
    assert quadrature((start + 0.5 + 0.5 * extent) % 1.0, start, extent) == pytest.approx(-1.0)
    assert quadrature(start, start, extent) == pytest.approx(0.0)
    assert quadrature((start + extent) % 1.0, start, extent) == pytest.approx(0.0, abs=1e-12)


def test_the_wave_begins_to_travel_where_walks_end() -> None:
    assert share(0.7) == share(STANDS) == 0.0
    assert share(0.5 * (STANDS + TRAVELS)) == pytest.approx(0.5)
    assert share(TRAVELS) == pytest.approx(1.0)
    assert share(0.2) == 1.0


def test_a_lizards_wave_stands_in_a_walk_and_travels_in_a_run() -> None:
    walk, run = walked(0.35), walked(2.4)
    standing = backbone_figures(walk)["spine_travelling"]
    runs = backbone_figures(run)["spine_travelling"]
    assert isinstance(standing, float)
    assert isinstance(runs, float)
    assert standing < 0.2
    assert runs > 0.35
    # It runs from head to tail: the joint at the chest bends before the one at the pelvis does.
    neck = run.morphology.segments.neck
    bends = joint_angles(run)[240:, : neck - 1, 0]
    lags = np.arange(-12, 13)
    alike = [
        np.corrcoef(bends[12:-12, 0], np.roll(bends[:, -1], lag)[12:-12])[0, 1] for lag in lags
    ]
    assert 0 < lags[int(np.argmax(alike))] < 12
    # And its pelvis yaws as far as ever (BIOMECHANICS 4).
    assert backbone_figures(run)["pelvis_yaw_deg"] == pytest.approx(36.0, rel=0.3)


def test_a_wave_scaled_to_nothing_is_none() -> None:
    figures = backbone_figures(walked(2.4, spine_yaw=0.0))
    assert figures["spine_travelling"] is None
