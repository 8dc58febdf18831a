"""Where a foot is let stand, its whole shape is borne: held against dense samples of the shapes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.environment import Environment, Obstacle, Terrain
from polypod.environment.table import surface
from polypod.footprints.bearing import is_borne
from polypod.footprints.evenness import even_score, lay_tread
from polypod.footprints.place import is_foot_wet
from polypod.footprints.relief import terrain_spread
from polypod.footprints.scratch import ground_scratch
from polypod.footprints.settings import PlanSettings, placed_shape
from polypod.math.vec3 import Vec3
from polypod.paths.near import obstacles_near
from polypod.reference import by_reference
from polypod.report.ground import Ground

LEG = 0.5
PLAN = PlanSettings()
SCRATCH = ground_scratch()
KERNEL_SCRATCH = by_reference(SCRATCH)
FLAT = Terrain.flat()


def shape(half_x, half_z, yaw):
    return placed_shape(half_x, half_z, 0.0, yaw)


def stand(env, foot, x, z, leg=LEG):
    """Return the tread at a place, whether eight samples allow it, and whether it is borne."""
    env = by_reference(env)
    height, _ = surface(env, x, z)
    tread, rough = lay_tread(env, PLAN, foot, leg, Vec3(x, height, z), 0.0)
    even = even_score(env, tread, rough, PLAN.slope) >= 0.0
    wide = 2.0 * (foot.radius + PLAN.toe * leg)
    count = obstacles_near(env, x - wide, z - wide, x + wide, z + wide, -1e300, SCRATCH.near)
    return tread, even, is_borne(env, tread, count, KERNEL_SCRATCH)


def gaps(env, tread, grow, count=41):
    """Return places [N, 2] over the foot's shape grown by metres, and how far each is above."""
    a, b = np.meshgrid(
        np.linspace(-1.0, 1.0, count) * (tread.half_a + grow),
        np.linspace(-1.0, 1.0, count) * (tread.half_b + grow),
    )
    a, b = a.ravel(), b.ravel()
    x = tread.x + a * tread.cosine + b * tread.sine
    z = tread.z - a * tread.sine + b * tread.cosine
    above = Ground(env).surface(x, z) - tread.y - tread.slope_a * a - tread.slope_b * b
    return np.stack([a, b], axis=1), above


def ring(inner, outer, height, at, sectors=8):
    """Return a flat ring as a mesh of convex sectors, its middle at a place [2]."""
    angle = 2.0 * math.pi * np.arange(sectors + 1) / sectors
    parts = [
        tuple(
            (radius * math.cos(a), y, radius * math.sin(a))
            for a in angle[i : i + 2].tolist()
            for radius in (inner, outer)
            for y in (-0.5 * height, 0.5 * height)
        )
        for i in range(sectors)
    ]
    size = (2.0 * outer, height, 2.0 * outer)
    return Obstacle("mesh", size, (at[0], 0.5 * height, at[1]), parts=tuple(parts))


def place_of(kind, seed):
    """Return a place a foot has trouble with, about the origin."""
    random = np.random.default_rng(seed)
    made = []
    terrain = FLAT
    if kind == "posts":
        for _ in range(12):
            width, height = random.uniform(0.001, 0.02), random.uniform(0.005, 0.05)
            at = random.uniform(-0.08, 0.08, 2)
            made.append(
                Obstacle.box(
                    (width, height, width), (at[0], 0.5 * height, at[1]), random.uniform(0.0, 3.0)
                )
            )
    elif kind == "tiles":
        size, gap = random.uniform(0.03, 0.12), random.uniform(0.0, 0.02)
        for i in range(-2, 3):
            for j in range(-2, 3):
                middle = (i * (size + gap), 0.1 + random.uniform(0.0, 0.004), j * (size + gap))
                made.append(Obstacle.box((size, 0.2, size), middle))
    elif kind == "balls":
        for _ in range(8):
            at = random.uniform(-0.1, 0.1, 2)
            made.append(Obstacle.sphere(random.uniform(0.02, 0.6), (at[0], 0.0, at[1])))
    elif kind == "drums":
        for _ in range(6):
            at = random.uniform(-0.1, 0.1, 2)
            q = random.normal(size=4) if random.random() < 0.5 else np.array([0.0, 0.0, 0.0, 1.0])
            made.append(
                Obstacle.cylinder(
                    random.uniform(0.02, 0.3), 0.1, (at[0], 0.05, at[1]), q / np.linalg.norm(q)
                )
            )
    elif kind == "rings":
        # Holes that some feet fit into and some do not, of sectors that meet at their seams.
        for at in random.uniform(-0.06, 0.06, (2, 2)):
            inner, height = random.uniform(0.01, 0.08), random.uniform(0.005, 0.05)
            made.append(ring(inner, inner + random.uniform(0.01, 0.1), height, at))
    elif kind == "hulls":
        for _ in range(6):
            at = random.uniform(-0.1, 0.1, 2)
            points = random.uniform(-0.12, 0.12, (9, 3))
            made.append(Obstacle.hull(points, (at[0], random.uniform(-0.05, 0.05), at[1])))
    else:
        cell = random.uniform(0.005, 0.1)
        heights = random.uniform(0.0, 0.02, (40, 40)) * (random.random((40, 40)) < 0.3)
        terrain = Terrain(heights, cell, (-20.0 * cell, -20.0 * cell))
    return Environment(terrain, made).table, random


KINDS = ("posts", "tiles", "balls", "drums", "rings", "hulls", "bumps")


@pytest.mark.parametrize("kind", KINDS)
def test_all_of_an_accepted_foot_is_borne(kind):
    """And the samples alone would have been fooled: the exact test is what refuses."""
    accepted = fooled = 0
    for seed in range(200):
        env, random = place_of(kind, seed)
        half = random.uniform(0.005, 0.05, 2)
        foot = shape(half[0], half[1], random.uniform(-3.0, 3.0))
        x, z = random.uniform(-0.05, 0.05, 2)
        tread, even, borne = stand(env, foot, x, z)
        if not (even and borne):
            fooled += even and not borne
            continue
        accepted += 1
        places, above = gaps(env, tread, 0.0)
        assert above.max() <= tread.tolerance + 1e-9
        held = above >= -tread.tolerance - 1e-9
        inner = np.all(np.abs(places) <= np.array(half) + 1e-12, axis=1)
        spacing = 2.0 * max(tread.half_a, tread.half_b) / 40
        for place in places[inner & ~held]:
            # In a crack at most as wide as the tread may span.
            away = np.linalg.norm(places[held] - place, axis=1).min()
            assert away <= 1.5 * tread.gap + 1.5 * spacing
    assert accepted >= 5
    assert fooled >= 1


@given(seed=st.integers(0, 100_000), kind=st.sampled_from(["posts", "tiles", "bumps"]))
@settings(max_examples=150, deadline=None)
def test_what_is_even_and_whole_is_borne(seed, kind):
    env, random = place_of(kind, seed)
    half = random.uniform(0.005, 0.05, 2)
    foot = shape(half[0], half[1], random.uniform(-3.0, 3.0))
    x, z = random.uniform(-0.05, 0.05, 2)
    tread, _, borne = stand(env, foot, x, z)
    _, above = gaps(env, tread, 0.004, 81)
    if np.abs(above).max() < 0.8 * tread.tolerance:
        assert borne


@given(
    seed=st.integers(0, 100_000),
    x=st.floats(-3.0, 3.0),
    z=st.floats(-3.0, 3.0),
    yaw=st.floats(-3.0, 3.0),
    cell=st.floats(0.01, 1.0),
)
@settings(max_examples=100, deadline=None)
def test_the_terrain_under_a_foot_is_bounded_exactly(seed, x, z, yaw, cell):
    random = np.random.default_rng(seed)
    terrain = Terrain(random.uniform(-0.2, 0.2, (9, 7)), cell, (-3.0 * cell, -4.0 * cell))
    env = Environment(terrain).table
    foot = shape(*random.uniform(0.01, 0.2, 2), yaw)
    tread, _, _ = stand(env, foot, x, z)
    least, most = terrain_spread(by_reference(env), tread)
    _, above = gaps(env, tread, 0.0, 61)
    assert above.min() >= least - 1e-9
    assert above.max() <= most + 1e-9
    # And no wider than it must: dense samples come near both.
    slack = 0.1 * (most - least) + 0.05 * (tread.half_a + tread.half_b) / cell
    assert above.min() <= least + slack
    assert above.max() >= most - slack


def test_a_post_between_the_samples_is_seen():
    post = Obstacle.box((0.004, 0.08, 0.004), (0.021, 0.0, 0.012))
    env = Environment(FLAT, [post]).table
    foot = shape(0.04, 0.04, 0.0)
    _, even, borne = stand(env, foot, 0.0, 0.0)
    assert even
    assert not borne
    assert stand(env, foot, 0.2, 0.0)[2]


@pytest.mark.parametrize(("width", "borne"), [(0.008, True), (0.012, False), (0.03, False)])
def test_a_crack_may_be_spanned_and_a_slot_may_not(width, borne):
    # The tread spans gaps as wide as the toe by which the shape is grown: 0.01 m.
    boards = [
        Obstacle.box((0.3, 0.2, 1.0), (side * (0.15 + 0.5 * width), 0.1, 0.0)) for side in (-1, 1)
    ]
    env = Environment(FLAT, boards).table
    for x in (0.012, 0.016):
        assert stand(env, shape(0.04, 0.04, 0.0), x, 0.0)[2] == borne


@pytest.mark.parametrize("yaw", [0.0, 0.5])
def test_a_foot_stands_in_a_hole_only_where_it_fits(yaw):
    walls = [
        Obstacle.box((0.4, 0.2, 0.1), (0.0, 0.1, 0.12)),
        Obstacle.box((0.4, 0.2, 0.1), (0.0, 0.1, -0.12)),
        Obstacle.box((0.1, 0.2, 0.4), (0.12, 0.1, 0.0)),
        Obstacle.box((0.1, 0.2, 0.4), (-0.12, 0.1, 0.0)),
    ]
    env = Environment(FLAT, walls).table
    # The hole is 0.14 wide; the shape is grown by 0.01 m.
    room = 0.07 / (math.cos(yaw) + math.sin(yaw)) - 0.01
    assert stand(env, shape(0.98 * room, 0.98 * room, yaw), 0.0, 0.0)[2]
    assert not stand(env, shape(1.02 * room, 1.02 * room, yaw), 0.0, 0.0)[2]
    # Nor partly over the rim.
    assert not stand(env, shape(0.03, 0.03, yaw), 0.06, 0.0)[2]
    assert stand(env, shape(0.03, 0.03, yaw), 0.12, 0.0)[2]


def test_a_corner_over_forbidden_ground_is_no_place():
    post = Obstacle.box((0.05, 0.001, 0.05), (0.07, 0.0, 0.07), forbidden=True)
    env = Environment(FLAT, [post]).table
    assert not stand(env, shape(0.04, 0.04, 0.0), 0.0, 0.0)[2]
    assert stand(env, shape(0.03, 0.03, 0.0), 0.0, 0.0)[2]


@given(yaw=st.floats(-3.0, 3.0), x=st.floats(-0.4, 0.4), z=st.floats(-0.4, 0.4))
@settings(max_examples=100, deadline=None)
def test_no_part_of_a_foot_is_in_a_puddle(yaw, x, z):
    water = np.zeros((21, 21), np.bool_)
    water[10, 10] = True
    env = Environment(Terrain(np.zeros((21, 21)), 0.05, (-0.5, -0.5), water)).table
    foot = shape(0.12, 0.06, yaw)
    a, b = np.meshgrid(np.linspace(-0.12, 0.12, 61), np.linspace(-0.06, 0.06, 61))
    off_x = x + a * foot.cosine + b * foot.sine
    off_z = z - a * foot.sine + b * foot.cosine
    sampled = bool(np.any((np.abs(off_x) < 0.025) & (np.abs(off_z) < 0.025)))
    if sampled:
        assert is_foot_wet(by_reference(env), foot, x, z)
    elif not np.any((np.abs(off_x) < 0.03) & (np.abs(off_z) < 0.03)):
        assert not is_foot_wet(by_reference(env), foot, x, z)
