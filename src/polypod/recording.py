"""Walking a world for a while and keeping every frame: a sink of the loop."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from polypod.herd import Herd
from polypod.morphology.types import FloatArray, IntArray
from polypod.report.record import Recorder, Recording
from polypod.world import World


def add_frame(recorder: Recorder, world: World, herd: Herd, creature: int) -> None:
    """Keep what a creature of a world does now."""
    environment = world.environment
    support = herd.state.foot_support[creature]
    places, rotations = environment.places(), environment.rotations
    add_state(recorder, world.time, herd, creature, support, places, rotations)


def add_state(
    recorder: Recorder,
    time: float,
    herd: Herd,
    creature: int,
    support: IntArray,
    obstacle_position: FloatArray,
    obstacle_rotation: FloatArray,
) -> None:
    """Keep what a creature does now, beside obstacles that are numbered in any way.

    Args:
        recorder: the creature's.
        time: s.
        herd: whose creature it is.
        creature: row of the herd.
        support: [K] number of the obstacle under each foot, -1: the ground.
        obstacle_position: [O, 3] m, world.
        obstacle_rotation: [O, 4] quaternions.
    """
    state = herd.state
    standing = ~state.swinging[creature]
    recorder.add(
        time,
        state.position[creature],
        state.rotation[creature],
        state.joint_position[creature],
        state.joint_rotation[creature],
        state.foot_reached[creature],
        state.foot[creature],
        standing,
        np.where(standing, support, -1),
        obstacle_position,
        obstacle_rotation,
        int(state.activity[creature]),
        herd.gait_name[creature],
    )


def record_walk(
    world: World,
    seconds: float,
    fps: float,
    progress: Callable[[int, int], None] | None = None,
) -> list[Recording]:
    """Walk a world for `seconds` and return a recording for each creature, herd by herd.

    There are round(seconds x fps) + 1 frames, the first at time 0, before anything moved.
    `progress(done, total)` is called after each frame.
    """
    obstacles = world.environment.obstacles
    recorders = [
        (herd, creature, Recorder(herd.morphology, len(obstacles)))
        for herd in world.herds
        for creature in range(herd.count)
    ]
    steps = round(seconds * fps)
    start = world.time
    for herd, creature, recorder in recorders:
        add_frame(recorder, world, herd, creature)
    for step in range(1, steps + 1):
        world.step(1.0 / fps)
        # Times are counted, not summed: frame n is at n / fps to the last bit.
        world.time = start + step / fps
        for herd, creature, recorder in recorders:
            add_frame(recorder, world, herd, creature)
        if progress is not None:
            progress(step, steps)
    return [recorder.finish() for _, _, recorder in recorders]
