"""The audit's geometry, in closed form and against the planner's kernels, which it must not use."""

from __future__ import annotations

import math

import numpy as np
import pytest

from polypod.environment import table as kernels
from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.environment.terrain import Terrain
from polypod.math.vec3 import Vec3
from polypod.report.ground import Ground

TILTED = (math.sin(0.3), 0.0, 0.0, math.cos(0.3))  # about x by 0.6 rad
LYING = (0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4))


def one(obstacle, terrain=None):
    return Ground(Environment(terrain, [obstacle]).table)


def heights(ground, *places):
    x, z = np.array(places, float).T
    return ground.surface(x, z)


def test_box_top_and_depth():
    ground = one(Obstacle.box((2.0, 1.0, 4.0), (0.0, 0.5, 0.0)))
    assert heights(ground, (0.9, 1.9), (1.1, 0.0)) == pytest.approx([1.0, 0.0])
    points = np.array([[0.9, 0.5, 0.0], [0.0, 0.7, 0.0], [0.0, 1.1, 0.0], [3.0, -0.2, 0.0]])
    # To the nearest face: the side in x, the top; outside; the ground is 0.2 above the last.
    assert ground.penetration(points) == pytest.approx([0.1, 0.3, 0.0, 0.2])


def test_sphere_is_a_circle_in_every_section():
    """Height c + sqrt(r^2 - d^2), depth r - distance."""
    ground = one(Obstacle.sphere(2.0, (0.0, 1.0, 0.0)))
    assert heights(ground, (0.6, 0.0)) == pytest.approx([1.0 + 0.8])
    assert ground.penetration(np.array([[0.3, 1.4, 0.0]])) == pytest.approx([0.5])


def test_lying_cylinder_is_round_from_the_side():
    """Along x with radius 1/2: over z = 0.3 its top is c + sqrt(r^2 - z^2) = c + 0.4."""
    ground = one(Obstacle.cylinder(1.0, 4.0, (0.0, 0.5, 0.0), LYING))
    assert heights(ground, (1.9, 0.3), (2.1, 0.0)) == pytest.approx([0.9, 0.0])


def test_terrain_is_bilinear_and_level_beyond_its_edge():
    """Between samples 0, 1, 2, 4 the middle is their mean 7/4."""
    ground = Ground(Environment(Terrain(np.array([[0.0, 1.0], [2.0, 4.0]]), 1.0)).table)
    assert heights(ground, (0.5, 0.5), (1.0, 0.25), (-5.0, 1.0), (9.0, 9.0)) == pytest.approx(
        [1.75, 1.75, 2.0, 4.0]
    )


def test_forbidden_outline_in_plan():
    """A square of side 1 turned by 45 degrees reaches sqrt(1/2) along x and 1/2 along x = z."""
    ground = one(Obstacle.box((1.0, 1.0, 1.0), (0.0, 0.5, 0.0), math.pi / 4, forbidden=True))
    points = np.array([[0.70, 9.0, 0.0], [0.72, 9.0, 0.0], [0.34, 0.0, 0.34], [0.37, 0.0, 0.37]])
    assert ground.over_forbidden(points).tolist() == [True, False, True, False]
    free = one(Obstacle.box((1.0, 1.0, 1.0), (0.0, 0.5, 0.0)))
    assert not free.over_forbidden(points).any()


def scenery(seed):
    """Return a scene of all shapes, turned at random, over hills."""
    random = np.random.default_rng(seed)
    obstacles = []
    for number in range(12):
        place = random.uniform((-2.0, 0.2, -2.0), (2.0, 1.6, 2.0))
        turn = random.normal(size=4)
        turn = turn / np.linalg.norm(turn)
        if number % 4 == 0:
            obstacles.append(Obstacle.sphere(random.uniform(0.2, 0.8), place))
        elif number % 4 == 1:
            obstacles.append(Obstacle.cylinder(random.uniform(0.2, 0.8), 0.5, place, turn))
        elif number % 4 == 2:
            obstacles.append(Obstacle.hull(random.uniform(-0.4, 0.4, (9, 3)), place, turn))
        else:
            obstacles.append(Obstacle.box(random.uniform(0.1, 0.8, 3), place, place[0]))
    return Environment(Terrain.hills(seed=seed), obstacles).table


@pytest.mark.parametrize("seed", range(3))
def test_audit_and_planner_agree_on_the_geometry(seed):
    table = scenery(seed)
    ground = Ground(table)
    random = np.random.default_rng(seed + 100)
    around = [centre + random.uniform(-0.4, 0.4, (25, 3)) for centre in table.position]
    points = np.concatenate([*around, random.uniform((-3, -1, -3), (3, 2, 3), (50, 3))])
    found = ground.surface(points[:, 0], points[:, 2])
    expected = [kernels.surface(table, float(x), float(z))[0] for x, _, z in points]
    assert found == pytest.approx(np.array(expected), abs=1e-9)
    depth = ground.penetration(points)
    compared = 0
    for point, own in zip(points, depth, strict=True):
        planned, support = kernels.penetration(table, Vec3(*map(float, point)))
        # Inside is inside for both; how deep in the terrain is counted differently.
        assert (own > 1e-9) == (planned > 1e-9)
        below = kernels.ground_height(table, float(point[0]), float(point[2])) - point[1]
        if support >= 0 and planned > 0.0 and below <= 0.0:
            assert own == pytest.approx(planned, abs=1e-9)
            compared += 1
    assert compared > 20


def test_tilted_box_is_highest_at_its_upper_edge():
    """A unit cube turned by a about x: half height (cos a + sin a) / 2 over its upper edge."""
    angle = 0.6
    ground = one(Obstacle("box", (1.0, 1.0, 1.0), (0.0, 1.0, 0.0), TILTED))
    # The upper edge at -z, (y, z) = (1/2, -1/2), turned by a about x.
    edge_z = 0.5 * (math.sin(angle) - math.cos(angle))
    other_z = 0.5 * (math.sin(angle) + math.cos(angle))
    top = 1.0 + 0.5 * (math.cos(angle) + math.sin(angle))
    assert heights(ground, (0.0, edge_z))[0] == pytest.approx(top, abs=1e-6)
    assert heights(ground, (0.0, edge_z + 0.1))[0] < top
    assert heights(ground, (0.0, other_z + 0.01))[0] == 0.0
