"""One foot's step: exact on open ground, never inside anything, never over the forbidden."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from stepping import LEG, SCRATCH, SETTINGS, STRIDE, ask, audit, crates, plan, sample, walk

from polypod.environment import Environment, Obstacle, Terrain, scatter
from polypod.environment.table import is_forbidden, is_wet, surface
from polypod.environment.terrain import generated
from polypod.footprints.scratch import TALLY_DIRECT, TALLY_PATHS
from polypod.math.quat import from_heading, rotate
from polypod.math.vec3 import Vec3, store_vec3

OPEN = Environment().kernel_table
ORIGIN = Vec3(0.0, 0.0, 0.0)


def turned(request, heading, shift, mirror=False):
    """Return the request moved over the plan: mirrored in x, turned, then shifted."""
    turn = from_heading(heading)
    flip = -1.0 if mirror else 1.0

    def place(v):
        return rotate(turn, Vec3(v.x * flip, v.y, v.z)) + shift

    def arrow(v):
        return rotate(turn, Vec3(v.x * flip, v.y, v.z))

    points = (
        "start_world",
        "preferred_world",
        "hip_start",
        "hip_touchdown",
        "hip_end_of_stance",
        "body_position",
    )
    offsets = ("effector_offset_touchdown", "effector_offset_end_of_stance")
    arrows = ("start_velocity", *offsets, "side")
    moved = {name: place(getattr(request, name)) for name in points}
    moved |= {name: arrow(getattr(request, name)) for name in arrows}
    return request._replace(**moved, foot_yaw=flip * request.foot_yaw + heading), place


@given(
    heading=st.floats(-3.0, 3.0),
    x=st.floats(-50.0, 50.0),
    z=st.floats(-50.0, 50.0),
    mirror=st.booleans(),
)
@settings(max_examples=40, deadline=None)
def test_open_ground_knows_no_grid(heading, x, z, mirror):
    request = ask(OPEN, ORIGIN, Vec3(0.013, 0.0, 0.2417), foot_yaw=0.2)
    _, score, path = plan(OPEN, request)
    moved, place = turned(request, heading, Vec3(x, 0.0, z), mirror)
    found, moved_score, moved_path = plan(OPEN, moved)
    assert found
    assert SCRATCH.tally[TALLY_DIRECT] == 1
    assert moved_score == pytest.approx(score, abs=1e-12)
    expected = np.array([place(Vec3(*point)) for point in path.point])
    assert np.abs(moved_path.point - expected).max() < 1e-12 * max(1.0, abs(x) + abs(z))
    assert np.abs(moved_path.fraction - path.fraction).max() < 1e-9


@pytest.mark.parametrize("leg", [0.003, 0.5, 9.0])
def test_all_sizes_plan_alike(leg):
    scale = leg / LEG
    box = Obstacle.box((0.2 * scale, 0.1 * scale, 0.1 * scale), (0.0, 0.05 * scale, 0.1 * scale))
    env = Environment(obstacles=[box]).kernel_table
    request = ask(env, ORIGIN, Vec3(0.0, 0.0, 0.25 * scale), leg=leg, stride=STRIDE * scale)
    found, score, path = plan(env, request)
    same = Environment(obstacles=[Obstacle.box((0.2, 0.1, 0.1), (0.0, 0.05, 0.1))]).kernel_table
    _, expected_score, expected = plan(same, ask(same, ORIGIN, Vec3(0.0, 0.0, 0.25)))
    assert found
    assert score == pytest.approx(expected_score, rel=1e-9)
    assert np.abs(path.point / scale - expected.point).max() < 1e-9


def test_open_ground_lands_on_the_preferred_point_itself():
    wanted = Vec3(0.0171, 99.0, 0.2432)
    found, score, path = plan(OPEN, ask(OPEN, ORIGIN, wanted))
    points = sample(path)
    assert found
    assert score == pytest.approx(1.0)
    assert tuple(points[0]) == (0.0, 0.0, 0.0)
    assert tuple(points[-1]) == (wanted.x, 0.0, wanted.z)
    assert points[:, 1].max() == pytest.approx(0.15 * LEG, rel=1e-2)


def test_a_step_on_the_spot_goes_up_and_down():
    found, _, path = plan(OPEN, ask(OPEN, ORIGIN, ORIGIN))
    points = sample(path)
    assert found
    assert np.abs(points[:, [0, 2]]).max() < 1e-12
    assert points[:, 1].max() == pytest.approx(0.15 * LEG, rel=2e-2)


@pytest.mark.parametrize("start", range(0, 100, 10))
def test_no_foot_enters_a_crate_in_fields_of_45(start):
    held = steps = 0
    for seed in range(start, start + 10):
        env = crates(seed)
        for request, found, path in walk(env, seed, 20):
            steps += 1
            if not found:
                held += 1
                continue
            worst, _ = audit(env, path, 200, 0.0)
            assert worst <= 0.002 * LEG
            end = path.point[path.count[0] - 1]
            assert tuple(path.point[0]) == tuple(request.start_world)
            assert end[1] == surface(env, end[0], end[2])[0]
            # Where it would have to leave early the body waits; where it lands it must reach.
            landing = math.dist(end, request.hip_touchdown)
            assert request.reach_min <= landing <= request.reach_max
    assert held <= 0.02 * steps


@pytest.mark.parametrize("share", [0.3, 1.0])
def test_forbidden_crates_are_gone_around(share):
    found_steps = 0
    for seed in range(12):
        env = crates(seed, share)
        for _, found, path in walk(env, seed, 20):
            if not found:
                continue
            found_steps += 1
            worst, barred = audit(env, path, 200, 0.0)
            assert worst <= 0.002 * LEG
            assert not barred
            end = path.point[path.count[0] - 1]
            gap = 0.02 * LEG + SETTINGS.forbidden_margin * LEG
            assert not is_forbidden(env, end[0], end[2], gap)
    # Where all of 45 crates are forbidden, many ways round lead where no hip turns.
    assert found_steps > (150 if share < 1.0 else 100)


def test_a_wall_that_is_too_high_is_gone_around_and_a_low_one_stepped_over():
    sides = {}
    for height in (0.03, 0.45):
        wall = Obstacle.box((0.24, height, 0.04), (0.05, 0.5 * height, 0.12))
        env = Environment(obstacles=[wall]).kernel_table
        request = ask(env, ORIGIN, Vec3(0.0, 0.0, 0.25))
        found, _, path = plan(env, request)
        assert found
        assert audit(env, path, 200, 0.0)[0] <= 0.0005 * LEG
        points = sample(path)
        sides[height] = np.abs(points[:, 0]).max(), points[:, 1].max()
    assert sides[0.03][0] < 1e-12
    assert sides[0.45][0] > 0.07
    assert sides[0.45][1] < 0.2


def test_nothing_is_found_where_everything_is_forbidden():
    block = Obstacle.box((4.0, 0.1, 4.0), (0.0, 0.05, 2.1), forbidden=True)
    env = Environment(obstacles=[block]).kernel_table
    request = ask(env, ORIGIN, Vec3(0.0, 0.0, 0.25), stride=0.1, search_radius=0.1)
    found, score, path = plan(env, request)
    assert not found
    assert score == 0.0
    assert path.count[0] == 0
    # A wider search finds the ground before the block.
    found, _, path = plan(env, request._replace(search_radius=0.3))
    assert found
    assert path.point[path.count[0] - 1, 2] < 0.1


def test_water_is_passed_over_but_not_stood_in():
    heights = np.zeros((41, 41))
    water = np.zeros((41, 41), np.bool_)
    water[22:25] = True  # a stream across, from z = 0.125 to 0.275
    terrain = Terrain(heights, 0.05, (-1.0, -0.95), water=water)
    env = Environment(terrain).kernel_table
    assert is_wet(env, 0.0, 0.2)
    found, _, path = plan(env, ask(env, ORIGIN, Vec3(0.0, 0.0, 0.265)))
    points = sample(path)
    assert found
    assert points[-1, 2] - 0.02 * LEG >= 0.275


def test_legs_do_not_cross():
    request = ask(OPEN, ORIGIN, Vec3(0.0, 0.0, 0.25))
    store_vec3(SCRATCH.other_a[0], Vec3(-0.3, 0.3, 0.12))
    store_vec3(SCRATCH.other_b[0], Vec3(0.04, 0.0, 0.12))
    SCRATCH.other_radius[0] = 0.01
    found, _, path = plan(OPEN, request._replace(other_foot_count=1))
    points = sample(path)
    assert found
    # Nearest in plan to a leg that ends at x = 0.04: the foot passes outside.
    gap = np.hypot(np.maximum(points[:, 0] - 0.04, 0.0), points[:, 2] - 0.12)
    assert gap.min() > 0.01 + request.foot_half_x
    # A place right on the other foot is left to it.
    on_it = request._replace(preferred_world=Vec3(0.04, 0.0, 0.12), other_foot_count=1)
    found, _, path = plan(OPEN, on_it)
    end = path.point[path.count[0] - 1]
    assert found
    assert math.hypot(end[0] - 0.04, end[2] - 0.12) > 0.01 + request.foot_half_x


def test_a_replanned_swing_goes_on_as_it_was():
    velocity = Vec3(0.1, 0.12, 0.4)
    start = Vec3(0.0, 0.05, 0.1)
    found, _, path = plan(OPEN, ask(OPEN, start, Vec3(0.06, 0.0, 0.3), start_velocity=velocity))
    direction = np.array(velocity) / math.sqrt(sum(v * v for v in velocity))
    assert found
    assert tuple(path.point[0]) == tuple(start)
    assert path.tangent[0] / path.length[0] == pytest.approx(direction, abs=1e-9)
    points = sample(path)
    # It keeps to what is left of the arc instead of climbing a whole one again.
    assert points[:, 1].max() < 0.15 * LEG + 0.01
    assert points[:, 1].min() == 0.0


def test_feet_stand_well_inside_treads_of_stairs():
    terrain = generated("stairs", rise=0.15 * LEG, run=0.25)
    env = Environment(terrain).kernel_table
    landed = 0
    for request, found, path in walk(env, 3, 10):
        assert found
        worst, _ = audit(env, path, 200, 0.0)
        assert worst <= 0.002 * LEG
        end = path.point[path.count[0] - 1]
        for step in (-1.0, 1.0):
            beside = surface(env, end[0], end[2] + step * (0.02 + SETTINGS.toe) * LEG)[0]
            assert beside == pytest.approx(end[1], abs=1e-9)
        landed += request.start_world.y != end[1]
    assert landed >= 4


@pytest.mark.parametrize("angle", [-0.4, 0.4])
def test_slopes_are_walked_without_touching(angle):
    env = Environment(generated("slope", angle=angle)).kernel_table
    for _, found, path in walk(env, 1, 12):
        assert found
        assert SCRATCH.tally[TALLY_DIRECT] == 1
        points = sample(path)
        above = np.array([y - surface(env, x, z)[0] for x, y, z in points])
        assert above.min() > -1e-9
        assert above[20:-20].min() > 0.25 * 0.15 * LEG


def test_a_speed_limit_sends_long_detours_elsewhere():
    wall = Obstacle.box((0.3, 0.6, 0.04), (0.0, 0.3, 0.12))
    env = Environment(obstacles=[wall]).kernel_table
    request = ask(env, ORIGIN, Vec3(0.0, 0.0, 0.25), search_radius=0.3)
    _, _, free = plan(env, request)
    limit = 0.6 * 1.875 * free.length[0] / request.swing_seconds
    found, _, path = plan(env, request._replace(speed_limit=limit))
    assert found
    assert path.length[0] * 1.875 <= limit * request.swing_seconds


def test_less_detail_means_less_work():
    env = crates(5, count=110)
    full = fast = 0
    for request, _, _ in walk(env, 5, 15):
        plan(env, request)
        full += SCRATCH.tally[TALLY_PATHS]
        found, _, path = plan(env, request, SETTINGS._replace(first_pair=True, slice_limit=0))
        fast += SCRATCH.tally[TALLY_PATHS]
        assert found
        assert audit(env, path, 200, 0.0)[0] <= 0.002 * LEG
    assert fast < 0.6 * full


def fits(env, x, z, half):
    """Return whether a square about a place lies on flat ground: looked at from everywhere."""
    places = np.linspace(-half, half, 9)
    return all(surface(env, x + a, z + b)[0] == 0.0 for a in places for b in places)


def test_a_wide_foot_among_low_crates_lands_between_them():
    """The maps call every cell there even enough; once edges took all the places that were tried.

    Crates up to a third of the hip's height beside which a foot as wide as a lizard's has room.
    """
    half, radius, asked = 0.2 * LEG, 0.6 * LEG, 0
    net = np.linspace(-radius, radius, 17)
    start, wanted = ORIGIN, Vec3(0.0, 0.0, STRIDE)
    for seed in range(150):
        size = [[0.08, 0.04, 0.08], [0.2, 0.08, 0.2]]
        boxes = scatter(Terrain.flat(), 22, [-0.6, -0.35, 0.6, 0.85], size, seed)
        env = Environment(obstacles=boxes).kernel_table
        if not fits(env, start.x, start.z, half):
            continue
        request = ask(env, start, wanted, foot_half_x=half, foot_half_z=half, search_radius=radius)
        places = (Vec3(a, 0.0, wanted.z + b) for a in net for b in net)
        if any(
            math.dist(place, wanted) < 0.95 * radius
            and math.dist(place, request.hip_touchdown) < request.reach_comfort_max
            and fits(env, place.x, place.z, 1.3 * half)
            for place in places
        ):
            found, _, path = plan(env, request)
            assert found, seed
            end = path.point[path.count[0] - 1]
            assert fits(env, end[0], end[2], half)
            asked += 1
    assert asked > 8
