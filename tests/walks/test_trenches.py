"""Ground that cannot be walked: stepped over where the reach allows; else the walk ends there."""

from __future__ import annotations

import numpy as np
import pytest
from places import default_speed, front, leg_length

from polypod.activity import Activity
from polypod.environment.environment import Environment
from polypod.environment.terrain import Terrain
from polypod.morphology.load import load_rig
from polypod.morphology.types import Morphology
from polypod.recording import add_frame
from polypod.report.ground import Ground
from polypod.report.record import Recorder, Recording
from polypod.world import World

SECONDS = 8.0
FPS = 30.0


def walk(morphology: Morphology, terrain: Terrain, seconds: float = SECONDS) -> Recording:
    """Return a walk along +z, in which nothing went into anything."""
    environment = Environment(terrain)
    world = World(environment, threads=1)
    herd = world.add(morphology, speed=default_speed(morphology), position=[0.0, 0.0])
    recorder = Recorder(morphology, len(environment.obstacles))
    for _ in range(round(seconds * FPS)):
        world.step(1.0 / FPS)
        add_frame(recorder, world, herd, 0)
    recording = recorder.finish()
    unit = leg_length(morphology)
    sole = recording.foot_position
    frame = np.repeat(np.arange(len(sole)), sole.shape[1])
    inside = Ground(environment.table, recording).penetration(sole.reshape(-1, 3), frame)
    assert inside.max() < 0.01 * unit
    assert np.isfinite(sole).all()
    return recording


def trench(morphology: Morphology, width: float) -> tuple[Terrain, float]:
    """Return level ground with a trench so many leg lengths wide, and where it begins."""
    unit = leg_length(morphology)
    edge = front(morphology) + unit
    terrain = Terrain.trenches(
        narrowest=width * unit,
        widest=width * unit,
        depth=1.5 * unit,
        count=1,
        width=40.0 * unit,
        start=edge,
    )
    return terrain, edge


@pytest.mark.parametrize("rig", ["spider", "ant", "pentapod", "wolf", "biped"])
def test_a_trench_within_reach_is_stepped_over(rig: str) -> None:
    morphology = load_rig(rig)
    terrain, edge = trench(morphology, 0.5)
    recording = walk(morphology, terrain)
    far = edge + 0.5 * leg_length(morphology)
    assert recording.foot_position[-1, :, 2].min() > far
    assert recording.foot_position[..., 1].min() > -0.02 * leg_length(morphology)
    walked = recording.body_position[-1, 2] - recording.body_position[0, 2]
    assert walked > 0.85 * default_speed(morphology) * SECONDS


@pytest.mark.parametrize("rig", ["spider", "ant", "pentapod", "wolf", "biped"])
def test_before_one_that_is_too_wide_the_walk_ends(rig: str) -> None:
    morphology = load_rig(rig)
    terrain, edge = trench(morphology, 2.0)
    recording = walk(morphology, terrain, 4.0 * SECONDS)
    unit = leg_length(morphology)
    assert recording.foot_position[..., 1].min() > -0.02 * unit
    assert recording.foot_position[recording.foot_stance][:, 2].max() < edge
    # It came up to it, and waits there; between it tries again, ever less often.
    assert recording.foot_position[-1, :, 2].max() > edge - unit
    waiting = recording.activity == Activity.WAITING
    assert waiting[len(waiting) // 2 :].mean() > 0.5
    # Its legs are still then, once those that were up have come down.
    still = waiting & np.roll(waiting, 30)
    step = np.linalg.norm(np.diff(recording.foot_position, axis=0), axis=2).max(axis=1)
    assert np.median(step[still[1:]]) < 1e-12 * unit
    assert np.mean(step[still[1:]] < 1e-4 * unit) > 0.9


def test_a_cliff_is_not_stepped_down() -> None:
    morphology = load_rig("spider")
    unit = leg_length(morphology)
    edge = front(morphology) + unit
    terrain = Terrain.trenches(
        narrowest=50.0 * unit, widest=50.0 * unit, depth=4.0 * unit, count=1,
        width=40.0 * unit, start=edge,
    )  # fmt: skip
    recording = walk(morphology, terrain)
    assert recording.foot_position[..., 1].min() > -0.02 * unit
    assert recording.body_position[-1, 1] > 0.0


def test_a_face_too_steep_to_stand_on_is_not_climbed() -> None:
    morphology = load_rig("spider")
    unit = leg_length(morphology)
    edge = front(morphology) + unit
    steep = Terrain.slope(1.2, length=6.0 * unit, start=edge)  # 69 degrees
    recording = walk(morphology, steep)
    assert recording.foot_position[recording.foot_stance][:, 2].max() < edge + 1e-9
    gentle = Terrain.slope(0.5, length=6.0 * unit, start=edge)
    recording = walk(morphology, gentle)
    assert recording.foot_position[recording.foot_stance][:, 2].max() > edge + unit
