"""Pushed creatures: they step to catch themselves, break no limit, and go on as before."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from places import default_speed, hip_height, leg_length
from pushes import PUSHED_AT, failures, judge, take

from polypod.errors import SettingError
from polypod.herd import Herd
from polypod.morphology.load import load_rig
from polypod.morphology.types import Morphology
from polypod.recording import record_walk
from polypod.world import World

FPS = 30.0
SIDES = 3


@pytest.fixture(scope="module", params=["spider", "wolf"])
def creature(request: pytest.FixtureRequest) -> Morphology:
    return load_rig(request.param)


def unit_speed(morphology: Morphology) -> float:
    return math.sqrt(9.81 * hip_height(morphology))


@pytest.mark.parametrize(
    ("place", "walks", "strength"),
    [("flat", True, 0.5), ("crates", True, 0.5), ("crates", True, 2.5), ("flat", False, 2.5)],
)
def test_pushed_from_several_sides(
    creature: Morphology, place: str, walks: bool, strength: float
) -> None:
    speed = default_speed(creature) if walks else 0.0
    seconds = PUSHED_AT + 16.0 * math.sqrt(leg_length(creature) / 9.81)
    walked = take(creature, place, speed, strength, seconds, FPS, SIDES)
    result = judge(*walked, speed * seconds)
    assert failures(result, place, strength) == []
    # And pushed they were: farther than a leg's swing to and fro takes them, and they stepped.
    assert result.farthest > 0.15
    assert result.steps >= 1


def stand(creature: Morphology) -> tuple[World, Herd]:
    world = World(threads=1)
    return world, world.add(creature, position=[0.0, 0.0])


def seconds_after(world: World, seconds: float, fps: float = FPS) -> None:
    for _ in range(round(seconds * fps)):
        world.step(1.0 / fps)


def test_a_small_push_is_swayed_with_and_a_large_one_stepped_with(creature: Morphology) -> None:
    lifted = []
    for strength in (0.05, 0.5):
        world, herd = stand(creature)
        herd.push([strength * unit_speed(creature), 0.0, 0.0])
        off, up = 0.0, False
        for _ in range(30):
            world.step(1.0 / FPS)
            off = max(off, float(herd.state.position[0, 0]))
            up = up or bool(herd.state.swinging.any())
        assert off > 0.2 * strength * hip_height(creature)
        lifted.append(up)
    assert lifted == [False, True]


def test_feet_step_to_where_they_catch_the_body(creature: Morphology) -> None:
    world, herd = stand(creature)
    before = herd.state.foot[0].copy()
    herd.push([0.5 * unit_speed(creature), 0.0, 0.0])
    quick = 1.0 / herd.tables.recovery
    landed = np.zeros(len(before))
    for _ in range(round(quick * FPS)):
        world.step(1.0 / FPS)
        standing = ~herd.state.swinging[0]
        landed = np.maximum(landed, np.where(standing, (herd.state.foot[0] - before)[:, 0], 0.0))
    # Within the time in which the body gets farthest a foot stands about as far aside.
    assert landed.max() > 0.5 * float(herd.state.position[0, 0])
    seconds_after(world, 12.0 * quick)
    assert np.abs(herd.state.position[0, [0, 2]]).max() < 1e-3 * leg_length(creature)
    assert np.abs(herd.state.foot[0] - before).max() < 0.1 * leg_length(creature)


@pytest.mark.parametrize("angle", [0.0, 0.5 * math.pi, math.pi])
def test_what_was_asked_for_still_counts(creature: Morphology, angle: float) -> None:
    speed = default_speed(creature)
    world = World(threads=1)
    herd = world.add(creature, position=[0.0, 0.0], speed=speed)
    herd.command.set_path([[0.0, 0.0], [0.0, 100.0]], 0)
    seconds_after(world, 2.0)
    size = 0.5 * unit_speed(creature)
    herd.push([size * math.sin(angle), 0.0, size * math.cos(angle)])
    seconds_after(world, 0.2)
    assert herd.state.speed[0] == pytest.approx(speed, rel=1e-6)
    seconds_after(world, 3.0)
    begin = herd.state.position[0].copy()
    seconds_after(world, 2.0)
    way = herd.state.position[0] - begin
    assert way[2] / 2.0 == pytest.approx(speed, rel=0.03)
    assert abs(herd.state.position[0, 0]) < 0.04 * leg_length(creature)


@pytest.mark.parametrize("walks", [True, False], ids=["walks", "stands"])
def test_frame_rates_agree(creature: Morphology, walks: bool) -> None:
    """How far aside it goes: what is lost ahead where a foot lifts late depends on the frames."""
    ways = []
    for fps in (30.0, 60.0, 240.0):
        world = World(threads=1)
        speed = default_speed(creature) if walks else 0.0
        herd = world.add(creature, position=[0.0, 0.0], speed=speed)
        world.push_at(1.0, [0.5 * unit_speed(creature), 0.0, 0.0])
        places = []
        for frame in range(1, round(2.5 * fps) + 1):
            world.step(1.0 / fps)
            world.time = frame / fps
            if frame % round(fps / 30.0) == 0:
                places.append(herd.state.position[0, 0])
        ways.append(np.array(places))
    for way in ways[:2]:
        assert np.abs(way - ways[2]).max() < 0.03 * leg_length(creature)
    assert ways[2].max() > 0.15 * leg_length(creature)


def test_off_the_centre_it_turns_and_comes_back(creature: Morphology) -> None:
    at = 0.5 * float(creature.body.box_centre[2] + creature.body.half_size[2])
    headings = []
    for place in (at, -at):
        world, herd = stand(creature)
        herd.push([0.5 * unit_speed(creature), 0.0, 0.0], at=place)
        most = 0.0
        for _ in range(round(14.0 / herd.tables.recovery * FPS)):
            world.step(1.0 / FPS)
            if abs(herd.state.heading[0]) > abs(most):
                most = float(herd.state.heading[0])
        headings.append(most)
        assert abs(herd.state.heading[0]) < 1e-3
    # Its front goes where it is pushed; its back, and the front goes the other way.
    assert headings[0] > 0.1
    assert headings[0] == pytest.approx(-headings[1], rel=0.05)


@settings(max_examples=15, deadline=None)
@given(
    velocity=st.lists(st.floats(-1e3, 1e3), min_size=3, max_size=3),
    at=st.floats(-0.05, 0.05),
    again=st.integers(0, 20),
)
def test_no_push_is_too_much(velocity: list[float], at: float, again: int) -> None:
    world, herd = stand(load_rig("spider"))
    recordings = []
    for _ in range(2):
        herd.push(velocity, at=at)
        recordings.append(record_walk(world, (again + 1) / FPS, FPS)[0])
    for recording in recordings:
        assert np.isfinite(recording.joint_position).all()
        stance = recording.foot_stance[1:] & recording.foot_stance[:-1]
        step = np.linalg.norm(np.diff(recording.foot_position, axis=0), axis=2)
        assert (step[stance] < 1e-3 * leg_length(recording.morphology)).all()


def test_who_is_not_pushed_is_on_its_path(creature: Morphology) -> None:
    world = World(threads=1)
    herd = world.add(creature, 2, speed=default_speed(creature))
    herd.push([0.3, 0.0, 0.0], creature=1)
    seconds_after(world, 0.5)
    assert not herd.state.deflection[0].any()
    assert herd.state.deflection[1, 0] > 0.0


def test_a_blow_up_lifts_and_one_down_makes_it_crouch(creature: Morphology) -> None:
    heights = []
    for up in (0.3, 0.0, -0.3):
        world, herd = stand(creature)
        herd.push([0.0, up * unit_speed(creature), 0.0])
        seconds_after(world, 0.1)
        heights.append(float(herd.state.position[0, 1]))
    assert heights[0] > heights[1] > heights[2]


def test_pushes_come_when_they_are_planned_to(creature: Morphology) -> None:
    world = World(threads=1)
    herds = [world.add(creature, 2), world.add(creature, position=[9.0, 0.0])]
    world.push_at(0.5, [0.1, 0.0, 0.0], 2)
    world.push_at(0.2, [0.0, 0.0, 0.1], 1)
    moved = []
    for _ in range(20):
        world.step(0.05)
        off = [herd.state.deflection[c].any() for herd in herds for c in range(herd.count)]
        moved.append(off)
    first = [next((n for n, off in enumerate(moved) if off[c]), -1) for c in range(3)]
    assert first == [-1, 4, 10]


@pytest.mark.parametrize(
    ("velocity", "creature_row", "at", "word"),
    [
        ([1.0, 0.0], 0, 0.0, "x, y, z"),
        ([math.nan, 0.0, 0.0], 0, 0.0, "x, y, z"),
        ([1e9, 0.0, 0.0], 0, 0.0, "1000"),
        (["a", 0.0, 0.0], 0, 0.0, "m/s"),
        ([1.0, 0.0, 0.0], 3, 0.0, "from 0 to 0"),
        ([1.0, 0.0, 0.0], "all", 0.0, "from 0 to 0"),
        ([1.0, 0.0, 0.0], 0, 50.0, "trunk"),
        ([1.0, 0.0, 0.0], 0, math.nan, "trunk"),
        ([1.0, 0.0, 0.0], 0, "front", "trunk"),
    ],
)
def test_what_is_no_push_is_refused(
    creature: Morphology, velocity: object, creature_row: object, at: object, word: str
) -> None:
    world, herd = stand(creature)
    with pytest.raises(SettingError, match=word):
        herd.push(velocity, creature_row, at=at)  # type: ignore[arg-type]
    with pytest.raises(SettingError, match=word):
        world.push_at(1.0, velocity, creature_row, at=at)  # type: ignore[arg-type]
    assert not herd.state.deflection.any()


@pytest.mark.parametrize("time", [-1.0, math.nan, math.inf, "soon"])
def test_a_push_is_not_in_the_past(creature: Morphology, time: object) -> None:
    world, _ = stand(creature)
    with pytest.raises(SettingError, match="from 0 s on"):
        world.push_at(time, [1.0, 0.0, 0.0])  # type: ignore[arg-type]
