"""The first stand: on slopes as steep as feet hold on, whichever way a creature faces."""

from __future__ import annotations

import math

import numpy as np
import pytest

from polypod.environment.environment import Environment
from polypod.environment.terrain import Terrain
from polypod.morphology.load import load_rig
from polypod.report.arrays import rotate_all
from polypod.world import World


@pytest.mark.parametrize("heading", [0.0, 0.5 * math.pi, math.pi])
@pytest.mark.parametrize("name", ["spider", "wolf", "lizard", "centaur", "centipede", "biped"])
def test_every_build_stands_on_a_slope(name: str, heading: float) -> None:
    """Long bodies cannot from level: their ends are too high over the ground there."""
    morphology = load_rig(name)
    leg = float(morphology.legs.length.mean())
    angle = math.radians(25.0)
    slope = Terrain.slope(angle, length=60.0 * leg, start=-30.0 * leg)
    world = World(Environment(slope), threads=1)
    herd = world.add(morphology, position=[0.0, 0.0], heading=heading)
    state = herd.state
    assert state.residual[0].max() < 1e-6 * leg
    ground = [slope.height_at(x, z) for x, _, z in state.foot[0]]
    assert state.foot[0, :, 1] == pytest.approx(ground, abs=1e-6 * leg)
    # Long bodies lie along it, most of the way; all stand where they were put.
    assert np.hypot(state.position[0, 0], state.position[0, 2]) < 0.5 * leg
    if len(herd.tables.girdles.place) > 2:
        ahead = rotate_all(state.rotation[:1], np.array([0.0, 0.0, 1.0]))[0]
        assert math.asin(ahead[1]) == pytest.approx(angle * math.cos(heading), abs=0.4 * angle)
