"""The body's smoothing, hull and plane against closed forms and brute force."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.body.hull import hull_height, insert_sorted
from polypod.body.smoothing import follow
from polypod.body.support import LEVEL_LENGTH, LEVEL_WIDTH, feet_plane
from polypod.config import Settings
from polypod.herd import Herd
from polypod.morphology.load import load_rig


def step_response(seconds: float, dt: float, until: float) -> tuple[np.ndarray, np.ndarray]:
    memory = np.zeros(3)
    times = dt * np.arange(1, round(until / dt) + 1)
    return times, np.array([follow(memory, 1.0, seconds, dt) for _ in times])


def analytic(times: np.ndarray, seconds: float) -> np.ndarray:
    """Three equal poles at 4 / seconds."""
    turn = 4.0 * times / seconds
    return 1.0 - np.exp(-turn) * (1.0 + turn + 0.5 * turn**2)


@pytest.mark.parametrize("seconds", [0.1, 0.4, 2.0])
def test_the_filter_answers_a_step_as_three_equal_poles(seconds: float) -> None:
    gaps = []
    for dt in (seconds / 400, seconds / 1600):
        times, values = step_response(seconds, dt, 3.0 * seconds)
        gaps.append(float(np.abs(values - analytic(times, seconds)).max()))
    assert gaps[1] < 1e-3
    assert gaps[1] < 0.3 * gaps[0]  # and nearer the finer it goes


def test_the_filter_neither_overshoots_nor_jolts() -> None:
    for dt in (1 / 240, 1 / 30, 0.5, 10.0):
        _, values = step_response(0.4, dt, max(3.0, 5.0 * dt))
        assert np.all(np.diff(np.append(0.0, values)) >= -1e-15)
        assert np.all(values <= 1.0)
    # Continuous acceleration: at the step its second difference is a fraction of the largest.
    _, values = step_response(0.4, 1e-3, 1.0)
    bend = np.abs(np.diff(np.append([0.0, 0.0], values), n=2))
    assert bend[0] < 0.05 * bend.max()


def test_the_filter_keeps_the_rate_of_its_value() -> None:
    memory = np.zeros(3)
    values, rates = [], []
    for _ in range(2000):
        values.append(follow(memory, 1.0, 0.4, 1e-4))
        rates.append(memory[1])
    assert np.diff(values) / 1e-4 == pytest.approx(np.array(rates[1:]), abs=2e-3)


def test_the_filter_arrives_after_an_endless_step_and_at_once_without_time() -> None:
    for seconds, dt in ((0.5, 1e6), (0.0, 1 / 30)):
        memory = np.array([0.2, 5.0, -0.3])
        assert follow(memory, 0.7, seconds, dt) == pytest.approx(0.7, abs=1e-15)
        assert memory == pytest.approx([0.7, 0.0, 0.7], abs=1e-15)


coordinate = st.floats(-10.0, 10.0, allow_nan=False).map(lambda x: round(x, 3))


def brute_hull(points: list[tuple[float, float]], along: float) -> float:
    """Return the highest of all chords over `along`, or the height of the end beyond."""
    xs = [x for x, _ in points]
    at = min(max(along, min(xs)), max(xs))
    best = max((y for x, y in points if x == at), default=-math.inf)
    for xa, ya in points:
        for xb, yb in points:
            if xa < at < xb:
                best = max(best, ya + (yb - ya) * (at - xa) / (xb - xa))
    return best


@settings(max_examples=300, deadline=None)
@given(st.lists(st.tuples(coordinate, coordinate), min_size=1, max_size=14), coordinate)
def test_the_hull_is_the_highest_chord(points: list[tuple[float, float]], along: float) -> None:
    room = np.zeros((len(points), 2))
    count = 0
    for x, y in points:
        count = insert_sorted(room, count, x, y)
    assert np.all(np.diff(room[:, 0]) >= 0.0)
    assert hull_height(room, count, along) == pytest.approx(brute_hull(points, along), abs=1e-9)


@pytest.fixture(scope="module")
def herd() -> Herd:
    return Herd(load_rig("spider"), 1, Settings())


@pytest.mark.parametrize("heading", [0.0, 0.9, -2.4])
@pytest.mark.parametrize("slopes", [(0.0, 0.0), (0.3, 0.0), (0.0, -0.2), (0.25, 0.15)])
def test_the_plane_through_planar_feet(
    herd: Herd, heading: float, slopes: tuple[float, float]
) -> None:
    """It passes through their mean, and leans to level ground by the stated share and no more."""
    state, legs = herd.state, herd.tables.legs
    forward, left = legs.sole_stance[:, 2], legs.sole_stance[:, 0]
    centre = np.array([3.0, 1.5, -2.0])
    state.position[0] = centre
    state.heading[0] = heading
    sine, cosine = math.sin(heading), math.cos(heading)
    state.foot[0, :, 0] = centre[0] + forward * sine + left * cosine
    state.foot[0, :, 2] = centre[2] + forward * cosine - left * sine
    state.foot[0, :, 1] = 0.7 + slopes[0] * forward + slopes[1] * left
    plane = feet_plane(0, herd.kernel_state, herd.kernel_tables)
    place = np.stack([forward - forward.mean(), left - left.mean()])
    spread = place @ place.T / len(forward)
    level = np.diag([LEVEL_LENGTH**2, LEVEL_WIDTH**2]) * herd.tables.leg_length**2
    leaned = np.linalg.solve(spread + level, spread @ np.array(slopes))
    assert (plane.slope_forward, plane.slope_left) == pytest.approx(tuple(leaned), abs=1e-12)
    mean = state.foot[0, :, 1].mean()
    height = mean - leaned @ np.array([forward.mean(), left.mean()])
    assert plane.height == pytest.approx(height, abs=1e-12)
    # The lean is small: a spider's feet say well which way the ground slopes.
    assert leaned == pytest.approx(np.array(slopes), abs=0.15 * max(map(abs, slopes)))


def test_a_landing_foot_does_not_jerk_the_plane(herd: Herd) -> None:
    """A swing foot counts as on its way, so the plane moves continuously through its swing."""
    state = herd.state
    state.position[0] = 0.0
    state.heading[0] = 0.0
    state.foot[0] = herd.tables.legs.sole_stance
    state.foot_start[0] = state.foot[0]
    state.foot_target[0] = state.foot[0] + np.array([0.0, 0.1, 0.1])
    heights = [feet_plane(0, herd.kernel_state, herd.kernel_tables).height]
    state.swinging[0, 0] = True
    for share in np.linspace(0.0, 1.0, 101):
        state.swing_progress[0, 0] = share
        heights.append(feet_plane(0, herd.kernel_state, herd.kernel_tables).height)
    state.swinging[0, 0] = False
    state.foot[0, 0] = state.foot_target[0, 0]
    heights.append(feet_plane(0, herd.kernel_state, herd.kernel_tables).height)
    most = max(abs(b - a) for a, b in pairwise(heights))
    assert heights[1] == pytest.approx(heights[0], abs=1e-15)
    assert heights[-1] == pytest.approx(heights[-2], abs=1e-15)
    assert most < 0.05 * abs(heights[-1] - heights[0])
