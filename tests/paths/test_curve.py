"""The swing path as a curve over arc length, and the time profiles on it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.config import PROFILE_BELL, PROFILE_CONSTANT
from polypod.math.vec3 import Vec3
from polypod.paths.curve import (
    LARGEST_START_SPEED,
    PATH_KNOTS,
    path_point,
    path_row,
    path_store,
    path_velocity,
    swing_progress,
)
from polypod.paths.hull import hull_curve, upper_hull
from polypod.paths.lift import place_knots, straight_plan, write_knots
from polypod.paths.scratch import lift_scratch


def arc_path(start, end, height, velocity=None, blend=0.0):
    """Return the path over the bare step-height arc, no ground asked."""
    lift = lift_scratch()
    points = straight_plan(lift, start, end)
    place_knots(lift, points, start, end, 0.05, 0.0, height)
    corners = upper_hull(lift.station, lift.arc, PATH_KNOTS, lift.hull)
    hull_curve(lift.station, lift.arc, lift.hull, corners, lift.height, lift.slope)
    row = path_store()
    still = Vec3(0.0, 0.0, 0.0)
    write_knots(lift, still if velocity is None else velocity, blend, row)
    return row


def at(row, progress):
    return np.array(path_point(row.point, row.tangent, row.fraction, int(row.count[0]), progress))


def rate(row, progress):
    return np.array(
        path_velocity(row.point, row.tangent, row.fraction, int(row.count[0]), progress)
    )


@pytest.mark.parametrize("reach", [0.0, 1e-9, 0.02, 0.4, 3.0])
def test_ends_are_exact_and_progress_is_arc_length(reach):
    start, end = Vec3(0.3, 0.1, -0.2), Vec3(0.3, 0.15, -0.2 + reach)
    row = arc_path(start, end, 0.1)
    assert tuple(at(row, 0.0)) == tuple(start)
    assert tuple(at(row, 1.0)) == tuple(end)
    points = np.array([at(row, p) for p in np.linspace(0.0, 1.0, 2001)])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    assert steps.sum() == pytest.approx(row.length[0], rel=2e-3)
    if reach >= 0.02:  # a step on the spot turns round at its top
        assert steps.max() / steps.mean() < 1.1
    # Half an ellipse over a line that rises by 0.05: its highest point in closed form.
    assert points[:, 1].max() == pytest.approx(0.125 + np.hypot(0.1, 0.025), abs=2e-4)


def test_velocity_is_the_derivative_and_continuous():
    row = arc_path(Vec3(0.0, 0.0, 0.0), Vec3(0.1, 0.05, 0.4), 0.1)
    for progress in np.linspace(0.013, 0.987, 40):
        slope = (at(row, progress + 1e-6) - at(row, progress - 1e-6)) / 2e-6
        assert rate(row, progress) == pytest.approx(slope, abs=1e-4 * row.length[0])
    for knot in row.fraction[1:-1]:
        assert rate(row, knot - 1e-9) == pytest.approx(rate(row, knot + 1e-9), abs=1e-5)


def test_feet_lift_and_land_steeply():
    row = arc_path(Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.4), 0.1)
    for progress, sign in ((0.0, 1.0), (1.0, -1.0)):
        direction = rate(row, progress) / row.length[0]
        assert sign * direction[1] > 0.98
    height = np.array([at(row, p)[1] for p in np.linspace(0.0, 1.0, 101)])
    assert height == pytest.approx(height[::-1], abs=1e-9)


def test_a_path_can_start_with_a_velocity():
    velocity = Vec3(0.2, 0.1, 0.5)
    row = arc_path(Vec3(0.0, 0.05, 0.0), Vec3(0.0, 0.0, 0.4), 0.1, velocity, 0.35)
    direction = np.array(velocity) / np.linalg.norm(velocity)
    assert rate(row, 0.0) / row.length[0] == pytest.approx(direction, abs=1e-9)
    assert tuple(at(row, 0.0)) == (0.0, 0.05, 0.0)
    assert tuple(at(row, 1.0)) == (0.0, 0.0, 0.4)


def test_rows_of_a_store_are_views():
    store = path_store(2, 3)
    path_row(store, 1, 2).count[0] = 7
    assert store.count[1, 2, 0] == 7
    assert store.count.sum() == 7


def test_bell_has_mean_one_and_peak_of_minimum_jerk():
    times = np.linspace(0.0, 1.0, 2001)
    speed = 30.0 * times**2 * (1.0 - times) ** 2  # minimum jerk
    assert np.trapezoid(speed, times) == pytest.approx(1.0, abs=1e-6)
    assert speed.max() == pytest.approx(1.875)
    progress = np.array([swing_progress(PROFILE_BELL, t, 0.0) for t in times])
    assert progress[:, 1] == pytest.approx(speed, abs=1e-12)


@given(speed=st.floats(0.0, 4.0))
@settings(max_examples=50, deadline=None)
def test_bell_starts_at_the_speed_asked_and_never_runs_back(speed):
    times = np.linspace(0.0, 1.0, 201)
    progress = np.array([swing_progress(PROFILE_BELL, t, speed) for t in times])
    assert progress[0] == pytest.approx((0.0, min(speed, LARGEST_START_SPEED)))
    assert progress[-1] == pytest.approx((1.0, 0.0), abs=1e-12)
    assert progress[:, 1].min() > -1e-9
    assert np.gradient(progress[:, 0], times)[5:-5] == pytest.approx(progress[5:-5, 1], abs=2e-3)


def test_constant_profile_is_the_paper_s():
    assert swing_progress(PROFILE_CONSTANT, 0.3, 1.7) == (0.3, 1.0)
