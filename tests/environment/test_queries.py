"""Exact queries against closed forms, sampling, and the invariances that geometry has."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from polypod.environment import Environment, Obstacle, Terrain, scatter
from polypod.environment.convex import rotation_matrix
from polypod.environment.shapes import column_of
from polypod.environment.table import (
    GROUND,
    EnvironmentTable,
    ground_height,
    ground_normal,
    is_forbidden,
    is_wet,
    penetration,
    surface,
    surface_normal,
)
from polypod.math.vec3 import Vec3

FloatArray = NDArray[np.float64]
DEEP = Terrain.flat(-50.0)


def table_of(*obstacles: Obstacle, terrain: Terrain = DEEP) -> EnvironmentTable:
    return Environment(terrain, obstacles).kernel_table


def turned(seed: int) -> tuple[float, float, float, float]:
    x, y, z, w = (float(q) for q in np.random.default_rng(seed).normal(size=4))
    size = math.sqrt(x * x + y * y + z * z + w * w)
    return (x / size, y / size, z / size, w / size)


def some_obstacle(shape: str, seed: int) -> Obstacle:
    """A solid of a shape with any turn, near the origin."""
    random = np.random.default_rng(seed)
    x, y, z = random.uniform(0.2, 1.0, 3).tolist()
    place = random.uniform(-0.3, 0.3, 3)
    if shape == "sphere":
        return Obstacle.sphere(x, place)
    if shape == "cylinder":
        return Obstacle.cylinder(x, y, place, turned(seed))
    if shape == "hull":
        return Obstacle.hull(random.uniform(-0.5, 0.5, (12, 3)), place, turned(seed))
    return Obstacle("box", (x, y, z), tuple(place.tolist()), turned(seed))


def inside(obstacle: Obstacle, points: FloatArray) -> NDArray[np.bool_]:
    """Say which points [N, 3] are in a solid, by its own definition."""
    local = (points - np.array(obstacle.position)) @ rotation_matrix(obstacle.rotation)
    half = 0.5 * np.array(obstacle.size)
    if obstacle.shape == "sphere":
        return np.asarray(np.linalg.norm(local, axis=1) <= half[0])
    if obstacle.shape == "cylinder":
        return np.asarray(
            (np.hypot(local[:, 0], local[:, 2]) <= half[0]) & (np.abs(local[:, 1]) <= half[1])
        )
    if obstacle.shape == "hull":
        planes = obstacle.planes()
        return np.asarray(np.all(points @ planes[:, :3].T <= planes[:, 3], axis=1))
    return np.asarray(np.all(np.abs(local) <= half, axis=1))


SHAPES = ("box", "cylinder", "sphere", "hull")
shapes = st.sampled_from(SHAPES)
seeds = st.integers(0, 10_000)
near = st.floats(-0.8, 0.8)


def test_the_ground_is_bilinear() -> None:
    heights = np.array([[0.0, 1.0, 0.5], [2.0, -1.0, 3.0]])
    env = table_of(terrain=Terrain(heights, 0.5, (1.0, -2.0)))
    for row in range(2):
        for column in range(3):
            x, z = 1.0 + 0.5 * column, -2.0 + 0.5 * row
            assert ground_height(env, x, z) == heights[row, column]
    u, v = 0.3, 0.6
    expected = (0.0 * (1 - u) + 1.0 * u) * (1 - v) + (2.0 * (1 - u) - 1.0 * u) * v
    assert ground_height(env, 1.0 + 0.5 * u, -2.0 + 0.5 * v) == pytest.approx(expected)
    assert ground_height(env, -100.0, -100.0) == 0.0
    assert ground_height(env, 100.0, -1.75) == pytest.approx(1.75)
    assert surface(env, 1.2, -1.9) == (ground_height(env, 1.2, -1.9), GROUND)


def test_the_kernel_and_the_terrain_agree() -> None:
    terrain = Terrain.hills(seed=4, size=8.0, wavelength=2.0)
    env = table_of(terrain=terrain)
    points = np.random.default_rng(0).uniform(-6, 6, (200, 2))
    heights = [ground_height(env, x, z) for x, z in points]
    assert np.allclose(heights, terrain.heights_at(points), atol=1e-12)


def test_the_normal_is_at_right_angles_to_the_ground() -> None:
    env = table_of(terrain=Terrain.hills(seed=4, size=8.0, wavelength=2.0))
    step = 1e-6
    for x, z in np.random.default_rng(1).uniform(-3, 3, (100, 2)):
        normal = ground_normal(env, x, z)
        slope_x = (ground_height(env, x + step, z) - ground_height(env, x - step, z)) / (2 * step)
        slope_z = (ground_height(env, x, z + step) - ground_height(env, x, z - step)) / (2 * step)
        expected = np.array([-slope_x, 1.0, -slope_z]) / math.hypot(1.0, slope_x, slope_z)
        assert np.allclose(normal, expected, atol=1e-4)
    assert ground_normal(env, 50.0, 50.0) == (0.0, 1.0, 0.0)


def test_a_slope_has_its_angle() -> None:
    env = table_of(terrain=Terrain.slope(0.35, length=8.0, start=1.0))
    assert ground_height(env, 3.0, 1.0) == 0.0
    assert ground_height(env, -3.0, 4.0) == pytest.approx(3.0 * math.tan(0.35))
    assert ground_normal(env, 0.0, 4.0).y == pytest.approx(math.cos(0.35))
    assert ground_height(env, 0.0, 400.0) == pytest.approx(8.0 * math.tan(0.35))


def test_the_top_of_a_turned_box() -> None:
    env = table_of(Obstacle.box((2.0, 0.4, 1.0), (3.0, 0.2, 5.0), yaw=math.pi / 2))
    assert surface(env, 3.4, 5.9) == (pytest.approx(0.4), 0)
    assert surface(env, 3.6, 5.0) == (-50.0, GROUND)
    assert surface_normal(env, 3.0, 5.0) == pytest.approx((0.0, 1.0, 0.0))
    # A yaw of 90 degrees takes +Z to +X: the corner at half size (1, 0.5) goes to (0.5, -1).
    slanted = table_of(Obstacle.box((2.0, 0.4, 1.0), (0.0, 0.2, 0.0), yaw=0.3))
    edge = np.array([0.0, 0.49])
    x, z = edge[1] * math.sin(0.3), edge[1] * math.cos(0.3)
    assert surface(slanted, x, z)[1] == 0
    assert surface(slanted, 1.03 * x, 1.03 * z)[1] == GROUND


def test_a_plank_is_a_ramp() -> None:
    half = 0.5 * 0.3
    plank = Obstacle("box", (1.0, 0.1, 4.0), (0, 1, 0), (math.sin(half), 0, 0, math.cos(half)))
    env = table_of(plank)
    middle = surface(env, 0.0, 0.0)[0]
    assert middle == pytest.approx(1.0 + 0.05 / math.cos(0.3))
    assert surface(env, 0.2, 1.0)[0] == pytest.approx(middle - math.tan(0.3))
    assert surface_normal(env, 0.2, 1.0) == pytest.approx((0.0, math.cos(0.3), math.sin(0.3)))


def test_a_ball_and_a_pillar() -> None:
    env = table_of(
        Obstacle.sphere(2.0, (0.0, 5.0, 0.0)), Obstacle.cylinder(1.0, 3.0, (4.0, 1.5, 0.0))
    )
    assert surface(env, 0.6, 0.0) == (pytest.approx(5.8), 0)
    assert surface_normal(env, 0.6, 0.0) == pytest.approx((0.6, 0.8, 0.0))
    assert surface(env, 0.8, 0.7)[1] == GROUND
    assert surface(env, 4.3, 0.3) == (pytest.approx(3.0), 1)
    assert surface(env, 4.4, 0.31)[1] == GROUND
    assert penetration(env, Vec3(0.0, 5.5, 0.0)) == (pytest.approx(0.5), 0)
    assert penetration(env, Vec3(4.3, 2.0, 0.0)) == (pytest.approx(0.2), 1)
    assert penetration(env, Vec3(4.0, 2.9, 0.0)) == (pytest.approx(0.1), 1)
    assert penetration(env, Vec3(4.6, 2.0, 0.0))[0] < 0.0


def test_depth_in_a_slope_is_square_to_it() -> None:
    env = table_of(terrain=Terrain.slope(0.5, length=8.0, start=0.0))
    point = Vec3(0.0, 4.0 * math.tan(0.5) - 0.1, 4.0)
    assert penetration(env, point) == (pytest.approx(0.1 * math.cos(0.5)), GROUND)


@settings(max_examples=60, deadline=None)
@given(shape=shapes, seed=seeds, x=near, z=near)
def test_the_column_is_what_sampling_finds(shape: str, seed: int, x: float, z: float) -> None:
    obstacle = some_obstacle(shape, seed)
    y = np.linspace(1.5, -1.5, 30_001)
    hit = inside(obstacle, np.column_stack([np.full_like(y, x), y, np.full_like(y, z)]))
    height, support = surface(table_of(obstacle), x, z)
    if support == GROUND:
        assert np.count_nonzero(hit) <= 1
    elif hit.any():
        assert height == pytest.approx(y[np.argmax(hit)], abs=1.01e-4)
    else:
        # Thinner than the samples are apart: a line through an edge.
        bottom, top = column_of(table_of(obstacle), 0, x, z)
        assert height == top
        assert top - bottom < 1.01e-4


@settings(max_examples=60, deadline=None)
@given(shape=shapes, seed=seeds, x=near, y=near, z=near)
def test_depth_is_the_distance_to_the_surface(
    shape: str, seed: int, x: float, y: float, z: float
) -> None:
    obstacle = some_obstacle(shape, seed)
    depth = penetration(table_of(obstacle), Vec3(x, y, z))[0]
    point = np.array([x, y, z])
    directions = np.random.default_rng(0).normal(size=(4000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    assert bool(inside(obstacle, point[None])[0]) == (depth >= 0.0) or abs(depth) < 1e-9
    if depth > 1e-6:
        # A ball of that radius fits, and one a little larger does not.
        assert inside(obstacle, point + 0.9999 * depth * directions).all()
        assert not inside(obstacle, point + (1.05 * depth + 1e-3) * directions).all()


@settings(max_examples=40, deadline=None)
@given(shape=shapes, seed=seeds, x=near, z=near)
def test_the_normal_leaves_the_solid_at_once(shape: str, seed: int, x: float, z: float) -> None:
    obstacle = some_obstacle(shape, seed)
    env = table_of(obstacle)
    height, support = surface(env, x, z)
    if support == GROUND:
        return
    normal = np.array(surface_normal(env, x, z))
    point = np.array([x, height, z])
    assert np.linalg.norm(normal) == pytest.approx(1.0)
    assert normal[1] > 0.0
    assert not inside(obstacle, (point + 1e-5 * normal)[None])[0]


@settings(max_examples=40, deadline=None)
@given(shape=shapes, seed=seeds, x=near, z=near, yaw=st.floats(-3, 3), shift=st.floats(-20, 20))
def test_moving_and_turning_all_changes_nothing(
    shape: str, seed: int, x: float, z: float, yaw: float, shift: float
) -> None:
    obstacle = some_obstacle(shape, seed)
    cosine, sine = math.cos(yaw), math.sin(yaw)

    def carried(at_x: float, at_z: float) -> tuple[float, float]:
        return at_x * cosine + at_z * sine + shift, -at_x * sine + at_z * cosine - 2.0 * shift

    qx, qy, qz, qw = obstacle.rotation
    hy, hw = math.sin(0.5 * yaw), math.cos(0.5 * yaw)
    rotation = (hw * qx + hy * qz, hw * qy + hy * qw, hw * qz - hy * qx, hw * qw - hy * qy)
    px, pz = carried(obstacle.position[0], obstacle.position[2])
    moved = Obstacle(
        obstacle.shape,
        obstacle.size,
        (px, obstacle.position[1] + 0.25 * shift, pz),
        rotation,
        points=obstacle.points,
    )
    before, after = table_of(obstacle), table_of(moved)
    depth = penetration(before, Vec3(x, obstacle.position[1], z))[0]
    x_moved, z_moved = carried(x, z)
    here = Vec3(x_moved, moved.position[1], z_moved)
    depth_moved, support_moved = penetration(after, here)
    if depth > -1.0 and support_moved != GROUND:
        assert depth_moved == pytest.approx(depth, abs=1e-9)
    if abs(depth) > 1e-6 and surface(before, x, z)[1] == 0 and surface(after, *here[::2])[1] == 0:
        rise = surface(after, x_moved, z_moved)[0] - surface(before, x, z)[0]
        assert rise == pytest.approx(0.25 * shift, abs=1e-5)


def test_buckets_find_what_a_loop_over_all_finds() -> None:
    terrain = Terrain.hills(seed=2, size=16.0)
    crates = scatter(terrain, 300, (-3, -3, 3, 3), [[0.05, 0.05, 0.05], [0.8, 0.5, 0.8]], 5, 0.3)
    env = table_of(*crates, terrain=terrain)
    alone = [table_of(crate, terrain=terrain) for crate in crates]
    for x, z in np.random.default_rng(3).uniform(-3.5, 3.5, (60, 2)):
        heights = [surface(one, x, z)[0] for one in alone]
        assert surface(env, x, z)[0] == max(heights)
        depths = [penetration(one, Vec3(x, max(heights) - 0.1, z))[0] for one in alone]
        assert penetration(env, Vec3(x, max(heights) - 0.1, z))[0] == max(depths)
        for margin in (0.0, 0.2):
            expected = any(is_forbidden(one, x, z, margin) for one in alone)
            assert is_forbidden(env, x, z, margin) == expected


@settings(max_examples=60, deadline=None)
@given(seed=seeds, x=st.floats(-2, 2), z=st.floats(-2, 2), shape=shapes)
def test_the_margin_of_the_forbidden_is_a_distance(
    seed: int, x: float, z: float, shape: str
) -> None:
    obstacle = some_obstacle(shape, seed)
    forbidden = Obstacle(
        obstacle.shape,
        obstacle.size,
        obstacle.position,
        obstacle.rotation,
        forbidden=True,
        points=obstacle.points,
    )
    corners = forbidden.footprint()
    if shape == "sphere":
        distance = math.hypot(x - obstacle.position[0], z - obstacle.position[2])
        distance = max(0.0, distance - 0.5 * obstacle.size[0])
    else:
        ends = np.roll(corners, -1, axis=0)
        share = np.linspace(0, 1, 2001)[:, None, None]
        outline = (corners * (1 - share) + ends * share).reshape(-1, 2)
        distance = float(np.min(np.linalg.norm(outline - [x, z], axis=1)))
        across = (ends - corners)[:, 0] * (z - corners[:, 1])
        across -= (ends - corners)[:, 1] * (x - corners[:, 0])
        distance = 0.0 if np.all(across >= 0) else distance
    env = table_of(forbidden)
    assert is_forbidden(env, x, z, distance + 1e-3)
    if distance > 1e-3:
        assert not is_forbidden(env, x, z, distance - 1e-3)


def test_water_belongs_to_the_nearest_sample() -> None:
    water = np.array([[True, False], [False, False]])
    env = table_of(terrain=Terrain(np.zeros((2, 2)), 1.0, (0.0, 0.0), water))
    assert is_wet(env, 0.4, 0.4)
    assert is_wet(env, -30.0, -3.0)
    assert not is_wet(env, 0.6, 0.4)
    assert not is_wet(table_of(), 0.0, 0.0)
