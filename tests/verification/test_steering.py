"""Steering against what its equations say in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest

from polypod.body.push import NO_DEFLECTION
from polypod.config import Settings
from polypod.controller.steering import CYCLE, PREDICTION_STEPS, PlanPose, predict, steer
from polypod.herd import Herd
from polypod.morphology.load import load_rig

REST = PlanPose(*[0.0] * 9, NO_DEFLECTION, 0.0)._replace(pace=1.0)


@pytest.fixture(scope="module")
def herd() -> Herd:
    return Herd(load_rig("spider"), 1, Settings())


@pytest.fixture(autouse=True)
def _at_rest(herd: Herd) -> None:
    herd.command.speed = 0.0
    herd.command.heading = 0.0
    herd.command.travel = 0.0
    herd.command.arrays.waypoint_count[:] = 0


def step(herd: Herd, pose: PlanPose, dt: float) -> PlanPose:
    tables, settings = herd.kernel_tables, herd.kernel_settings
    return steer(pose, 0, herd.kernel_state, herd.kernel_command, tables, settings, dt, 1.0)


def ahead(herd: Herd, pose: PlanPose, seconds: float) -> PlanPose:
    tables, settings = herd.kernel_tables, herd.kernel_settings
    return predict(pose, seconds, 0, herd.kernel_state, herd.kernel_command, tables, settings)


def acceleration(herd: Herd) -> float:
    """Return the bound: a share of the speed asked for in a usual gait cycle."""
    asked = float(herd.command.speed[0])
    return herd.settings.acceleration * asked / (CYCLE * herd.tables.pendulum_time)


def test_it_gains_speed_evenly_and_keeps_what_was_asked(herd: Herd) -> None:
    herd.command.speed = 0.5
    gain, dt, pose = acceleration(herd), 1e-3, REST
    steps = round(2.0 * 0.5 / gain / dt)
    for n in range(1, steps + 1):
        pose = step(herd, pose, dt)
        assert pose.speed == pytest.approx(min(gain * n * dt, 0.5), rel=1e-9)
    rise = 0.5 / gain
    assert pose.z == pytest.approx(0.5 * steps * dt - 0.5 * rise * 0.5, rel=1e-3)
    assert (pose.x, pose.heading) == (0.0, 0.0)


def test_it_stops_at_the_last_waypoint_in_the_distance_of_even_braking(herd: Herd) -> None:
    # Asked is sqrt(a left): braking at a / 2, which begins v^2 / a before the end.
    speed, end = 0.5, 3.0
    herd.command.speed = speed
    herd.command.set_path([[0.0, 0.0], [0.0, end]], 0)
    gain, dt = acceleration(herd), 1e-3
    pose, begins = REST._replace(waypoint=1.0), math.nan
    for _ in range(15_000):
        before, pose = pose, step(herd, pose, dt)
        if math.isnan(begins) and before.speed == speed and pose.speed < speed:
            begins = before.z
        if 0.02 < pose.speed < 0.98 * speed and pose.z > 2.0:
            assert (before.speed - pose.speed) / dt == pytest.approx(0.5 * gain, rel=0.05)
        assert pose.z <= end + 1e-5
    assert end - begins == pytest.approx(speed**2 / gain, rel=0.01)
    assert pose.z == pytest.approx(end, abs=1e-4)
    assert pose.speed == pytest.approx(0.0, abs=1e-6)


def test_a_far_turn_runs_up_to_the_rate_that_the_settings_allow(herd: Herd) -> None:
    herd.command.heading = 3.0
    pendulum = herd.tables.pendulum_time
    limit = herd.settings.turn_rate / pendulum
    response = herd.settings.turn_response * pendulum
    for dt in (1e-3, 1 / 120, 1 / 30):
        pose = REST
        for n in range(1, round(1.0 / dt)):
            pose = step(herd, pose, dt)
            # Saturated: the same at every frame rate.
            assert pose.turn_rate == pytest.approx(
                limit * (1.0 - math.exp(-4.0 * n * dt / response)), rel=1e-9
            )


def test_a_small_error_of_heading_dies_out_critically_damped(herd: Herd) -> None:
    herd.command.heading = error = 0.05
    response = herd.settings.turn_response * herd.tables.pendulum_time
    dt, pose = 1e-4, REST
    for n in range(1, round(3.0 * response / dt)):
        pose = step(herd, pose, dt)
        left = error * (1.0 + 2.0 * n * dt / response) * math.exp(-2.0 * n * dt / response)
        assert error - pose.heading == pytest.approx(left, abs=1e-3 * error)
        assert pose.heading <= error


def test_a_steady_turn_is_a_circle_of_speed_over_turn_rate(herd: Herd) -> None:
    herd.command.speed = 0.4
    pose, dt = REST, 1 / 120
    places = []
    for n in range(4000):
        # Keep asking for the same error, small enough that it does not slow down.
        herd.command.heading = pose.heading + 0.3
        pose = step(herd, pose, dt)
        if n > 1000:
            places.append((pose.x, pose.z))
    points = np.array(places)
    radius = pose.speed / pose.turn_rate
    # A circle through all points by least squares: x^2 + z^2 = 2 a x + 2 b z + c.
    system = np.column_stack([2.0 * points, np.ones(len(points))])
    a, b, c = np.linalg.lstsq(system, (points**2).sum(axis=1), rcond=None)[0]
    assert math.sqrt(c + a * a + b * b) == pytest.approx(radius, rel=1e-4)


@pytest.mark.parametrize("travel", [0.0, 0.5 * math.pi, -0.7])
def test_it_goes_where_it_travels_and_faces_where_it_heads(herd: Herd, travel: float) -> None:
    herd.command.speed = 0.4
    herd.command.travel = travel
    pose = REST
    for _ in range(300):
        pose = step(herd, pose, 1 / 60)
    assert math.atan2(pose.x, pose.z) == pytest.approx(travel, abs=1e-12)
    assert pose.heading == 0.0


def test_prediction_is_steering_applied_ahead(herd: Herd) -> None:
    herd.command.speed = 0.6
    herd.command.set_path([[0.0, 0.0], [0.5, 1.5], [-1.0, 2.5]], 0)
    pose = REST._replace(x=0.1, z=0.2, heading=0.3, turn_rate=-0.4, speed=0.5, waypoint=1.0)
    stepped = pose
    for _ in range(PREDICTION_STEPS):
        stepped = step(herd, stepped, 0.8 / PREDICTION_STEPS)
    assert ahead(herd, pose, 0.8) == stepped
    assert ahead(herd, pose, 0.0) == pose


def test_prediction_is_where_frames_will_bring_it(herd: Herd) -> None:
    herd.command.speed = 0.5
    herd.command.heading = 1.2
    leg = herd.tables.leg_length
    pose = REST._replace(heading=0.2, turn_rate=0.1, speed=0.4)
    for seconds in (0.2, 0.5, 0.8):
        stepped, frames = pose, round(seconds * 120)
        for _ in range(frames):
            stepped = step(herd, stepped, seconds / frames)
        predicted = ahead(herd, pose, seconds)
        gap = math.hypot(predicted.x - stepped.x, predicted.z - stepped.z)
        assert gap < 0.05 * leg
        assert predicted.heading == pytest.approx(stepped.heading, abs=0.05)
