"""Girdles on banks that fall to opposite sides: the spine shares the twist between them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from spines import go

from polypod.body.support import LEVEL_WIDTH, feet_plane
from polypod.config import Settings
from polypod.environment.environment import Environment
from polypod.environment.terrain import Terrain
from polypod.herd import Herd
from polypod.morphology.load import load_rig
from polypod.morphology.types import Morphology
from polypod.report.backbone import angles_of_turn, backbone_figures
from polypod.report.figures import measure
from polypod.report.record import Recording
from polypod.spine.elevation import roll_girdles

ENDLESS = 1e6  # s: filters arrive


@pytest.fixture(scope="module", params=["wolf", "lizard", "centaur"])
def herd(request: pytest.FixtureRequest) -> Herd:
    return Herd(load_rig(request.param), 1, Settings())


def rolls(herd: Herd, slope: np.ndarray) -> np.ndarray:
    """Return [G] the girdles' rolls where each one's feet stand on a bank of its own slope."""
    state, legs, girdles = herd.state, herd.tables.legs, herd.tables.girdles
    state.spine_share[0, :, 0] = 1.0
    state.foot[0] = legs.sole_stance
    state.foot[0, :, 1] = slope[girdles.of_leg] * legs.sole_stance[:, 0]
    walker = (herd.kernel_state, herd.kernel_tables)
    plane = feet_plane(0, *walker)
    roll_girdles(0, ENDLESS, 1.0, plane, *walker, herd.kernel_settings, herd.scratch(0))
    return state.girdle_bend[0, :, 4, 0].copy()


def expected(herd: Herd, slope: np.ndarray) -> np.ndarray:
    """Return what they are in closed form, of banks that twist less than the spine's joints do."""
    legs, girdles = herd.tables.legs, herd.tables.girdles
    square = legs.sole_stance[:, 0] ** 2
    own = np.array([square[girdles.of_leg == g].mean() for g in range(len(slope))])
    lean = (LEVEL_WIDTH * herd.tables.leg_length) ** 2
    common = float((own * slope).mean() / (own.mean() + lean))
    share = herd.settings.tilt_share * herd.tables.tilt_scale
    roll = share * np.arctan(own * (slope - common) / (own + lean))
    return np.asarray(roll - roll.mean())


def test_opposite_banks_twist_a_spine_by_the_slopes_under_its_girdles(herd: Herd) -> None:
    slope = np.linspace(-0.1, 0.1, len(herd.tables.girdles.place))
    found = rolls(herd, slope)
    assert found == pytest.approx(expected(herd, slope), abs=1e-12)
    assert found[-1] - found[0] > math.radians(2.0)
    assert rolls(herd, -slope) == pytest.approx(-found, abs=1e-15), "mirrored"


def test_banks_in_common_are_left_to_the_body(herd: Herd) -> None:
    # What is left is that girdles of unequal width lean to level ground by unequal shares.
    found = rolls(herd, np.full(len(herd.tables.girdles.place), 0.3))
    assert np.abs(found).max() < math.radians(1.5)
    assert not rolls(herd, np.zeros(len(found))).any(), "nothing at all on flat ground"


@settings(deadline=None, max_examples=60)
@given(seed=st.integers(0, 10_000), steep=st.floats(0.0, 3.0))
def test_no_banks_twist_a_spine_beyond_its_joints(herd: Herd, seed: int, steep: float) -> None:
    count = len(herd.tables.girdles.place)
    slope = np.random.default_rng(seed).uniform(-steep, steep, count)
    found = rolls(herd, slope)
    spine = herd.tables.spine
    for g in range(count - 1):
        joints = slice(spine.of_girdle[g] + 1, spine.of_girdle[g + 1] + 1)
        assert abs(found[g + 1] - found[g]) <= spine.limit[joints, 2].sum()
    assert abs(found.mean()) < 1e-12


def saddle(morphology: Morphology, steepness: float) -> Environment:
    """Return y = steepness x z / leg length: banks that fall to the other side behind x, z 0."""
    leg = float(morphology.legs.length.mean())
    along = leg * 0.25 * np.arange(-24, 25)
    heights = steepness / leg * np.outer(along, along)
    return Environment(Terrain(heights, 0.25 * leg, (along[0], along[0])))


def waves(morphology: Morphology) -> Environment:
    """Return banks that fall to either side in turns, about as far apart as girdles are."""
    leg, place = float(morphology.legs.length.mean()), morphology.segments.girdle_rest[:, 2]
    cell = 0.15 * leg
    x, z = cell * np.arange(-60, 61), cell * np.arange(-30, 200)
    slope = 0.35 * np.sin(math.pi * z / np.ptp(place)) * np.clip(z / leg, 0.0, 1.0)
    return Environment(Terrain(np.outer(slope, x), cell, (x[0], z[0])))


def twist(recording: Recording) -> np.ndarray:
    """Return [F] rad: the roll of the foremost girdle's segment less that of the hindmost."""
    spine = recording.morphology.segments
    rows = [int(spine.joint[s]) for s in (spine.of_girdle[0], spine.of_girdle[-1])]
    hind, fore = (angles_of_turn(recording.joint_rotation[:, row])[:, 2] for row in rows)
    return np.asarray(fore - hind)


@pytest.mark.parametrize("name", ["wolf", "lizard"])
def test_who_stands_on_a_saddle_twists_and_a_rigid_one_does_not(name: str) -> None:
    morphology = load_rig(name)
    bent, _ = go(morphology, 3.0, speed=0.0, place=saddle(morphology, 0.4))
    other, _ = go(morphology, 3.0, speed=0.0, place=saddle(morphology, -0.4))
    rigid = Settings(spine=0.0)
    stiff, _ = go(morphology, 3.0, speed=0.0, place=saddle(morphology, 0.4), settings=rigid)
    assert math.radians(3.0) < twist(bent)[-1] < math.radians(15.0)
    assert twist(other)[-1] == pytest.approx(-twist(bent)[-1], rel=0.1)
    assert np.abs(twist(stiff)).max() < 1e-9


@pytest.mark.parametrize("name", ["wolf", "lizard", "centaur"])
def test_walking_over_banks_in_turns_keeps_what_holds_everywhere(name: str) -> None:
    morphology = load_rig(name)
    recording, world = go(morphology, 5.0, place=waves(morphology))
    figures = measure(recording, world.environment.table, joint_limits=True)
    assert figures["bone_variation"] < 1e-6
    assert figures["spine_limit_excess_deg"] < 1e-6
    assert figures["joint_limit_excess_deg"] < 1e-3
    assert figures["stance_slip_of_leg"] < 1e-3
    assert figures["stance_residual_of_leg"] < 1e-3
    # It twists to both sides, and no joint by more than a degree or so between two frames.
    assert twist(recording).min() < -math.radians(2.0)
    assert twist(recording).max() > math.radians(2.0)
    assert backbone_figures(recording)["spine_twist_step_deg"] < 2.0
