"""A leg taken out of the gait goes where it is sent while the others walk on, and comes back."""

from __future__ import annotations

import numpy as np
import pytest

from polypod.errors import SettingError
from polypod.herd import Herd
from polypod.math.quat import Quat, rotate
from polypod.math.vec3 import Vec3
from polypod.morphology.load import load_rig
from polypod.recording import record_walk
from polypod.report.figures import measure
from polypod.world import World


def held_out(herd: Herd, foot: int) -> np.ndarray:
    """Return a place ahead of and above where the foot rests, world, m."""
    leg = herd.tables.leg_length
    place = herd.tables.legs.sole_stance[foot] + np.array([0.0, 0.35 * leg, 0.15 * leg])
    turned = rotate(Quat(*herd.state.rotation[0]), Vec3(*place))
    return np.array(turned) + herd.state.position[0]


@pytest.mark.parametrize("rig", ["spider", "ant"])
def test_the_others_walk_on(rig: str) -> None:
    world = World(threads=1)
    herd = world.add(load_rig(rig), position=[0.0, 0.0], speed=0.3)
    state, leg = herd.state, herd.tables.leg_length
    foot = int(np.argmax(herd.tables.legs.sole_stance[:, 2]))
    for _ in range(30):
        world.step(1.0 / 30.0)
    gaps = []
    for frame in range(120):
        place = held_out(herd, foot)
        herd.command.reach(foot, place)
        world.step(1.0 / 30.0)
        if frame > 30:
            gaps.append(np.linalg.norm(state.foot_reached[0, foot] - place))
            assert state.swinging[0, foot]
    assert max(gaps) < 0.1 * leg
    assert state.residual[0].max() < 1e-3 * leg
    assert state.position[0, 2] > 0.85 * 0.3 * 5.0
    others = np.delete(np.arange(len(state.swinging[0])), foot)
    assert (~state.swinging[0, others]).sum() >= 2

    herd.command.put_back(foot)
    recording = record_walk(world, 3.0, 30.0)[0]
    assert recording.foot_stance[30:, foot].any()
    figures = measure(recording, world.environment.table)
    assert figures["stance_slip_of_leg"] < 1e-3
    assert figures["stance_off_surface_of_leg"] < 2e-3
    apart = np.diff(recording.foot_position[:, foot], axis=0)
    assert np.linalg.norm(apart, axis=1).max() < 0.5 * leg, "it comes down, it does not jump"


def test_out_of_reach_is_as_far_as_it_goes() -> None:
    world = World(threads=1)
    herd = world.add(load_rig("spider"), position=[0.0, 0.0])
    herd.command.reach(6, [5.0, 5.0, 5.0])
    for _ in range(90):
        world.step(1.0 / 30.0)
    assert herd.state.residual[0].max() < 1e-3 * herd.tables.leg_length
    assert np.linalg.norm(herd.state.foot_reached[0, 6] - herd.state.position[0]) > 0.8 * float(
        herd.tables.legs.length[6]
    )
    assert np.all(np.abs(herd.state.position[0, [0, 2]]) < 0.05)


def test_wrong_feet_and_places_are_one_sentence() -> None:
    command = World(threads=1).add(load_rig("spider")).command
    with pytest.raises(SettingError, match="foot is 8; it must be from 0 to 7"):
        command.reach(8, [0.0, 0.0, 0.0])
    with pytest.raises(SettingError, match="x, y, z within"):
        command.reach(0, [0.0, 0.0])
    with pytest.raises(SettingError, match="foot is -1"):
        command.put_back(-1)


def test_a_leg_put_back_under_a_standing_body_comes_down() -> None:
    world = World(threads=1)
    herd = world.add(load_rig("spider"), position=[0.0, 0.0])
    for frame in range(150):
        if frame < 45:
            herd.command.reach(6, held_out(herd, 6))
        if frame == 45:
            herd.command.put_back(6)
        world.step(1.0 / 30.0)
    assert not herd.state.swinging[0].any()
    assert abs(herd.state.foot_reached[0, 6, 1]) < 2e-3 * herd.tables.leg_length
