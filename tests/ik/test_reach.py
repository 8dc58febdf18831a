"""The least move that brings a target within reach agrees with what the solver meets."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from synthetic_legs import CREATURES, Solver

from polypod.ik.limits import limit_excess


@cache
def solver_of(name):
    return Solver(CREATURES[name]())


@pytest.mark.parametrize("name", CREATURES)
def test_shifted_targets_are_met_and_left_alone(name):
    solver = solver_of(name)
    rng = np.random.default_rng(1)
    for leg in range(len(solver.ik.longest)):
        length = solver.length(leg)
        for target in solver.around_hip(leg, 150, rng):
            moved = target + solver.shift(leg, target)
            assert np.linalg.norm(solver.shift(leg, moved)) < 1e-12 * length
            assert solver.solve(leg, moved)[0] < 1e-8 * length


@pytest.mark.parametrize("name", CREATURES)
def test_a_target_too_far_out_moves_straight_in(name):
    solver = solver_of(name)
    hip = solver.ik.hip_rest[0]
    away = solver.ik.effector_stance[0] - hip
    away /= np.linalg.norm(away)
    for wanted in (1.2 * solver.ik.longest[0], 40.0 * solver.ik.longest[0]):
        expected = away * (solver.ik.longest[0] - wanted)
        assert np.allclose(solver.shift(0, hip + away * wanted), expected, rtol=1e-9, atol=0.0)
    inner = 0.5 * solver.ik.shortest[0]
    expected = away * (solver.ik.shortest[0] - inner)
    assert np.allclose(solver.shift(0, hip + away * inner), expected, rtol=1e-9, atol=0.0)


@pytest.mark.parametrize("name", ["spider", "wolf", "lizard", "mech"])
def test_the_move_is_about_the_least(name):
    """No place within reach among many is much nearer than the one chosen."""
    solver = solver_of(name)
    rng = np.random.default_rng(2)
    length = solver.length(0)
    places = solver.around_hip(0, 4000, rng)
    inside = np.array([place for place in places if solver.reaches(0, place)])
    outside = [place for place in places[:400] if not solver.reaches(0, place)]
    ratios = []
    for target in outside:
        shift = np.linalg.norm(solver.shift(0, target))
        nearest = np.linalg.norm(inside - target, axis=1).min()
        if 0.02 * length < shift < 0.3 * length:
            ratios.append(shift / nearest)
    assert len(ratios) > 20
    assert np.mean(ratios) < 1.1
    assert max(ratios) < 2.0


@pytest.mark.parametrize("name", CREATURES)
def test_most_of_a_cycle_around_a_bent_stance_is_within_reach(name):
    solver = solver_of(name)
    rng = np.random.default_rng(3)
    stance = np.linalg.norm(solver.ik.effector_stance[0] - solver.ik.hip_rest[0])
    inside = [solver.reaches(0, t) for t in solver.cycle_box(0, 400, rng)]
    # A box of +-20 % about a stance at 85 % or more sticks out of any leg's reach.
    assert np.mean(inside) > (0.9 if stance < 0.72 * solver.length(0) else 0.5)


def test_limits_are_measured_in_radians():
    solver = solver_of("wolf")
    ik = solver.ik
    _, rotation, _ = solver.solve(0, ik.effector_stance[0])
    assert limit_excess(ik, 0, rotation) == pytest.approx(0.0, abs=1e-12)

    def turned_about(axis, angle, joints):
        half = 0.5 * angle
        turn = np.append(np.sin(half) * np.asarray(axis), np.cos(half))
        out = rotation.copy()
        for joint in joints:
            a, b = turn, rotation[joint]
            out[joint, :3] = a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])
            out[joint, 3] = a[3] * b[3] - a[:3] @ b[:3]
        return out

    everything = range(3)
    past = ik.hip_limit[0] + 0.1
    assert limit_excess(ik, 0, turned_about(ik.flexion_axis[0], past[0], everything)) == (
        pytest.approx(0.1, abs=1e-9)
    )
    sideways = np.cross(ik.limb_axis[0], ik.flexion_axis[0])
    assert limit_excess(ik, 0, turned_about(sideways, past[1], everything)) == (
        pytest.approx(0.1, abs=1e-9)
    )
    assert limit_excess(ik, 0, turned_about(ik.limb_axis[0], past[2], everything)) == (
        pytest.approx(0.1, abs=1e-9)
    )
    # The stance is the rest here: the last hinge is turned in and out about its axis at rest.
    axis = ik.axis[0, 2]
    assert limit_excess(ik, 0, turned_about(axis, ik.turn_low[0, 2] - 0.2, [2])) == (
        pytest.approx(0.2, abs=1e-9)
    )
    assert limit_excess(ik, 0, turned_about(axis, ik.turn_high[0, 2] + 0.2, [2])) == (
        pytest.approx(0.2, abs=1e-9)
    )
    assert limit_excess(ik, 0, turned_about([0, 1, 0], 0.3, [2])) > 0.25
