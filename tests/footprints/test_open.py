"""Open ground: what counts as open, and steps past other legs that know no grid."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from stepping import LEG, SCRATCH, ask, plan
from test_plan import ORIGIN, turned

from polypod.environment import Environment, Obstacle
from polypod.footprints.beside import is_open
from polypod.footprints.scratch import TALLY_CANDIDATES
from polypod.math.vec3 import Vec3, store_vec3

OPEN = Environment().kernel_table
WANTED = Vec3(0.013, 0.0, 0.2417)
# A leg across the way, that is gone around.
FENCE = ((-0.1, 0.06), (0.3, 0.1))


def fenced(place, request):
    """Return the request with another leg's segment across the way."""
    for end, rows in zip(FENCE, (SCRATCH.other_a, SCRATCH.other_b), strict=True):
        store_vec3(rows[0], place(Vec3(end[0], 0.0, end[1])))
    SCRATCH.other_radius[0] = 0.01 * LEG
    return request._replace(other_foot_count=1)


@given(
    heading=st.floats(-3.0, 3.0),
    x=st.floats(-50.0, 50.0),
    z=st.floats(-50.0, 50.0),
    mirror=st.booleans(),
)
@settings(max_examples=40, deadline=None)
def test_a_way_around_a_leg_knows_no_grid(heading, x, z, mirror):
    request = ask(OPEN, ORIGIN, WANTED, foot_yaw=0.2)
    found, score, path = plan(OPEN, fenced(lambda point: point, request))
    assert found
    assert SCRATCH.tally[TALLY_CANDIDATES] > 0  # it took the grid
    moved, place = turned(request, heading, Vec3(x, 0.0, z), mirror)
    _, moved_score, moved_path = plan(OPEN, fenced(place, moved))
    assert moved_score == pytest.approx(score, abs=1e-9)
    expected = np.array([place(Vec3(*point)) for point in path.point])
    assert np.abs(moved_path.point - expected).max() < 1e-9


@pytest.mark.parametrize("angle", [k * math.pi / 6.0 for k in range(12)])
@pytest.mark.parametrize("away", [(30.0, -20.0), (-3.0, 70.0)])
def test_a_crate_anywhere_near_is_not_open(angle, away):
    request, _ = turned(ask(OPEN, ORIGIN, WANTED), 0.3, Vec3(away[0], 0.0, away[1]))
    near = SCRATCH.lift.near
    reach = request.search_radius + math.hypot(WANTED.x, WANTED.z)

    def beside(distance):
        x = request.preferred_world.x + distance * math.sin(angle)
        z = request.preferred_world.z + distance * math.cos(angle)
        return Environment(obstacles=[Obstacle.box((0.02, 0.1, 0.02), (x, 0.05, z))]).kernel_table

    assert not is_open(beside(0.5 * reach), request, near)
    assert not is_open(beside(reach), request, near)
    assert is_open(beside(3.0 * (reach + LEG)), request, near)
