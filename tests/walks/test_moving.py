"""Walks among things that move, measured against the true geometry: a slice of the soak."""

from __future__ import annotations

import dataclasses
import math
import sys
from pathlib import Path

import numpy as np
import pytest

from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.morphology.load import load_rig
from polypod.recording import add_frame
from polypod.report.figures import measure
from polypod.report.record import Recorder
from polypod.world import World

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import soak
from places import default_speed
from soak_places import STILL, moving_crates

MOVING = ("crates", "platforms", "turntables", "careless")


@pytest.mark.parametrize("place", MOVING)
@pytest.mark.parametrize("rig", ["spider", "ant", "pentapod", "wolf"])
def test_nothing_goes_through_a_foot(rig: str, place: str) -> None:
    morphology = load_rig(rig)
    recording, environment = soak.walk(morphology, place, 1, 20.0, 30.0)
    result = soak.judge(recording, environment, default_speed(morphology))
    broken = set(result.broken(place))
    # The soak's limit is for the frames of many walks; in a short one a single step may be it.
    assert result.touching < 0.03
    assert broken <= {"touching"}
    assert result.distance > 0.8
    # Things did move, and were met.
    assert np.ptp(recording.obstacle_position, axis=0).max() > 0.1
    if place in ("platforms", "turntables"):
        assert (recording.foot_support[recording.foot_stance] >= 0).mean() > 0.3


@pytest.mark.parametrize("place", ["forbidden", *STILL])
@pytest.mark.parametrize("rig", ["spider", "ant", "pentapod", "wolf"])
def test_hard_ground_is_crossed(rig: str, place: str) -> None:
    morphology = load_rig(rig)
    recording, environment = soak.walk(morphology, place, 1, 20.0, 30.0)
    result = soak.judge(recording, environment, default_speed(morphology))
    assert result.touching < 0.03
    assert set(result.broken(place)) <= {"touching"}
    assert result.distance > 0.8


def test_who_stands_on_a_platform_is_carried() -> None:
    plate = Obstacle("box", (3.0, 0.2, 3.0), (0.0, 0.1, 0.0), velocity=(0.3, 0.1, -0.2))
    world = World(Environment(obstacles=[plate]), threads=1)
    herd = world.add(load_rig("spider"), position=[0.0, 0.0])
    foot, body = herd.state.foot_reached[0].copy(), herd.state.position[0].copy()
    for _ in range(60):
        world.step(1.0 / 30.0)
    way = 2.0 * np.array(plate.velocity)
    assert not herd.state.swinging.any()
    assert np.abs(herd.state.foot_reached[0] - foot - way).max() < 1e-9
    assert np.abs(herd.state.position[0] - body - way).max() < 1e-3


def test_who_stands_on_a_turntable_goes_round_with_it() -> None:
    rate, drift = 0.7, (0.05, 0.02, -0.1)
    disc = Obstacle.cylinder(4.0, 0.2, (0.6, 0.1, -0.4))
    turntable = dataclasses.replace(disc, velocity=drift, turn_rate=rate)
    world = World(Environment(obstacles=[turntable]), threads=1)
    herd = world.add(load_rig("spider"), position=[0.0, 0.0])
    state = herd.state
    began, place = state.foot_reached[0].copy(), state.position[0].copy()
    joints = state.joint_position[0].copy()
    recorder = Recorder(herd.morphology, 1)
    add_frame(recorder, world, herd, 0)
    for frame in range(1, 61):
        # It is asked to face where the turntable takes it; else it would step back.
        herd.command.heading = rate * frame / 30.0
        world.step(1.0 / 30.0)
        add_frame(recorder, world, herd, 0)
    recording = recorder.finish()
    angle = rate * 2.0
    turn = np.array(
        [
            [math.cos(angle), 0.0, math.sin(angle)],
            [0.0, 1.0, 0.0],
            [-math.sin(angle), 0.0, math.cos(angle)],
        ]
    )
    pivot = np.array(disc.position)
    after = pivot + 2.0 * np.array(drift)
    assert recording.foot_stance.all()
    assert np.abs(state.foot_reached[0] - after - (began - pivot) @ turn.T).max() < 1e-9
    assert np.abs(state.position[0] - after - (place - pivot) @ turn.T).max() < 1e-3
    assert np.abs(state.joint_position[0] - after - (joints - pivot) @ turn.T).max() < 2e-3
    assert state.heading[0] == pytest.approx(angle, abs=1e-3)
    assert recording.obstacle_rotation[-1, 0] == pytest.approx(
        (0.0, math.sin(0.5 * angle), 0.0, math.cos(0.5 * angle))
    )
    figures = measure(recording, world.environment.table)
    assert figures["stance_slip_of_leg"] < 1e-9
    assert figures["stance_skate_mm_a_frame"] < 1e-6
    assert figures["stance_off_surface_of_leg"] < 1e-6


def test_a_crate_that_comes_over_a_standing_foot_finds_it_gone() -> None:
    crate = Obstacle.box((0.3, 0.2, 0.3), (1.5, 0.1, 0.0))
    world = World(
        Environment(obstacles=[dataclasses.replace(crate, velocity=(-0.3, 0.0, 0.0))]), threads=1
    )
    herd = world.add(load_rig("spider"), position=[0.0, 0.0])
    started = herd.state.foot[0].copy()
    for _ in range(150):
        world.step(1.0 / 30.0)
        place = world.environment.places()[0]
        gap = np.abs(herd.state.foot_reached[0] - place) - 0.5 * np.array(crate.size)
        assert gap.max(axis=1).min() > -0.01 * herd.tables.leg_length
    assert np.abs(herd.state.foot[0] - started).max() > 0.1 * herd.tables.leg_length


def test_a_crate_put_under_a_foot_in_mid_swing_is_not_entered() -> None:
    """The user drops it there, without warning."""
    crate = Obstacle.box((0.12, 0.1, 0.12), (50.0, 0.05, 50.0))
    world = World(Environment(obstacles=[crate], movable=True), threads=1)
    herd = world.add(load_rig("spider"), position=[0.0, 0.0], speed=0.4)
    state, dropped = herd.state, 0
    for _ in range(240):
        swinging = np.flatnonzero(state.swinging[0] & (state.swing_progress[0] > 0.4))
        if swinging.size and world.time > 1.0 and dropped == 0:
            target = state.foot_target[0, swinging[0]]
            world.environment.move(0, (target[0], 0.05, target[2]))
            dropped += 1
        world.step(1.0 / 30.0)
        place = world.environment.places()[0]
        gap = np.abs(state.foot_reached[0] - place) - 0.5 * np.array(crate.size)
        assert gap.max(axis=1).min() > -0.01 * herd.tables.leg_length
    assert dropped == 1
    assert state.position[0, 2] > 2.0


def test_threads_make_no_difference_among_moving_crates() -> None:
    morphology = load_rig("ant")
    walks = []
    for threads in (1, 2):
        world = World(moving_crates(morphology, 3.0, 3), threads=threads)
        herd = world.add(morphology, count=4, speed=default_speed(morphology))
        for _ in range(60):
            world.step(1.0 / 30.0)
        walks.append(herd.state.joint_position.tobytes())
    assert walks[0] == walks[1]


def test_a_new_world_begins_where_its_obstacles_do() -> None:
    crate = Obstacle.box((0.2, 0.1, 0.2), (0.0, 0.05, 3.0))
    place = Environment(obstacles=[dataclasses.replace(crate, velocity=(0.0, 0.0, -0.5))])
    place.advance(6.0)
    World(place)
    assert place.places()[0] == pytest.approx([0.0, 0.05, 3.0])
