"""Straight motions of a sole against sampling of the true shapes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from polypod.environment import Environment, Obstacle, Terrain
from polypod.environment.sweep import segment_clear
from polypod.environment.table import ground_height, is_forbidden, penetration
from polypod.math.vec3 import Vec3

BOX = Obstacle.box((1.0, 0.5, 1.0), (0.0, 0.25, 0.0))


def test_beside_over_and_through_a_box() -> None:
    env = Environment(Terrain.flat(), [BOX]).table
    assert not segment_clear(env, Vec3(-1.0, 0.2, 0.0), Vec3(1.0, 0.2, 0.0), 0.0)
    assert segment_clear(env, Vec3(-1.0, 0.51, 0.0), Vec3(1.0, 0.51, 0.0), 0.3)
    assert segment_clear(env, Vec3(-1.0, 0.2, 0.6), Vec3(1.0, 0.2, 0.6), 0.09)
    assert not segment_clear(env, Vec3(-1.0, 0.2, 0.6), Vec3(1.0, 0.2, 0.6), 0.11)
    # Standing on it and on the ground beside it is touching, not being inside.
    assert segment_clear(env, Vec3(0.0, 0.5, 0.0), Vec3(0.3, 0.5, 0.2), 0.1)
    assert segment_clear(env, Vec3(0.6, 0.0, 0.0), Vec3(0.6, 0.0, 0.4), 0.1)
    assert not segment_clear(env, Vec3(0.6, 0.0, 0.0), Vec3(0.6, -0.01, 0.4), 0.1)
    assert not segment_clear(env, Vec3(0.3, 0.5, 0.0), Vec3(0.6, 0.3, 0.0), 0.1)


def test_nothing_passes_over_the_forbidden() -> None:
    forbidden = Obstacle.box((1.0, 0.5, 1.0), (0.0, 0.25, 0.0), forbidden=True)
    env = Environment(Terrain.flat(), [forbidden]).table
    assert not segment_clear(env, Vec3(-1.0, 9.0, 0.0), Vec3(1.0, 9.0, 0.0), 0.0)
    assert segment_clear(env, Vec3(-1.0, 9.0, 0.7), Vec3(1.0, 9.0, 0.7), 0.1)


def test_a_ball_is_exact() -> None:
    env = Environment(Terrain.flat(), [Obstacle.sphere(2.0, (0.0, 1.0, 0.0))]).table
    # At height 1.6 its cut has the radius 0.8.
    assert segment_clear(env, Vec3(-2.0, 1.6, 0.91), Vec3(2.0, 1.6, 0.91), 0.1)
    assert not segment_clear(env, Vec3(-2.0, 1.6, 0.89), Vec3(2.0, 1.6, 0.89), 0.1)
    assert segment_clear(env, Vec3(-2.0, 2.001, 0.0), Vec3(2.0, 2.001, 0.0), 0.5)


def test_a_ridge_between_two_low_ends_is_found() -> None:
    heights = np.array([[0.0, 0.0], [1.0, 1.0], [0.0, 0.0]])
    env = Environment(Terrain(heights, 1.0)).table
    start, end = Vec3(0.5, 0.6, 0.0), Vec3(0.5, 0.6, 2.0)
    assert not segment_clear(env, start, end, 0.0)
    assert segment_clear(env, start._replace(y=1.0), end._replace(y=1.0), 0.0)
    assert segment_clear(env, Vec3(0.5, 0.4, 0.2), Vec3(0.5, 1.2, 0.9), 0.0)


places = st.tuples(st.floats(-1.5, 1.5), st.floats(-0.1, 0.9), st.floats(-1.5, 1.5))


@settings(max_examples=150, deadline=None)
@given(start=places, end=places, seed=st.integers(0, 50), radius=st.sampled_from([0.0, 0.05]))
def test_the_segment_agrees_with_samples(
    start: tuple[float, float, float], end: tuple[float, float, float], seed: int, radius: float
) -> None:
    random = np.random.default_rng(seed)
    obstacles = []
    for _ in range(3):
        size = random.uniform(0.2, 0.8, 3)
        place = random.uniform((-1, 0, -1), (1, 0.4, 1))
        obstacles.append(
            Obstacle.box(size, place, random.uniform(0, 6), bool(random.random() < 0.3))
        )
    obstacles.append(Obstacle.sphere(0.5, random.uniform((-1, 0, -1), (1, 0.4, 1))))
    obstacles.append(Obstacle.cylinder(0.4, 0.6, random.uniform((-1, 0, -1), (1, 0.4, 1))))
    env = Environment(Terrain.hills(seed, relief=0.3, wavelength=1.0, size=4.0), obstacles).table
    deepest = -math.inf
    crossed = False
    rim = [(radius * math.cos(a), radius * math.sin(a)) for a in np.linspace(0, 6.28, 8)]
    a, b = np.array(start), np.array(end)
    for t in np.linspace(0.0, 1.0, 60):
        x, y, z = a + (b - a) * t
        deepest = max(deepest, ground_height(env, x, z) - y)
        crossed = crossed or is_forbidden(env, x, z, 0.9 * radius)
        for off_x, off_z in rim if radius > 0.0 else [(0.0, 0.0)]:
            depth, support = penetration(env, Vec3(x + off_x, y, z + off_z))
            deepest = max(deepest, depth if support >= 0 else -math.inf)
    clear = segment_clear(env, Vec3(*start), Vec3(*end), radius)
    if deepest > 1e-5 or crossed:
        assert not clear
    assume(not clear)
    # Not overcautious: what is refused is inside, or nearly so, somewhere along the way.
    fine = np.linspace(0.0, 1.0, 400)
    nearest = -math.inf
    for t in fine:
        x, y, z = a + (b - a) * t
        nearest = max(nearest, ground_height(env, x, z) - y, penetration(env, Vec3(x, y, z))[0])
        if is_forbidden(env, x, z, 1.5 * radius + 0.01):
            nearest = 0.0
    assert nearest > -(2.0 * radius + 0.02)


@pytest.mark.parametrize("offset", [0.0, 1e-13, -1e-13])
def test_a_segment_along_a_sample_line_ends(offset: float) -> None:
    heights = np.random.default_rng(0).uniform(0, 1, (30, 30))
    env = Environment(Terrain(heights, 0.1)).table
    start, end = Vec3(1.0 + offset, 0.5, -1.0), Vec3(1.0 + offset, 0.5, 4.0)
    assert not segment_clear(env, start, end, 0.0)
    highest = float(heights[:, 9:12].max())
    assert segment_clear(env, start._replace(y=highest), end._replace(y=highest), 0.0)
