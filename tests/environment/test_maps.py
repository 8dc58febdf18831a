"""The maps against brute force: no cell called free that is not, none overgrown."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from polypod.compute import kernel
from polypod.environment import Environment, Obstacle, Terrain, scatter
from polypod.environment.grown import (
    KIND_CORNER,
    KIND_EDGE,
    KIND_FORBIDDEN,
    KIND_GROUND,
    KIND_GROWN,
    KIND_INSIDE,
)
from polypod.environment.maps import LocalMap, fill_maps, make_local_map
from polypod.environment.table import EnvironmentTable, ground_height, is_wet, surface
from polypod.reference import by_reference

N = 24
CELL = 0.05
BASE = -0.5
FOOT = (0.04, 0.09, 0.7)
TILT = (0.2, 0.1, 0.15, math.sqrt(1 - 0.0725))
LEAN = (0.3, 0.0, 0.2, math.sqrt(1 - 0.13))


def maps_of(
    env: EnvironmentTable,
    foot: tuple[float, float, float] = FOOT,
    centre: tuple[float, float] = (0.03, -0.02),
    n: int = N,
) -> LocalMap:
    window = make_local_map(n + 3)
    fill_maps(env, by_reference(window), centre[0], centre[1], CELL, n, *foot, 0.0)
    return window


def rectangle(half_x: float, half_z: float, yaw: float, count: int) -> NDArray[np.float64]:
    """Points [count * count, 2] of a foot's rectangle, its rim included."""
    side = np.linspace(-1.0, 1.0, count)
    x, z = np.meshgrid(half_x * side, half_z * side)
    cosine, sine = math.cos(yaw), math.sin(yaw)
    return np.column_stack([(x * cosine + z * sine).ravel(), (-x * sine + z * cosine).ravel()])


@kernel
def sample(
    env: EnvironmentTable,
    window: LocalMap,
    feet: NDArray[np.float64],
    places: NDArray[np.float64],
    highest: NDArray[np.float64],
    lowest: NDArray[np.float64],
) -> None:
    """Write the extremes of the surface under feet [M, 2] centred at places [L, 2] of each cell.

    Places are in cells from the cell's corner.
    """
    for i in range(window.size[0]):
        for j in range(window.size[0]):
            highest[i, j] = -math.inf
            lowest[i, j] = math.inf
            for place in range(len(places)):
                x = window.place[0] + (j + places[place, 0]) * window.place[2]
                z = window.place[1] + (i + places[place, 1]) * window.place[2]
                for foot in range(len(feet)):
                    height = surface(env, x + feet[foot, 0], z + feet[foot, 1])[0]
                    highest[i, j] = max(highest[i, j], height)
                    lowest[i, j] = min(lowest[i, j], height)


def sampled(
    env: EnvironmentTable, window: LocalMap, feet: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    n = int(window.size[0])
    x, z = np.meshgrid(np.linspace(0, 1, 6), np.linspace(0, 1, 6))
    places = np.column_stack([x.ravel(), z.ravel()])
    highest, lowest = np.zeros((n, n)), np.zeros((n, n))
    sample(env, by_reference(window), feet, places, highest, lowest)
    return highest, lowest


OBSTACLES = {
    "box": Obstacle.box((0.3, 0.2, 0.5), (0.1, 0.1, 0.05), yaw=0.4),
    "small box": Obstacle.box((0.02, 0.2, 0.02), (0.1, 0.1, 0.05), yaw=0.4),
    "tilted box": Obstacle("box", (0.4, 0.15, 0.3), (-0.05, 0.2, 0.1), TILT),
    "sphere": Obstacle.sphere(0.5, (0.02, 0.1, -0.07)),
    "cylinder": Obstacle.cylinder(0.4, 0.3, (0.1, 0.15, 0.0)),
    "leaning cylinder": Obstacle.cylinder(0.3, 0.4, (0.0, 0.2, 0.0), LEAN),
    "hull": Obstacle.hull(
        [[-0.2, 0, -0.2], [0.3, 0, 0], [0, 0, 0.3], [0, 0.3, 0.05], [0.1, 0.25, 0.1]], (0, 0, 0)
    ),
}


@pytest.mark.parametrize("foot", [FOOT, (0.0, 0.0, 0.0), (0.1, 0.02, -1.2)])
@pytest.mark.parametrize("name", OBSTACLES)
def test_grown_cells_are_those_that_a_foot_touches(
    name: str, foot: tuple[float, float, float]
) -> None:
    env = Environment(Terrain.flat(BASE), [OBSTACLES[name]]).kernel_table
    window = maps_of(env, foot)
    highest, lowest = sampled(env, window, rectangle(*foot, 9))
    # A sphere's top rises like a root at its rim: rounding there counts for more.
    rounding = 1e-7 if name == "sphere" else 1e-12
    assert np.all(window.highest[:N, :N] >= highest - rounding)
    touched = highest > BASE
    grown = window.highest[:N, :N] > BASE
    assert np.all(grown[touched])
    assert np.all((window.kind[:N, :N] != KIND_GROUND) == grown)
    # Overgrown by less than a cell: a foot half a cell larger all around touches.
    wider = (foot[0] + 0.5 * CELL, foot[1] + 0.5 * CELL, foot[2])
    around, _ = sampled(env, window, rectangle(*wider, 25))
    assert np.all(around[grown] > BASE)
    assert np.all(window.lowest[:N, :N] <= lowest + rounding)
    assert np.all(window.lowest[:N, :N] >= BASE)


def test_a_box_is_grown_exactly() -> None:
    """By hand: a box of half 1.95 x 2.95 cells and a foot of half 0.9 x 0.4, along the axes."""
    box = Obstacle.box((3.9 * CELL, 0.3, 5.9 * CELL), (0.0, 0.15, 0.0))
    env = Environment(Terrain.flat(), [box]).kernel_table
    window = maps_of(env, (0.9 * CELL, 0.4 * CELL, 0.0), (0.0, 0.0), 12)
    # Cell 6 begins at 0. Along x the grown box ends at 2.85 cells, along z at 3.35.
    assert window.kind[6, :12].tolist() == [0, 0, 0, 1, 2, 4, 4, 2, 1, 0, 0, 0]
    assert window.kind[:12, 6].tolist() == [0, 0, 1, 2, 4, 4, 4, 4, 2, 1, 0, 0]
    assert window.kind[3, 4] == KIND_CORNER
    assert (window.highest[6, :12] == 0.3).tolist() == [3 <= j <= 8 for j in range(12)]
    # Feet lie wholly on top within 1.05 cells along x and 2.55 along z.
    assert (window.lowest[6, :12] == 0.3).tolist() == [5 <= j <= 6 for j in range(12)]
    assert (window.lowest[:12, 6] == 0.3).tolist() == [4 <= i <= 7 for i in range(12)]


def test_a_foot_on_top_finds_an_even_cell() -> None:
    env = Environment(
        Terrain.flat(), [Obstacle.box((1.0, 0.3, 1.0), (0.0, 0.15, 0.0), 0.6)]
    ).kernel_table
    window = maps_of(env, (0.05, 0.1, 0.2), (0.0, 0.0))
    middle = N // 2
    assert window.highest[middle, middle] == pytest.approx(0.3)
    assert window.lowest[middle, middle] == pytest.approx(0.3)
    assert window.edge_distance[middle, middle] > 4.0
    assert set(np.unique(window.kind[:N, :N])) <= {0, 1, 2, 3, 4}
    assert np.count_nonzero(window.kind[:N, :N] == KIND_CORNER) <= 4


@pytest.mark.parametrize("cell", [0.2, 0.05, 0.031, 0.008])
def test_the_terrain_is_extreme_where_samples_say(cell: float) -> None:
    heights = np.random.default_rng(0).uniform(0, 0.3, (40, 35))
    env = Environment(Terrain(heights, cell, (-0.5, -0.45))).kernel_table
    window = maps_of(env)
    highest, lowest = window.highest[:N, :N], window.lowest[:N, :N]
    fine = np.linspace(0, 1, 41)
    low_seen, high_seen = 0.0, 0.0
    for i, j in np.random.default_rng(1).integers(0, N, (40, 2)):
        found = [
            ground_height(env, window.place[0] + CELL * (j + u), window.place[1] + CELL * (i + v))
            for u in fine[::2]
            for v in fine[::2]
        ]
        assert highest[i, j] >= max(found) - 1e-12
        assert lowest[i, j] <= min(found) + 1e-12
        high_seen = max(high_seen, highest[i, j] - max(found))
        low_seen = max(low_seen, min(found) - lowest[i, j])
    # The samples come close to the extremes: these are no larger than they need be.
    steepest = 0.3 / cell
    assert max(high_seen, low_seen) <= 2.0 * steepest * CELL / 20


def test_an_even_slope_is_no_edge_and_a_cliff_is() -> None:
    slope = Environment(Terrain.slope(math.radians(40), length=20.0, start=-10.0)).kernel_table
    assert np.all(maps_of(slope).edge_distance[:N, :N] == N)
    cliff = Terrain(np.array([[0.0, 0.0], [0.0, 0.0], [0.3, 0.3], [0.3, 0.3]]), 0.02, (0.0, 0.0))
    window = maps_of(Environment(cliff).kernel_table, centre=(0.0, 0.0))
    assert np.all(window.edge_distance[N // 2, :N] == 0.0)
    assert np.allclose(window.edge_distance[N // 2 + 5, :N], 5.0)


def test_distance_to_an_edge_is_near_the_true_one() -> None:
    pin = Obstacle.box((0.01, 0.2, 0.01), (0.03 + 0.5 * CELL, 0.1, -0.02 + 0.5 * CELL))
    env = Environment(Terrain.flat(), [pin]).kernel_table
    window = maps_of(env, (0.0, 0.0, 0.0))
    middle = N // 2
    assert window.edge_distance[middle, middle] == 0.0
    i, j = np.mgrid[:N, :N]
    true = np.hypot(i - middle, j - middle)
    assert np.all(np.abs(window.edge_distance[:N, :N] - true) <= 0.1 * true + 1e-9)


def test_forbidden_and_wet_cells() -> None:
    forbidden = Obstacle.box((0.2, 0.2, 0.2), (0.2, 0.1, 0.2), 0.5, forbidden=True)
    water = np.zeros((9, 9), np.bool_)
    water[2:4, 1:3] = True
    terrain = Terrain(np.zeros((9, 9)), 0.13, (-0.5, -0.5), water)
    env = Environment(terrain, [forbidden]).kernel_table
    window = maps_of(env)
    assert np.all((window.kind[:N, :N] == KIND_FORBIDDEN) == window.forbidden[:N, :N])
    assert np.all(window.edge_distance[:N, :N][window.forbidden[:N, :N]] == 0.0)
    alone = Environment(Terrain.flat(), [forbidden]).kernel_table
    assert np.all((maps_of(alone).highest[:N, :N] > 0.0) == window.forbidden[:N, :N])
    reach = rectangle(*FOOT, 9)
    wet_feet = 0
    for i in range(N):
        for j in range(N):
            corner = window.place[:2] + CELL * np.array([j, i])
            places = corner + CELL * np.array([[0, 0], [1, 0], [0, 1], [1, 1], [0.5, 0.5]])
            points = (places[:, None] + reach[None]).reshape(-1, 2)
            if any(is_wet(env, x, z) for x, z in points[::3]):
                wet_feet += 1
                assert window.wet[i, j]
    assert wet_feet > 10
    assert np.count_nonzero(window.wet[:N, :N]) < 2.5 * wet_feet


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 1000),
    steps=st.tuples(st.integers(-50, 50), st.integers(-50, 50)),
    foot=st.tuples(st.floats(0, 0.1), st.floats(0, 0.1), st.floats(-4, 4)),
)
def test_moving_the_world_by_whole_cells_moves_the_map(
    seed: int, steps: tuple[int, int], foot: tuple[float, float, float]
) -> None:
    flat = Terrain.flat()
    crates = scatter(flat, 12, (-0.6, -0.6, 0.6, 0.6), [[0.05] * 3, [0.4, 0.2, 0.3]], seed, 0.3)
    shift = (steps[0] * CELL, steps[1] * CELL)
    moved = [
        Obstacle(
            crate.shape,
            crate.size,
            (crate.position[0] + shift[0], crate.position[1], crate.position[2] + shift[1]),
            crate.rotation,
            crate.forbidden,
        )
        for crate in crates
    ]
    before = maps_of(Environment(flat, crates).kernel_table, foot)
    after = maps_of(
        Environment(flat, moved).kernel_table, foot, (0.03 + shift[0], -0.02 + shift[1])
    )
    assert np.array_equal(before.kind[:N, :N], after.kind[:N, :N])
    assert np.array_equal(before.forbidden[:N, :N], after.forbidden[:N, :N])
    assert np.array_equal(before.edge_distance[:N, :N], after.edge_distance[:N, :N])
    assert np.allclose(before.highest[:N, :N], after.highest[:N, :N])


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 1000), quarter=st.integers(1, 3), yaw=st.floats(-3, 3))
def test_a_quarter_turn_of_the_world_turns_the_map(seed: int, quarter: int, yaw: float) -> None:
    crates = scatter(
        Terrain.flat(), 12, (-0.6, -0.6, 0.6, 0.6), [[0.05] * 3, [0.4, 0.2, 0.3]], seed, 0.3
    )
    angle = 0.5 * math.pi * quarter
    turned = []
    for crate in crates:
        x, y, z = crate.position
        own = 2.0 * math.atan2(crate.rotation[1], crate.rotation[3])
        cosine, sine = round(math.cos(angle)), round(math.sin(angle))
        place = (x * cosine + z * sine, y, -x * sine + z * cosine)
        turned.append(Obstacle.box(crate.size, place, own + angle, crate.forbidden))
    before = maps_of(Environment(None, crates).kernel_table, (0.03, 0.07, yaw), (0.0, 0.0))
    after = maps_of(Environment(None, turned).kernel_table, (0.03, 0.07, yaw + angle), (0.0, 0.0))
    # Turning +Z toward +X takes rows toward columns.
    kinds = np.rot90(after.kind[:N, :N], -quarter)
    assert np.mean(before.kind[:N, :N] != kinds) <= 0.01  # a corner on a cell's side may go astray
    heights = np.rot90(after.highest[:N, :N], -quarter)
    assert np.mean(np.abs(before.highest[:N, :N] - heights) > 1e-9) <= 0.01


def test_stairs_are_even_on_their_treads() -> None:
    env = Environment(Terrain.stairs(rise=0.075, run=0.4, count=6, start=-0.5)).kernel_table
    window = maps_of(env, (0.02, 0.03, 0.0))
    rises = window.highest[:N, :N] - window.lowest[:N, :N]
    assert set(np.round(np.unique(rises), 9)) == {0.0, 0.075}
    assert set(np.round(np.unique(window.lowest[:N, :N]), 9)) <= {0.0, 0.075, 0.15, 0.225}
    assert np.mean(rises < 1e-9) > 0.5
    assert set(np.unique(window.kind[:N, :N])) >= {KIND_GROUND, KIND_GROWN, KIND_EDGE, KIND_INSIDE}
