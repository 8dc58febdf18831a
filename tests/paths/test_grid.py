"""Wavefront and line of sight against brute force."""

from __future__ import annotations

import heapq

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.math.vec3 import Vec3
from polypod.paths.around import pick_waypoints, smooth_plan
from polypod.paths.grid import (
    DIAGONAL,
    POTENTIAL,
    STRAIGHT,
    line_of_sight,
    spread_wavefront,
    trace_cells,
)
from polypod.paths.scratch import grid_scratch, lift_scratch

LEVEL = 0.5
SIDE = 24


def random_map(seed, share):
    random = np.random.default_rng(seed)
    closed = random.random((SIDE, SIDE)) < 0.3 * share
    highest = np.where(random.random((SIDE, SIDE)) < 0.7 * share, 1.0, 0.2)
    start = tuple(random.integers(0, SIDE, 2))
    return closed, highest, start


def spread(closed, highest, start):
    grid = grid_scratch(SIDE, 2)
    grid.closed[:] = closed
    grid.level[1] = LEVEL
    spread_wavefront(grid, highest, SIDE, 1, int(start[0]), int(start[1]))
    return grid


def dijkstra(blocked, start):
    """Return the cheapest costs by a heap, cell by cell."""
    n = len(blocked)
    cost = np.full((n, n), -1)
    heap = [(0, *start)]
    while heap:
        so_far, row, column = heapq.heappop(heap)
        if cost[row, column] >= 0:
            continue
        cost[row, column] = so_far
        around = blocked[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2].copy()
        around[row - max(row - 1, 0), column - max(column - 1, 0)] = False
        here = so_far + (POTENTIAL if around.any() else 0)
        for d_row in (-1, 0, 1):
            for d_column in (-1, 0, 1):
                r, c = row + d_row, column + d_column
                if (d_row, d_column) == (0, 0) or not (0 <= r < n and 0 <= c < n):
                    continue
                beside = (d_row and blocked[r, column]) or (d_column and blocked[row, c])
                if blocked[r, c] or beside:
                    continue
                step = DIAGONAL if d_row and d_column else STRAIGHT
                heapq.heappush(heap, (here + step, r, c))
    return cost


@pytest.mark.parametrize("seed", range(12))
def test_wavefront_costs_are_dijkstra_s(seed):
    closed, highest, start = random_map(seed, 0.08 * (seed % 6))
    grid = spread(closed, highest, start)
    expected = dijkstra(closed | (highest > LEVEL), start)
    assert (grid.distance[1] == expected).all()
    assert (expected >= 0).sum() > 1


@pytest.mark.parametrize("seed", range(12))
def test_traced_cells_are_free_neighbours_that_lead_to_the_start(seed):
    closed, highest, start = random_map(seed, 0.3)
    grid = spread(closed, highest, start)
    blocked = closed | (highest > LEVEL)
    for row, column in np.argwhere(grid.distance[1] > 0)[::17]:
        count = trace_cells(grid, 1, int(row), int(column))
        cells = grid.cells[:count]
        assert tuple(cells[0]) == (row, column)
        assert tuple(cells[-1]) == start
        assert np.abs(np.diff(cells, axis=0)).max() == 1
        assert not blocked[cells[:-1, 0], cells[:-1, 1]].any()
    for row, column in np.argwhere(grid.distance[1] < 0)[:3]:
        assert trace_cells(grid, 1, int(row), int(column)) == 0


places = st.tuples(st.floats(0.0, SIDE - 1e-6), st.floats(0.0, SIDE - 1e-6))
on_grid = st.tuples(
    st.integers(0, 2 * SIDE - 1).map(lambda k: 0.5 * k + 0.5 * (k % 2 == 0)),
    st.integers(0, 2 * SIDE - 1).map(lambda k: 0.5 * k + 0.5 * (k % 2 == 0)),
)


@given(seed=st.integers(0, 200), a=st.one_of(places, on_grid), b=st.one_of(places, on_grid))
@settings(max_examples=300, deadline=None)
def test_line_of_sight_sees_every_cell_that_it_touches(seed, a, b):
    a = (min(a[0], SIDE - 1e-6), min(a[1], SIDE - 1e-6))
    b = (min(b[0], SIDE - 1e-6), min(b[1], SIDE - 1e-6))
    closed, highest, _ = random_map(seed, 0.05)
    blocked = closed | (highest > LEVEL)
    seen = line_of_sight(closed, highest, LEVEL, SIDE, a[0], a[1], b[0], b[1])
    first = (int(a[1]), int(a[0]))
    # A cell is surely touched where the segment runs inside it, away from its border.
    share = np.linspace(0.0, 1.0, 4001)
    u = a[0] + (b[0] - a[0]) * share
    v = a[1] + (b[1] - a[1]) * share
    inside = (np.abs(u - np.round(u)) > 1e-6) & (np.abs(v - np.round(v)) > 1e-6)
    touched = {
        (int(row), int(column))
        for row, column in zip(np.floor(v[inside]), np.floor(u[inside]), strict=True)
    } - {first}
    if any(blocked[cell] for cell in touched):
        assert not seen
    # What blocks the view is at most a rounding away from the segment.
    near = set()
    for d_u in (-2e-6, 0.0, 2e-6):
        for d_v in (-2e-6, 0.0, 2e-6):
            rows = np.clip(np.floor(v + d_v), 0, SIDE - 1).astype(int)
            columns = np.clip(np.floor(u + d_u), 0, SIDE - 1).astype(int)
            near |= set(zip(rows.tolist(), columns.tolist(), strict=True))
    if not seen and all(not blocked[cell] for cell in near - {first}):
        # Between samples a corner can be cut by less than the sampling: look closer there.
        blocking = [
            (row, column)
            for row, column in np.argwhere(blocked)
            if distance_to_cell(a, b, row, column) < 1e-6 and (row, column) != first
        ]
        assert blocking


def distance_to_cell(a, b, row, column):
    """Return the least distance from points of the segment to a cell's square."""
    low, high = 0.0, 1.0

    def gap(share):
        u = a[0] + (b[0] - a[0]) * share
        v = a[1] + (b[1] - a[1]) * share
        return np.hypot(max(column - u, 0.0, u - column - 1.0), max(row - v, 0.0, v - row - 1.0))

    for _ in range(200):  # the distance to a convex set is convex along a line
        one, two = low + (high - low) / 3.0, high - (high - low) / 3.0
        low, high = (low, two) if gap(one) < gap(two) else (one, high)
    return gap(0.5 * (low + high))


def test_a_line_through_the_corner_of_four_cells_needs_all_of_them():
    highest = np.zeros((4, 4))
    for row, column in ((1, 2), (2, 1)):
        closed = np.zeros((4, 4), np.bool_)
        closed[row, column] = True
        assert not line_of_sight(closed, highest, LEVEL, 4, 1.5, 1.5, 2.5, 2.5)
        assert not line_of_sight(closed, highest, LEVEL, 4, 2.5, 2.5, 1.5, 1.5)
    assert line_of_sight(np.zeros((4, 4), np.bool_), highest, LEVEL, 4, 1.5, 1.5, 2.5, 2.5)


@pytest.mark.parametrize("seed", range(8))
def test_smooth_plans_keep_out_of_blocked_cells(seed):
    closed, highest, start = random_map(seed, 0.3)
    grid = spread(closed, highest, start)
    blocked = closed | (highest > LEVEL)
    lift = lift_scratch()
    place = np.array([-0.7, 0.4, 0.05])
    begin = Vec3(place[0] + 0.05 * (start[1] + 0.5), 0.0, place[1] + 0.05 * (start[0] + 0.5))
    ways = 0
    for row, column in np.argwhere(grid.distance[1] > 150)[::11]:
        end = Vec3(place[0] + 0.05 * (column + 0.4), 0.0, place[1] + 0.05 * (row + 0.6))
        count = trace_cells(grid, 1, int(row), int(column))
        points = pick_waypoints(grid, highest, place, SIDE, 1, count, begin, end)
        if points == 0:
            continue
        ways += 1
        samples = smooth_plan(grid, lift, highest, place, SIDE, 1, points)
        plan = lift.plan[:samples]
        assert tuple(plan[0, :2]) == (begin.x, begin.z)
        assert plan[-1, :2] == pytest.approx((end.x, end.z), abs=1e-12)
        assert (np.diff(plan[:, 2]) > 0.0).all()
        steps = np.hypot(*np.diff(plan[:, :2], axis=0).T)
        assert plan[1:, 2] == pytest.approx(np.cumsum(steps))
        # A curve may bulge out of the map, where its border goes on.
        cells = np.floor((plan[:, 1::-1] - place[1::-1]) / place[2]).astype(int)
        cells = np.clip(cells, 0, SIDE - 1)
        away = np.hypot(*(plan[:, :2] - plan[0, :2]).T) > 0.05
        assert not blocked[cells[away, 0], cells[away, 1]].any()
    assert ways > 0
