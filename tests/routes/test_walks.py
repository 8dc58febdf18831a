"""Walks along ways: creatures get where they would have stuck, and say so where they cannot."""

from __future__ import annotations

import math

import numpy as np
import pytest

from polypod.activity import Activity
from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.herd import Herd
from polypod.morphology.load import load_rig
from polypod.recording import record_walk
from polypod.report.arrays import runs_of
from polypod.report.figures import measure
from polypod.report.verdict import remarks
from polypod.world import World
from routes import places
from routes.places import box, leg_of

FPS = 30.0


def walker(place: Environment, goal, rig="spider", start=(0.0, 0.0), threads=1) -> tuple:
    """Return a world and its herd of one that goes from a start to a goal, leg lengths."""
    leg = leg_of(rig)
    world = World(place, threads=threads)
    speed = 0.25 * math.sqrt(9.81 * leg)
    herd = world.add(load_rig(rig), position=[start[0] * leg, start[1] * leg], speed=speed)
    herd.command.set_path([[goal[0] * leg, goal[1] * leg]], 0)
    return world, herd


def walk(world: World, seconds: float) -> None:
    for _ in range(round(seconds * FPS)):
        world.step(1.0 / FPS)


def away(herd: Herd) -> float:
    """Return how far the first is from its goal, leg lengths."""
    to = herd.command.arrays.waypoints[0, 0] - herd.state.position[0, [0, 2]]
    return float(np.linalg.norm(to)) / herd.tables.leg_length


@pytest.mark.parametrize("forbidden", [False, True])
@pytest.mark.parametrize("rig", ["spider", "wolf"])
def test_a_dead_end_is_walked_out_of(rig: str, forbidden: bool) -> None:
    place = places.trap(leg_of(rig), forbidden)
    world, herd = walker(place, (0, 7), rig=rig, start=(0, 2.6))
    walk(world, 22.0)
    assert away(herd) < 0.1
    assert herd.state.activity[0] == Activity.ARRIVED


def test_a_maze_is_walked_through() -> None:
    world, herd = walker(places.maze(leg_of("spider"), True), (0, 8.5))
    walk(world, 28.0)
    assert away(herd) < 0.1


def test_it_stops_before_what_it_cannot_reach_and_says_so() -> None:
    leg = leg_of("spider")
    block = Obstacle.box((3 * leg, 2 * leg, 3 * leg), (0, leg, 6 * leg))
    world, herd = walker(Environment(obstacles=[block]), (0, 6))
    recording = record_walk(world, 14.0, FPS)[0]
    assert herd.state.activity[0] == Activity.BLOCKED
    assert 1.5 < away(herd) < 2.3
    still = herd.state.joint_position.copy()
    walk(world, 2.0)
    assert np.array_equal(still, herd.state.joint_position)
    figures = measure(recording, world.environment.table)
    assert figures["ended"] == "blocked"
    assert figures["blocked_s"] > 2.0
    assert any("no way" in remark for remark in remarks(figures))


def test_it_goes_on_when_the_way_opens() -> None:
    leg = leg_of("spider")
    walls = ((-2, 3, 2, 3.3), (-2, -2, 2, -1.7), (-2, -2, -1.7, 3.3), (1.7, -2, 2, 3.3))
    place = Environment(obstacles=[box(leg, *wall) for wall in walls], movable=True)
    world, herd = walker(place, (0, 7))
    walk(world, 9.0)
    assert herd.state.activity[0] == Activity.BLOCKED
    place.move(0, (0.0, leg, 30.0 * leg))
    walk(world, 12.0)
    assert herd.state.activity[0] == Activity.ARRIVED


def test_a_goal_that_moves_is_followed_at_a_bounded_cost() -> None:
    leg = leg_of("spider")
    world, herd = walker(places.trap(leg, False), (0, 7))
    clock = herd.state.route.clock
    looks, before = 0, 0.0
    for frame in range(120):
        herd.command.set_path([[(3 + math.sin(0.2 * frame) * 2) * leg, 8 * leg]], 0)
        world.step(1.0 / FPS)
        looks += clock[0] < before + 0.5 / FPS
        before = float(clock[0])
    pendulum = herd.tables.pendulum_time
    assert 4 <= looks <= 120 / FPS / pendulum + 1


def test_threads_and_company_make_no_difference_to_a_way() -> None:
    leg = leg_of("spider")
    walks = []
    for threads in (1, 2):
        place = places.trap(leg, False)
        world = World(place, threads=threads)
        starts = [[0.0, 0.0], [40.0 * leg, 0.0], [80.0 * leg, 0.0], [120.0 * leg, 0.0]]
        herd = world.add(load_rig("spider"), 4, position=starts, speed=0.5)
        for c, start in enumerate(starts):
            herd.command.set_path([[start[0], 7 * leg]], c)
        walk(world, 5.0)
        walks.append(herd.state.joint_position.tobytes())
    assert walks[0] == walks[1]
    world, lone = walker(places.trap(leg, False), (0, 7))
    lone.command.speed = 0.5
    walk(world, 5.0)
    assert lone.state.joint_position[0].tobytes() == herd.state.joint_position[0].tobytes()


def test_words_for_what_it_does() -> None:
    world, herd = walker(Environment(), (0, 2))
    assert herd.state.activity[0] == Activity.STANDING
    walk(world, 1.0)
    assert herd.state.activity[0] == Activity.WALKING
    walk(world, 5.0)
    assert herd.state.activity[0] == Activity.ARRIVED
    idle = World(threads=1)
    quiet = idle.add(load_rig("wolf"), position=[0.0, 0.0])
    walk(idle, 1.0)
    assert quiet.state.activity[0] == Activity.STANDING


def test_where_no_step_is_safe_it_waits_with_still_legs_and_says_so() -> None:
    """On an island of its own size, a heading and no path: it comes to the edge and stops."""
    leg = leg_of("spider")
    island = Obstacle.box((2.4 * leg, 3 * leg, 2.4 * leg), (0, 1.5 * leg, 0))
    world = World(Environment(obstacles=[island]), threads=1)
    herd = world.add(load_rig("spider"), position=[0.0, 0.0], speed=0.5)
    recording = record_walk(world, 17.0, FPS)[0]
    assert herd.state.activity[0] == Activity.WAITING
    assert np.all(herd.state.foot_support[0] == 0)
    first, last = max(
        runs_of(recording.activity == Activity.WAITING), key=lambda run: run[1] - run[0]
    )
    assert last - first > 2.0 * FPS
    still = slice(first, last)
    assert recording.foot_stance[still].all()
    assert np.ptp(recording.foot_target[still], axis=0).max() == 0.0
    assert np.ptp(recording.foot_position[still], axis=0).max() < 1e-6 * leg
    assert np.ptp(recording.body_position[still][:, [0, 2]], axis=0).max() < 0.01 * leg
    figures = measure(recording, world.environment.table)
    assert figures["ended"] == "waiting"
    assert figures["waiting_s"] > 1.0
    assert figures["waiting_until_s"][-1] == pytest.approx(17.0)
    assert any("waited" in remark for remark in remarks(figures))
