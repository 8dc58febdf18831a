"""Creatures among others: they pass, never meet, and get where they go; alone they walk as ever."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowd.crowds import FPS, crowd, far_from_goal, feet_gap, soles_gap, trunk_gap
from polypod.activity import Activity
from polypod.config import Settings
from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.morphology.load import load_rig
from polypod.world import World

NEAR = 0.6  # leg lengths from the goal


def ring(count: int) -> np.ndarray:
    """Return places on a ring: who crosses it meets all others in the middle."""
    angle = np.arange(count) * 2.0 * math.pi / count
    radius = max(4.0, count * 3.0 / (2.0 * math.pi))
    return radius * np.stack([np.sin(angle), np.cos(angle)], axis=1)


def block(count: int, x: float, z: float) -> np.ndarray:
    """Return rows of places three leg lengths apart."""
    side = math.isqrt(count)
    return np.array([[x + 3.0 * i, z + 3.0 * j] for j in range(side) for i in range(side)])


CROWDS = {
    "head on": ("spider", [[0, 0], [0, 9]], [[0, 9], [0, 0]]),
    "crossing": ("spider", [[0, 0], [-5, 5]], [[0, 10], [5, 5]]),
    "one stands": ("spider", [[0, 0], [0, 5]], [[0, 10], [0, 5]]),
    "wolves": ("wolf", [[0, 0], [0.1, 8]], [[0, 8], [0.1, 0]]),
    "overtaking": ("ant", [[0, 0], [0.2, 4]], [[0, 16], [0.2, 6]]),
    "a ring": ("spider", ring(8), -ring(8)),
    "two bands": (
        "spider",
        np.concatenate([block(9, 0, 0), block(9, 1, 12)]),
        np.concatenate([block(9, 0, 20), block(9, 1, -8)]),
    ),
}


@pytest.mark.parametrize("name", CROWDS)
def test_they_pass_and_all_arrive(name: str) -> None:
    rig, starts, goals = CROWDS[name]
    world = crowd(rig, starts, goals)
    herd = world.herds[0]
    for frame in range(round(60 * FPS)):
        world.step(1.0 / FPS)
        assert trunk_gap(herd) > -1e-3, frame
        assert feet_gap(herd) > -0.01, frame
        assert soles_gap(herd) > -0.01, frame
        if np.all(far_from_goal(herd) < NEAR):
            break
    assert np.all(far_from_goal(herd) < NEAR)


def test_who_keeps_no_space_walks_through() -> None:
    rig, starts, goals = CROWDS["head on"]
    world = crowd(rig, starts, goals, personal_space=0.0)
    herd = world.herds[0]
    least = math.inf
    for _ in range(round(8 * FPS)):
        world.step(1.0 / FPS)
        least = min(least, trunk_gap(herd))
    assert np.abs(herd.state.position[:, 0]).max() < 0.05
    assert least < -0.1


@pytest.mark.parametrize("threads", [2, 3])
def test_threads_make_no_difference_in_a_crowd(threads: int) -> None:
    walks = []
    for count in (1, threads):
        world = crowd("spider", ring(8), -ring(8), threads=count)
        for _ in range(round(7 * FPS)):
            world.step(1.0 / FPS)
        walks.append(world.herds[0].state.joint_position.tobytes())
    assert walks[0] == walks[1]


def test_herds_see_each_other_in_whatever_order_they_come() -> None:
    places = {"spider": (0.0, 0.0, 0.0), "ant": (0.1, 4.0, math.pi)}
    walks = {}
    for order in (("spider", "ant"), ("ant", "spider")):
        world = World(threads=1)
        herds = {
            rig: world.add(
                load_rig(rig), position=places[rig][:2], heading=places[rig][2], speed=0.5
            )
            for rig in order
        }
        for _ in range(round(6 * FPS)):
            world.step(1.0 / FPS)
        # They met, and stepped aside.
        assert max(abs(herd.state.position[0, 0]) for herd in herds.values()) > 0.2
        walks[order] = {rig: herd.state.joint_position.tobytes() for rig, herd in herds.items()}
    first, second = walks.values()
    assert first == second


def test_others_far_away_change_nothing() -> None:
    crate = Obstacle.box((0.4, 0.05, 0.4), (0.1, 0.025, 1.0))
    walks = []
    for company in (False, True):
        world = World(Environment(obstacles=[crate]), threads=1)
        herd = world.add(load_rig("spider"), position=[0.0, 0.0], speed=0.5)
        if company:
            world.add(load_rig("wolf"), 3, position=[[40, 0], [42, 0], [44, 0]], speed=0.5)
        for _ in range(60):
            world.step(1.0 / FPS)
        walks.append(herd.state.joint_position.tobytes())
    assert walks[0] == walks[1]


def test_small_ones_walk_under_a_large_one() -> None:
    world = World(threads=1)
    large = world.add(load_rig("spider", height=6.0), position=[0.0, 0.0])
    small = world.add(load_rig("ant"), position=[0.0, -3.0], speed=0.5)
    assert large.state.position[0, 1] > 2.0 * float(small.tables.body.height)
    for _ in range(round(12 * FPS)):
        world.step(1.0 / FPS)
    assert small.state.position[0, 2] > 2.0
    assert abs(small.state.position[0, 0]) < 1.5


def test_one_in_the_only_way_is_waited_for() -> None:
    """In a lane of its own width there is no way round one who stands."""
    leg = float(load_rig("spider").legs.length.mean())
    walls = [
        Obstacle.box((leg, leg, 30 * leg), (side * 1.1 * leg, 0.5 * leg, 0.0)) for side in (-1, 1)
    ]
    world = crowd("spider", [[0, -5], [0, 0]], [[0, 6], [0, 0]], place=Environment(obstacles=walls))
    herd = world.herds[0]
    waited = 0
    for frame in range(round(24 * FPS)):
        world.step(1.0 / FPS)
        assert trunk_gap(herd) > -1e-3
        waited += frame > 12 * FPS and herd.state.activity[0] == Activity.WAITING
    assert herd.state.position[0, 2] < 0.0
    assert waited > 4 * FPS
    assert herd.state.activity[1] == Activity.ARRIVED


def test_personal_space_is_judged() -> None:
    from polypod.errors import SettingError

    with pytest.raises(SettingError, match="personal_space"):
        Settings(personal_space=-1.0)
