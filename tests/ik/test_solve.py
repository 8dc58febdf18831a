"""Inverse kinematics meets its targets, keeps its limits, and never flips."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from synthetic_legs import (
    CREATURES,
    Solver,
    around,
    make_legs,
    turns_against_parent,
)

from polypod.ik.limits import limit_excess, matrix_from_quaternion

ENOUGH = 250
LARGEST_TURN = np.radians(45.0)
NAMES = list(CREATURES)


@cache
def solver_of(name):
    return Solver(CREATURES[name]())


@pytest.mark.parametrize("name", NAMES)
def test_targets_called_reachable_are_met(name):
    solver = solver_of(name)
    rng = np.random.default_rng(1)
    for leg in range(len(solver.ik.longest)):
        targets = np.vstack(
            [solver.cycle_box(leg, ENOUGH, rng), solver.around_hip(leg, ENOUGH, rng)]
        )
        reachable = [target for target in targets if solver.reaches(leg, target)]
        assert len(reachable) > ENOUGH // 2
        worst = max(solver.solve(leg, target)[0] for target in reachable)
        assert worst < 1e-8 * solver.length(leg)


@pytest.mark.parametrize("name", NAMES)
def test_pose_changes_no_more_than_45_degrees_over_a_tenth_of_a_leg(name):
    solver = solver_of(name)
    rng = np.random.default_rng(2)
    for leg in range(0, len(solver.ik.longest)):
        count = int(solver.ik.joint_count[leg])
        length = solver.length(leg)
        starts = np.vstack(
            [
                solver.cycle_box(leg, ENOUGH, rng),
                solver.around_hip(leg, ENOUGH, rng),
                under_hip(solver, leg, rng),
            ]
        )
        tried = 0
        for start in starts:
            step = rng.normal(size=3)
            end = start + 0.1 * length * step / np.linalg.norm(step)
            if solver.reaches(leg, start) and solver.reaches(leg, end):
                tried += 1
                before = solver.solve(leg, start)[1]
                after = solver.solve(leg, end)[1]
                assert turns_against_parent(before, after, count).max() < LARGEST_TURN
                # Of one sign, so that keys between which a file interpolates are near, too.
                assert (before[:count] * after[:count]).sum(axis=1).min() > 0.7
        assert tried > ENOUGH // 2


def under_hip(solver, leg, rng):
    """Return targets [n, 3] near the vertical line under the hip, on both sides of it."""
    spread = rng.uniform(-1, 1, (ENOUGH // 2, 3)) * np.array([0.15, 0.3, 0.15])
    middle = np.array([0.0, -0.6, 0.0])
    return solver.ik.hip_rest[leg] + (spread + middle) * solver.length(leg)


@pytest.mark.parametrize("name", NAMES)
def test_small_moves_turn_little_right_up_to_full_stretch(name):
    solver = solver_of(name)
    rng = np.random.default_rng(4)
    count = int(solver.ik.joint_count[0])
    length = solver.length(0)
    tried = 0
    for start in solver.around_hip(0, 2 * ENOUGH, rng):
        outward = start - solver.ik.hip_rest[0]
        outward /= np.linalg.norm(outward)
        start = solver.ik.hip_rest[0] + outward * solver.ik.longest[0] * (1 - 1e-9)
        end = start - 0.01 * length * outward
        if solver.reaches(0, start) and solver.reaches(0, end):
            tried += 1
            turns = turns_against_parent(solver.solve(0, start)[1], solver.solve(0, end)[1], count)
            assert turns.max() < np.radians(8.0)
    assert tried > 20


finite = st.floats(allow_nan=False, allow_infinity=False)
near = st.floats(-2.0, 2.0)


@settings(max_examples=150, deadline=None)
@given(
    name=st.sampled_from(NAMES),
    leg=st.integers(0, 1),
    target=st.tuples(finite, finite, finite) | st.tuples(near, near, near),
)
def test_limits_hold_for_any_finite_target(name, leg, target):
    solver = solver_of(name)
    residual, rotation, point = solver.solve(leg, target)
    assert np.isfinite(rotation).all()
    assert np.isfinite(point).all()
    assert residual >= 0.0
    assert limit_excess(solver.ik, leg, rotation) < 1e-9
    assert np.isfinite(solver.shift(leg, target)).all()


@pytest.mark.parametrize("name", NAMES)
def test_the_hip_itself_is_a_target_like_any_other(name):
    solver = solver_of(name)
    residual, rotation, _ = solver.solve(0, solver.ik.hip_rest[0])
    assert residual == pytest.approx(solver.ik.shortest[0], rel=0.2)
    assert limit_excess(solver.ik, 0, rotation) < 1e-9


@pytest.mark.parametrize("name", NAMES)
def test_points_follow_from_rotations_and_bones_keep_their_lengths(name):
    solver = solver_of(name)
    ik = solver.ik
    rng = np.random.default_rng(5)
    for target in solver.around_hip(0, 100, rng):
        residual, rotation, point = solver.solve(0, target)
        count = int(ik.joint_count[0])
        expected = ik.hip_rest[0]
        for joint in range(count):
            assert np.allclose(point[joint], expected, rtol=0, atol=1e-12 * solver.length(0))
            assert np.linalg.norm(rotation[joint]) == pytest.approx(1.0, abs=1e-12)
            expected = expected + matrix_from_quaternion(rotation[joint]) @ ik.bone_rest[0, joint]
        assert np.allclose(point[count], expected, rtol=0, atol=1e-12 * solver.length(0))
        assert residual == pytest.approx(np.linalg.norm(expected - target), abs=1e-12)


@pytest.mark.parametrize("name", ["spider", "beetle", "mech", "lizard", "quadruped_robot"])
def test_a_bent_leg_asked_for_its_rest_stays_at_rest(name):
    solver = solver_of(name)
    legs = solver.legs
    for leg in range(len(legs.joint_count)):
        count = int(legs.joint_count[leg])
        _, rotation, _ = solver.solve(leg, legs.point_rest[leg, count])
        assert np.abs(rotation[:count, :3]).max() < 1e-9


def test_a_pose_has_no_history():
    solver = solver_of("spider")
    rng = np.random.default_rng(6)
    targets = solver.around_hip(0, 50, rng)
    first = [solver.solve(0, target)[1].tobytes() for target in targets]
    again = [solver.solve(0, target)[1].tobytes() for target in targets[::-1]][::-1]
    assert first == again


@pytest.mark.parametrize("name", NAMES)
def test_mirrored_legs_take_mirrored_poses(name):
    solver = solver_of(name)
    half = len(solver.ik.longest) // 2
    rng = np.random.default_rng(7)
    if name == "radial_robot":
        half = 2
    for leg in range(half):
        for target in solver.cycle_box(leg, 60, rng):
            here = solver.solve(leg, target)
            there = solver.solve(leg + half, target * [-1, 1, 1])
            assert np.allclose(here[2] * [-1, 1, 1], there[2], rtol=0, atol=1e-12)
            assert np.allclose(here[1] * [1, -1, -1, 1], there[1], rtol=0, atol=1e-12)


def test_radial_legs_turn_alike():
    leg = [(0, 0.1, 0.2), (0, 0.4, 0.5), (0, 0.3, 0.9), (0, -0.5, 1.1)]
    headings = 2.0 * np.pi * np.arange(5) / 5
    solver = Solver(make_legs(around(leg, headings), upright=False))
    rng = np.random.default_rng(8)
    for target in solver.cycle_box(0, 60, rng):
        first = solver.solve(0, target)[2]
        for k, heading in enumerate(headings):
            turn = around([(0, 0, 1), (0, 1, 0), (1, 0, 0)], [heading])[0]
            matrix = np.array(turn[::-1]).T
            other = solver.solve(k, matrix @ target)[2]
            assert np.allclose(first @ matrix.T, other, rtol=0, atol=1e-12)


def test_size_does_not_matter():
    small = solver_of("spider")
    legs = small.legs
    for scale in (1e-3, 30.0):
        big = Solver(
            legs._replace(
                point_rest=legs.point_rest * scale,
                sole_rest=legs.sole_rest * scale,
                sole_stance=legs.sole_stance * scale,
                length=legs.length * scale,
            )
        )
        rng = np.random.default_rng(9)
        for target in small.cycle_box(0, 40, rng):
            same = np.abs(small.solve(0, target)[1] - big.solve(0, target * scale)[1]).max()
            assert same < 1e-9
