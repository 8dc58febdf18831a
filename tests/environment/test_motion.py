"""Obstacles that move: where they are, and that what is foreseen comes true."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.environment import Environment, Obstacle, Terrain
from polypod.environment.maps import fill_maps, make_local_map
from polypod.environment.movers import clear_of_movers, mover_depth
from polypod.environment.scattering import scatter
from polypod.environment.table import (
    EnvironmentTable,
    is_forbidden_at,
    penetration_at,
    surface,
    surface_at,
    surface_normal_at,
)
from polypod.errors import SceneError
from polypod.math.quat import Quat, from_heading
from polypod.math.vec3 import Vec3

BOX = Obstacle.box((0.4, 0.2, 0.6), (0.0, 0.1, 0.0), yaw=0.4)
LOOP = dataclasses.replace(BOX, path=((1.0, 0.1, 0.0), (1.0, 0.1, 2.0)), speed=0.5)


def test_constant_velocity_is_a_straight_line() -> None:
    place = Environment(obstacles=[dataclasses.replace(BOX, velocity=(0.2, 0.1, -0.3))])
    for time in (0.0, 0.7, 12.5):
        place.advance(time)
        assert place.places()[0] == pytest.approx([0.2 * time, 0.1 + 0.1 * time, -0.3 * time])


def test_a_path_is_a_loop_at_constant_speed() -> None:
    place = Environment(obstacles=[LOOP])
    around = 1.0 + 2.0 + math.sqrt(5.0)
    for way, expected in (
        (0.0, (0.0, 0.0)),
        (0.25, (0.25, 0.0)),
        (1.0, (1.0, 0.0)),
        (2.5, (1.0, 1.5)),
        (3.0 + 0.5 * math.sqrt(5.0), (0.5, 1.0)),
        (around + 0.25, (0.25, 0.0)),
    ):
        place.advance(way / 0.5)
        x, y, z = place.places()[0]
        assert (x, z) == pytest.approx(expected, abs=1e-12)
        assert y == 0.1


def as_they_will_be(
    env: Environment, moving: list[Obstacle], time: float, ahead: float
) -> EnvironmentTable:
    """Return a still world with the obstacles where they will be."""
    there = env.places() + ahead * np.array([obstacle.velocity for obstacle in moving])
    return Environment(
        obstacles=[
            dataclasses.replace(
                obstacle,
                position=tuple(place.tolist()),
                rotation=spun(obstacle.rotation, obstacle.turn_rate * (time + ahead)),
                velocity=(0.0, 0.0, 0.0),
                turn_rate=0.0,
            )
            for obstacle, place in zip(moving, there, strict=True)
        ]
    ).kernel_table


def spun(rotation: tuple[float, ...], angle: float) -> tuple[float, float, float, float]:
    """Return a rotation followed by a turn about the vertical."""
    return tuple(from_heading(angle) * Quat(*rotation))  # type: ignore[return-value]


@given(
    seed=st.integers(0, 10_000),
    time=st.floats(0.0, 20.0),
    ahead=st.floats(0.0, 1.0),
    x=st.floats(-2.0, 2.0),
    z=st.floats(-2.0, 2.0),
)
@settings(max_examples=200, deadline=None)
def test_questions_are_answered_as_for_obstacles_that_stand_there(
    seed: int, time: float, ahead: float, x: float, z: float
) -> None:
    """Asked for later, about a moving world: as a still world says that is built as it is then."""
    random = np.random.default_rng(seed)
    size = ((0.1, 0.1, 0.1), (0.8, 0.4, 0.8))
    crates = scatter(Terrain.flat(), 12, (-2.0, -2.0, 2.0, 2.0), size, seed, 0.3)
    moving = []
    for number, crate in enumerate(crates):
        velocity = tuple(random.uniform(-0.4, 0.4, 3).tolist())
        rate = float(random.uniform(-2.0, 2.0)) if number % 2 else 0.0
        moving.append(dataclasses.replace(crate, velocity=velocity, turn_rate=rate))
    env = Environment(obstacles=moving)
    env.advance(time)
    still = as_they_will_be(env, moving, time, ahead)
    height, support = surface(still, x, z)
    assert surface_at(env.kernel_table, x, z, ahead) == (pytest.approx(height, abs=1e-9), support)
    deep, _ = penetration_at(still, Vec3(x, 0.05, z), 0.0)
    depth, _ = penetration_at(env.kernel_table, Vec3(x, 0.05, z), ahead)
    # Outside, how near is only told within a bucket.
    assert max(depth, 0.0) == pytest.approx(max(deep, 0.0), abs=1e-9)
    assert max(mover_depth(env.kernel_table, Vec3(x, 0.05, z), ahead, -1), 0.0) == pytest.approx(
        max(penetration_at(still, Vec3(x, 0.05, z), 0.0)[0], 0.0), abs=1e-9
    )
    assert is_forbidden_at(env.kernel_table, x, z, 0.1, ahead) == is_forbidden_at(
        still, x, z, 0.1, 0.0
    )
    normal = surface_normal_at(env.kernel_table, x, z, ahead)
    assert normal == pytest.approx(surface_normal_at(still, x, z, 0.0), abs=1e-9)


@given(time=st.floats(0.0, 30.0), ahead=st.floats(0.0, 1.0))
@settings(max_examples=100, deadline=None)
def test_a_turn_of_the_way_is_foreseen(time: float, ahead: float) -> None:
    env, later = Environment(obstacles=[LOOP]), Environment(obstacles=[LOOP])
    env.advance(time)
    later.advance(time + ahead)
    x, _, z = later.places()[0]
    assert surface_at(env.kernel_table, x, z, ahead) == (pytest.approx(0.2), 0)


@pytest.mark.parametrize(
    "obstacle",
    [
        BOX,
        Obstacle.sphere(0.5, (0.0, 0.2, 0.0)),
        Obstacle.cylinder(0.4, 0.5, (0.0, 0.25, 0.0)),
        Obstacle.cylinder(0.4, 0.5, (0.0, 0.2, 0.0), (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))),
    ],
    ids=["box", "sphere", "cylinder", "lying cylinder"],
)
def test_the_way_out_is_short_and_never_down(obstacle: Obstacle) -> None:
    env = Environment(obstacles=[obstacle], movable=True)
    env.move(0, (3.0, 0.3, -2.0))
    env.advance(0.0)
    random = np.random.default_rng(1)
    inside = shortest = 0
    for offset in random.uniform(-0.25, 0.25, (200, 3)):
        point = Vec3(*(np.array([3.0, 0.3, -2.0]) + offset).tolist())
        depth = mover_depth(env.kernel_table, point, 0.0, -1)
        free = clear_of_movers(env.kernel_table, point, 0.0, -1)
        assert clear_of_movers(env.kernel_table, point, 0.0, 0) == point
        if depth <= 0.0:
            assert free == point
            continue
        inside += 1
        assert math.dist(free, point) >= depth - 1e-9
        # A little past the face, or it would be on top as well.
        assert -1e-6 < mover_depth(env.kernel_table, free, 0.0, -1) < 1e-9
        assert free.y >= point.y - 0.5 * math.dist(free, point) - 1e-9
        shortest += abs(math.dist(free, point) - depth) < 1e-6
    assert inside > 20
    assert shortest > 0.4 * inside


def test_what_is_moved_is_there_after_the_next_step() -> None:
    env = Environment(obstacles=[BOX], movable=True)
    env.move(0, (5.0, 0.1, 1.0), (0.0, 0.0, 0.4))
    assert surface(env.kernel_table, 5.0, 1.0)[1] == -1
    env.advance(0.1)
    assert surface(env.kernel_table, 5.0, 1.0) == (pytest.approx(0.2), 0)
    assert surface_at(env.kernel_table, 5.0, 1.4, 1.0) == (pytest.approx(0.2), 0)
    assert env.table.step[0] == pytest.approx([5.0, 0.0, 1.0])
    env.advance(0.2)
    assert env.table.step[0] == pytest.approx([0.0, 0.0, 0.0])


def test_moving_is_refused_in_one_sentence() -> None:
    with pytest.raises(SceneError, match="movable=True"):
        Environment(obstacles=[BOX]).move(0, (0.0, 0.0, 0.0))
    env = Environment(obstacles=[BOX, LOOP], movable=True)
    with pytest.raises(SceneError, match="obstacle 1 cannot be moved"):
        env.move(1, (0.0, 0.0, 0.0))
    with pytest.raises(SceneError, match="obstacle 2 cannot be moved"):
        env.move(2, (0.0, 0.0, 0.0))
    with pytest.raises(SceneError, match="three numbers"):
        env.move(0, (0.0, math.nan, 0.0))


SOLIDS = [
    Obstacle.box((0.5, 0.2, 0.3), (0.1, 0.1, 0.2), yaw=0.3),
    Obstacle.cylinder(0.3, 0.4, (-0.3, 0.1, -0.2), (0.0, 0.0, 0.6, 0.8)),
    Obstacle.sphere(0.3, (0.4, 0.05, -0.4)),
    Obstacle.hull(
        np.random.default_rng(3).uniform(-0.25, 0.25, (9, 3)),
        (-0.3, 0.1, 0.4),
        (0.0, 0.6, 0.8, 0.0),
    ),
    Obstacle(
        "mesh",
        (0.6, 0.2, 0.6),
        (0.5, 0.1, 0.5),
        parts=tuple(
            tuple(
                (x + s * 0.25, y, z)
                for x in (-0.05, 0.05)
                for y in (-0.1, 0.1)
                for z in (-0.3, 0.3)
            )
            for s in (-1, 1)
        ),
    ),
]


@given(
    seed=st.integers(0, 10_000),
    time=st.floats(0.0, 20.0),
    ahead=st.floats(0.0, 1.0),
    rate=st.floats(-3.0, 3.0),
)
@settings(max_examples=100, deadline=None)
def test_solids_of_all_kinds_turn_about_their_positions(
    seed: int, time: float, ahead: float, rate: float
) -> None:
    random = np.random.default_rng(seed)
    moving = [
        dataclasses.replace(
            solid,
            velocity=tuple(random.uniform(-0.2, 0.2, 3).tolist()),
            turn_rate=rate * float(random.uniform(0.2, 1.0)),
        )
        for solid in SOLIDS
    ]
    env = Environment(obstacles=moving)
    env.advance(time)
    still = as_they_will_be(env, moving, time, ahead)
    middle = env.places()[seed % len(SOLIDS)]
    for off in random.uniform(-0.4, 0.4, (20, 3)):
        point = Vec3(*(middle + off).tolist())
        height, support = surface(still, point.x, point.z)
        assert surface_at(env.kernel_table, point.x, point.z, ahead) == (
            pytest.approx(height, abs=1e-9),
            support,
        )
        deep, _ = penetration_at(still, point, 0.0)
        depth, _ = penetration_at(env.kernel_table, point, ahead)
        assert max(depth, 0.0) == pytest.approx(max(deep, 0.0), abs=1e-9)
        normal = surface_normal_at(env.kernel_table, point.x, point.z, ahead)
        assert normal == pytest.approx(surface_normal_at(still, point.x, point.z, 0.0), abs=1e-7)


@given(time=st.floats(0.0, 20.0), seed=st.integers(0, 10_000))
@settings(max_examples=40, deadline=None)
def test_maps_show_what_turns_as_it_is_turned(time: float, seed: int) -> None:
    random = np.random.default_rng(seed)
    moving = [
        dataclasses.replace(solid, turn_rate=float(random.uniform(-2.0, 2.0))) for solid in SOLIDS
    ]
    env = Environment(obstacles=moving)
    env.advance(time)
    still = as_they_will_be(env, moving, time, 0.0)
    seen, expected = make_local_map(40), make_local_map(40)
    yaw = float(random.uniform(-3.0, 3.0))
    for table, window in ((env.kernel_table, seen), (still, expected)):
        fill_maps(table, window, 0.0, 0.0, 0.05, 40, 0.03, 0.05, yaw, 0.0)
    # A cell that is only just touched may go either way by rounding.
    other = np.abs(seen.highest - expected.highest) > 1e-6
    assert other.mean() < 0.004
    other = np.abs(seen.lowest - expected.lowest) > 1e-6
    assert other.mean() < 0.004


def test_parts_of_a_mesh_are_one_obstacle() -> None:
    env = Environment(obstacles=[BOX, SOLIDS[4]], movable=True)
    assert env.table.owner.tolist() == [0, 1, 1]
    env.move(1, (3.0, 0.1, -2.0), (0.1, 0.0, 0.0), turned=0.5 * math.pi, turn_rate=0.4)
    env.advance(0.0)
    # Turned by a quarter, what was at +x is at -z.
    assert surface(env.kernel_table, 3.0, -2.25) == (pytest.approx(0.2), 1)
    assert surface(env.kernel_table, 3.0, -1.75) == (pytest.approx(0.2), 1)
    assert surface(env.kernel_table, 3.25, -2.0)[1] == -1
    assert env.rotations[1] == pytest.approx((0.0, math.sqrt(0.5), 0.0, math.sqrt(0.5)))
    assert env.places()[1] == pytest.approx((3.0, 0.1, -2.0))
    # In the seam between parts nothing is in the way of a foot that stands on one.
    inside = Vec3(3.0, 0.15, -2.25)
    assert mover_depth(env.kernel_table, inside, 0.0, -1) > 0.0
    assert mover_depth(env.kernel_table, inside, 0.0, 1) < 0.0
    # Left out, the turn stays as it is, also before it has come about.
    env.move(1, (5.0, 0.1, -2.0), turned=-0.5 * math.pi)
    env.move(1, (4.0, 0.1, -2.0))
    env.advance(0.1)
    assert surface(env.kernel_table, 4.0, -2.25) == (pytest.approx(0.2), 1)
    with pytest.raises(SceneError, match="turned by"):
        env.move(1, (0.0, 0.0, 0.0), turned=math.nan)
    with pytest.raises(SceneError, match="turn_rate"):
        dataclasses.replace(BOX, turn_rate=1e3)
