"""Ways at body scale: round what cannot be passed, over what can, and to nearest where none is."""

from __future__ import annotations

import hypothesis
import numpy as np
import pytest
from hypothesis import HealthCheck, given
from hypothesis import strategies as st

from polypod.config import Settings
from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.environment.terrain import Terrain
from polypod.herd import Herd
from polypod.morphology.load import load_rig
from routes import places
from routes.places import box, find, leg_of, samples

RIGS = ("spider", "wolf")


def test_open_ground_needs_no_corners() -> None:
    way = find(Environment(), (3.0, 9.0))
    assert len(way.points) == 2
    assert not way.ends


@pytest.mark.parametrize("forbidden", [False, True])
@pytest.mark.parametrize("rig", RIGS)
def test_it_goes_through_the_gap_of_a_wall(rig: str, forbidden: bool) -> None:
    leg = leg_of(rig)
    walls = [
        box(leg, -9, 4, 1, 4.3, forbidden=forbidden),
        box(leg, 2.4, 4, 9, 4.3, forbidden=forbidden),
    ]
    way = find(Environment(obstacles=walls), (0, 7), rig=rig)
    assert not way.ends
    assert 1.0 < way.crossing(4.15) < 2.4
    assert way.length < 8.5


@pytest.mark.parametrize("forbidden", [False, True])
@pytest.mark.parametrize("rig", RIGS)
def test_it_leaves_a_dead_end(rig: str, forbidden: bool) -> None:
    way = find(places.trap(leg_of(rig), forbidden), (0, 7), start=(0, 3), rig=rig)
    assert not way.ends
    assert abs(way.crossing(4.15)) > 2.0
    # Out, round a corner of it, and on: no shorter way is there, and this is not much longer.
    assert 9.0 < way.length < 11.0


@pytest.mark.parametrize("forbidden", [False, True])
def test_it_finds_through_a_maze(forbidden: bool) -> None:
    way = find(places.maze(leg_of("spider"), forbidden), (0, 8.5))
    assert way.crossing(2.55) > 2.5
    assert way.crossing(4.55) < -2.5
    assert way.crossing(6.55) > 2.5
    assert not way.ends


def test_a_goal_inside_of_something_is_gone_to_as_near_as_can_be() -> None:
    leg = leg_of("spider")
    block = box(leg, -1.5, 4.5, 1.5, 7.5)
    way = find(Environment(obstacles=[block]), (0.0, 6.0))
    assert way.ends
    assert 0.1 < places.distance_to_box(way.points[-1:], block, leg)[0] < 0.7


def test_a_goal_beyond_closed_walls_is_not_reached() -> None:
    leg = leg_of("spider")
    walls = ((-3, 4, 3, 4.3), (-3, -3, 3, -2.7), (-3, -3, -2.7, 4.3), (2.7, -3, 3, 4.3))
    place = Environment(obstacles=[box(leg, *wall) for wall in walls])
    out = find(place, (0, 7))
    assert out.ends
    assert 3.0 < out.points[-1, 1] < 4.0
    # Nor from outside, where the border of the map can be reached: the goal's own walls are seen.
    into = find(place, (0, 0), start=(0, 5.5))
    assert into.ends
    assert 3.0 < np.linalg.norm(into.points[-1]) < 4.2


@pytest.mark.parametrize("rig", RIGS)
@pytest.mark.parametrize("wet", [False, True])
def test_a_river_or_a_chasm_is_crossed_at_its_ford(rig: str, wet: bool) -> None:
    leg = leg_of(rig)
    way = find(places.river(leg, 1.2, wet), (0, 8), rig=rig)
    assert not way.ends
    middle = samples(way)
    crossing = middle[np.abs(middle[:, 1] - 4.0 - 0.8 * np.sin(middle[:, 0] / 1.5)) < 0.8]
    assert len(crossing) > 10
    assert np.abs(crossing[:, 0] - 4.0).max() < 1.0


@pytest.mark.parametrize("rig", RIGS)
def test_a_trench_is_stepped_over_or_crossed_on_its_bridge(rig: str) -> None:
    leg = leg_of(rig)
    over = find(places.trench(leg, 0.4, False), (0, 8), rig=rig, level=leg)
    assert len(over.points) == 2
    round_it = find(places.trench(leg, 1.6, True), (0, 8), rig=rig, level=leg)
    assert not round_it.ends
    assert 3.0 < round_it.crossing(3.8) < 5.0
    # Who stands in it goes along it: the same place is a corridor from below.
    along = find(places.trench(leg, 1.6, False), (5, 3.8), start=(-5, 3.8), rig=rig)
    assert len(along.points) == 2


def test_what_is_low_is_stepped_on_and_what_is_high_is_gone_round() -> None:
    leg = leg_of("wolf")
    for height, straight in ((0.25, True), (0.8, False)):
        crate = Environment(obstacles=[box(leg, -3, 3, 3, 4, height)])
        assert (len(find(crate, (0, 7), rig="wolf").points) == 2) == straight
        fence = Environment(obstacles=[box(leg, -3, 3, 3, 3.05, height)])
        assert (len(find(fence, (0, 7), rig="wolf").points) == 2) == straight


def test_a_steep_face_is_gone_round_and_a_slope_is_not() -> None:
    leg, cell = leg_of("spider"), 0.05 * leg_of("spider")
    at = (np.arange(400) - 200) * cell / leg
    x, z = np.meshgrid(at, at + 4.0)
    for tangent, straight in ((0.7, True), (2.0, False)):
        ridge = np.maximum(0.0, 2.0 - tangent * np.abs(z - 4.0)) * (np.abs(x) < 4.0)
        place = Environment(Terrain(ridge * leg, cell, (at[0] * leg, (at[0] + 4.0) * leg)))
        assert (len(find(place, (0, 8)).points) == 2) == straight


def test_ways_scale_with_the_creature() -> None:
    """In leg lengths of a fly of 3 mm and of a dinosaur it is the same way."""
    ways = []
    for height in (0.003, 9.0):
        herd = Herd(load_rig("spider", height=height), 1, Settings())
        place = places.trap(herd.tables.leg_length, False)
        ways.append(find(place, (0.5, 7), start=(0.5, 3), herd=herd))
    assert ways[0].points.shape == ways[1].points.shape
    assert np.abs(ways[0].points - ways[1].points).max() < 1e-6


def test_a_mirrored_place_has_a_way_as_long() -> None:
    leg = leg_of("spider")
    walls = ((-1, 3, 3, 3.3), (-4, 5, 0.5, 5.3))
    here = find(Environment(obstacles=[box(leg, *wall) for wall in walls]), (0.0, 8.0))
    mirrored = [box(leg, -x0, z0, -x1, z1) for x0, z0, x1, z1 in walls]
    there = find(Environment(obstacles=mirrored), (0.0, 8.0))
    assert here.length == pytest.approx(there.length, rel=0.03)


@st.composite
def fields(draw: st.DrawFn) -> list[tuple[float, float, float, float, bool]]:
    """Boxes about the straight way: place, half sizes, forbidden or high."""
    number = st.floats(0.0, 1.0)
    return [
        (
            draw(number) * 8.0 - 4.0,
            draw(number) * 5.0 + 1.8,
            0.05 + draw(number) * 0.8,
            0.05 + draw(number) * 0.8,
            draw(st.booleans()),
        )
        for _ in range(draw(st.integers(1, 14)))
    ]


@given(fields(), st.sampled_from(RIGS))
@hypothesis.settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_no_way_leads_through_anything(field: list, rig: str) -> None:
    leg = leg_of(rig)
    boxes: list[Obstacle] = []
    for x, z, half_x, half_z, forbidden in field:
        boxes.append(box(leg, x - half_x, z - half_z, x + half_x, z + half_z, 2.0, forbidden))
    way = find(Environment(obstacles=boxes), (0.0, 8.5), rig=rig)
    along = samples(way)
    for obstacle in boxes:
        assert places.distance_to_box(along, obstacle, leg).min() > 0.0
    if not way.ends:
        assert way.length < 30.0
