"""Terrains and obstacles: what generators promise, and what is refused."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from polypod.environment import Environment, Obstacle, Terrain, scatter
from polypod.environment.convex import polygon_around, polygon_sides
from polypod.environment.hulls import hull_planes
from polypod.environment.table import is_wet, penetration, surface, surface_normal
from polypod.errors import SceneError
from polypod.math.vec3 import Vec3


def test_stairs_have_vertical_risers_and_level_treads() -> None:
    env = Environment(
        Terrain.stairs(rise=0.1, run=0.3, count=5, start=1.0, landing=2.0)
    ).kernel_table
    for step in range(5):
        riser = 1.0 + 0.3 * step
        assert surface(env, 0.2, riser - 1e-9)[0] == pytest.approx(0.1 * step)
        assert surface(env, 0.2, riser + 1e-9)[0] == pytest.approx(0.1 * (step + 1))
        assert surface_normal(env, 0.2, riser + 0.1) == pytest.approx((0, 1, 0))
        # A foot inside a tread is as deep as it is far from the riser's face.
        inside = Vec3(0.2, 0.1 * step + 0.05, riser + 0.02)
        assert penetration(env, inside)[0] == pytest.approx(0.02)
        assert penetration(env, inside._replace(z=riser - 0.02))[0] < 0.0
    for z in (2.3, 3.0, 4.1, 4.3, 100.0):
        assert surface(env, 0.0, z)[0] == pytest.approx(0.5)


def test_stairs_lead_down_again() -> None:
    terrain = Terrain.stairs(rise=0.1, run=0.3, count=4, start=1.0, landing=2.0, down=True)
    env = Environment(terrain).kernel_table
    middle = 1.0 + 3 * 0.3 + 1.0
    for off in (0.5, 1.05, 1.35, 1.65, 1.95, 3.0):
        assert surface(env, 0.0, middle + off)[0] == pytest.approx(
            surface(env, 0.0, middle - off)[0]
        )
    assert surface(env, 0.0, middle)[0] == pytest.approx(0.4)
    assert surface(env, 0.0, middle + 1.95)[0] == 0.0


def test_trenches_have_vertical_sides_and_ground_between() -> None:
    terrain = Terrain.trenches(
        seed=4, narrowest=0.1, widest=0.3, apart=0.8, depth=1.5, count=6, width=4.0, start=2.0
    )
    env = Environment(terrain).kernel_table
    edges = [(p.position[2] - 0.5 * p.size[2], p.position[2] + 0.5 * p.size[2])
             for p in terrain.parts]  # fmt: skip
    assert len(edges) == 7
    assert edges[0][1] == pytest.approx(2.0)
    for (_, begins), (ends, _) in pairwise(edges):
        assert 0.1 <= ends - begins <= 0.3
        for z in (begins + 1e-9, 0.5 * (begins + ends), ends - 1e-9):
            assert surface(env, 1.0, z)[0] == pytest.approx(-1.5)
        assert surface(env, 1.0, begins - 1e-9)[0] == pytest.approx(0.0)
        assert surface(env, 1.0, ends + 1e-9)[0] == pytest.approx(0.0)
    for begins, ends in edges[1:-1]:
        assert 0.4 <= ends - begins <= 0.8
    # The ground before and behind them is level for ever, whatever the side.
    for x in (0.0, 1.9):
        for z in (-50.0, 0.0, edges[-1][0] + 0.01, edges[-1][1] + 0.01, 80.0):
            assert surface(env, x, z)[0] == pytest.approx(0.0)


def test_hills_have_their_relief_and_are_smooth() -> None:
    terrain = Terrain.hills(seed=5, relief=0.7, wavelength=2.0, size=20.0)
    assert np.ptp(terrain.heights) == pytest.approx(0.7)
    assert terrain.origin == (-10.0, -10.0)
    bend = np.diff(terrain.heights, n=2, axis=0) / terrain.cell**2
    # Each wave of amplitude a and number k bends at most a k^2; all of them together have relief.
    assert np.max(np.abs(bend)) < 0.7 * (4.0 * math.pi / 2.0) ** 2
    assert np.array_equal(
        terrain.heights, Terrain.hills(seed=5, relief=0.7, wavelength=2.0, size=20.0).heights
    )
    assert not np.array_equal(
        terrain.heights, Terrain.hills(seed=6, relief=0.7, wavelength=2.0, size=20.0).heights
    )


@pytest.mark.parametrize("scale", [0.006, 1.0, 18.0])
def test_generators_scale_with_the_creature(scale: float) -> None:
    for made, larger in (
        (Terrain.hills(seed=1, relief=0.3, wavelength=1, size=8),
         Terrain.hills(seed=1, relief=0.3 * scale, wavelength=scale, size=8 * scale)),
        (Terrain.rocks(seed=1, diameter=0.4, height=0.1, size=4),
         Terrain.rocks(seed=1, diameter=0.4 * scale, height=0.1 * scale, size=4 * scale)),
    ):  # fmt: skip
        assert larger.heights.shape == made.heights.shape
        assert np.allclose(larger.heights, scale * made.heights, atol=1e-9 * scale)
        assert larger.cell == pytest.approx(scale * made.cell)


def test_rocks_stay_below_their_height() -> None:
    heights = Terrain.rocks(seed=2, diameter=0.5, height=0.1, share=0.4, size=8.0).heights
    assert heights.min() == 0.0
    assert 0.08 < heights.max() <= 0.1
    assert 0.15 < np.mean(heights > 1e-6) < 0.4


def test_steps_have_random_level_tops() -> None:
    terrain = Terrain.steps(seed=3, rise=0.1, run=0.5, size=3.0, start=0.0)
    env = Environment(terrain).kernel_table
    tops = [surface(env, 0.5 * i - 1.25, 0.5 * j + 0.25)[0] for i in range(6) for j in range(6)]
    assert len(terrain.parts) == 36
    assert len(set(tops)) == 36
    assert 0.0 <= min(tops) < 0.03
    assert 0.07 < max(tops) <= 0.1


def test_parts_of_the_terrain_come_after_the_obstacles() -> None:
    crate = Obstacle.box((0.1, 0.1, 0.1), (0.0, 0.05, 0.0))
    place = Environment(Terrain.stairs(start=1.0, run=0.3), [crate])
    assert place.obstacles[0] is crate
    assert surface(place.kernel_table, 0.0, 0.0)[1] == 0
    assert surface(place.kernel_table, 0.0, 1.1)[1] == 1
    assert place.table is place.table


@pytest.mark.parametrize(
    ("heights", "cell", "origin", "words"),
    [
        (np.zeros((0, 2)), 1.0, (0, 0), "shape"),
        (np.zeros(3), 1.0, (0, 0), "shape"),
        (np.array([[0.0, np.nan]]), 1.0, (0, 0), "no number"),
        (np.array([[0.0, 1e9]]), 1.0, (0, 0), "within"),
        (np.zeros((2, 2)), 0.0, (0, 0), "cell"),
        (np.zeros((2, 2)), -1.0, (0, 0), "cell"),
        (np.zeros((2, 2)), math.nan, (0, 0), "cell"),
        (np.zeros((2, 2)), 1.0, (math.inf, 0), "origin"),
        (np.zeros((2, 2)), 1.0, (0,), "origin"),
        ([["a"]], 1.0, (0, 0), "numbers"),
        (np.broadcast_to(0.0, (10_000, 10_000)), 1.0, (0, 0), "too large"),
    ],
)
def test_impossible_terrain_is_refused(heights: Any, cell: float, origin: Any, words: str) -> None:
    with pytest.raises(SceneError, match=words):
        Terrain(heights, cell, origin)


def test_a_terrain_of_one_sample_is_level() -> None:
    env = Environment(Terrain(np.array([[0.4]]), 0.1, water=np.array([[True]]))).kernel_table
    assert surface(env, 3.0, -5.0) == (0.4, -1)
    assert is_wet(env, 3.0, -5.0)


def test_a_mask_must_fit(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"mask of 2 x 3 .* 2 x 2"):
        Terrain(np.zeros((2, 2)), 1.0, water=np.zeros((2, 3), np.bool_))
    with pytest.raises(SceneError, match=r"hill.*no key 'heigth'"):
        Terrain.hills(seed=1, heigth=2.0)


def test_scattered_crates_stand_on_the_lowest_ground_under_them() -> None:
    terrain = Terrain.hills(seed=8, relief=1.0, wavelength=2.0, size=10.0)
    area = (-2.0, -1.0, 2.0, 3.0)
    crates = scatter(terrain, 30, area, [[0.1, 0.1, 0.1], [0.6, 0.4, 0.6]], 11, 0.3)
    assert sum(crate.forbidden for crate in crates) == 9
    assert len({crate.name for crate in crates}) == 30
    random = np.random.default_rng(0)
    for crate in crates:
        bottom = crate.position[1] - 0.5 * crate.size[1]
        weight = random.dirichlet(np.full(4, 0.3), 3000)
        under = terrain.heights_at(weight @ crate.footprint())
        assert bottom <= under.min() + 1e-9
        assert bottom >= under.min() - 0.01
        assert -2 <= crate.position[0] <= 2
        assert -1 <= crate.position[2] <= 3
        assert all(s >= 0.1 for s in crate.size)
    again = scatter(terrain, 30, area, [[0.1, 0.1, 0.1], [0.6, 0.4, 0.6]], 11, 0.3)
    assert crates == again


@pytest.mark.parametrize(
    "keys",
    [
        {"count": -1},
        {"area": (1, 0, 0, 1)},
        {"area": (0, 0, math.inf, 1)},
        {"area": (math.nan, 0, 1, 1)},
        {"size": [[1, 1, 1], [0, 1, 1]]},
        {"size": [[0, 0, 0], [1, 1, 1]]},
        {"forbidden_share": 1.5},
    ],
)
def test_an_impossible_scatter_is_refused(keys: dict[str, Any]) -> None:
    usual: dict[str, Any] = {"count": 1, "area": (0, 0, 1, 1), "size": [[1] * 3, [1] * 3]}
    with pytest.raises(SceneError, match="scatter"):
        scatter(Terrain.flat(), seed=0, **(usual | keys))


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10_000), count=st.integers(4, 24))
def test_a_hull_holds_its_points_and_touches_them(seed: int, count: int) -> None:
    points = np.random.default_rng(seed).normal(size=(count, 3))
    planes = hull_planes(points)
    height = points @ planes[:, :3].T - planes[:, 3]
    assert np.all(height < 1e-8)
    assert np.all(np.count_nonzero(height > -1e-8, axis=0) >= 3)
    # Euler: a hull with V corners in general position has 2 V - 4 triangles.
    corners = np.count_nonzero(np.any(height > -1e-8, axis=1))
    assert len(planes) == 2 * corners - 4


def test_the_hull_of_a_cube_has_six_planes() -> None:
    cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 2) for z in (0, 3.0)])
    assert len(hull_planes(cube)) == 6
    assert len(hull_planes(np.concatenate([cube, cube * 0.5]))) == 6


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 10_000), count=st.integers(3, 40))
def test_a_polygon_turns_one_way_around_its_points(seed: int, count: int) -> None:
    points: NDArray[np.float64] = np.random.default_rng(seed).normal(size=(count, 2))
    corners = polygon_around(points)
    sides = polygon_sides(corners)
    height = points @ sides[:, :2].T - sides[:, 2]
    assert np.all(height <= 1e-9)
    assert np.all(np.count_nonzero(np.abs(height) < 1e-9, axis=0) >= 2)


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: Obstacle.box((1, 1), (0, 0, 0)), "three numbers"),
        (lambda: Obstacle.box((1, 1, math.nan), (0, 0, 0)), "size"),
        (lambda: Obstacle.box((1, 1, 1), (0, math.inf, 0)), "position"),
        (lambda: Obstacle.box((1, 1, 1), (0, 0, 0), math.nan), "rotation"),
        (lambda: Obstacle("cone", (1, 1, 1), (0, 0, 0)), "box, cylinder, sphere, hull"),
        (lambda: Obstacle("cylinder", (1, 1, 2), (0, 0, 0)), "equal"),
        (lambda: Obstacle("sphere", (1, 1, 2), (0, 0, 0)), "equal"),
        (lambda: Obstacle.hull([[0, 0, 0]] * 5, (0, 0, 0)), "plane"),
        (lambda: Obstacle.hull([[0, 0, 0]] * 99, (0, 0, 0)), "points"),
        (lambda: Obstacle.hull([[math.nan, 0, 0]] * 5, (0, 0, 0)), "within"),
    ],
)
def test_impossible_obstacles_are_refused(build: Any, words: str) -> None:
    with pytest.raises(SceneError, match=words):
        build()
