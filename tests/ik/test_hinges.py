"""Which way each joint bends, what it may do, and how far a leg reaches."""

from __future__ import annotations

import numpy as np
import pytest
from synthetic_legs import (
    CREATURES,
    Solver,
    around,
    both_sides,
    horse_fore,
    human,
    make_legs,
    pegs,
    radial_robot,
    spider,
    wolf,
)

from polypod.ik.limits import limit_excess
from polypod.ik.table import build_ik_table, guesses


def knee_offset(legs, leg, joint=1, lift=0.15):
    """Return where a joint is against the line from hip to effector, raised a little [3]."""
    solver = Solver(legs)
    target = solver.ik.effector_stance[leg] + np.array([0, lift * solver.length(leg), 0])
    _, _, point = solver.solve(leg, target)
    end = point[legs.joint_count[leg]]
    line = (end - point[0]) / np.linalg.norm(end - point[0])
    offset = point[joint] - point[0]
    return (offset - line * (offset @ line)) / solver.length(leg)


def test_knees_of_straight_legs_go_forward_and_elbows_back():
    assert knee_offset(human(), 0)[2] > 0.1
    assert knee_offset(human(), 1)[2] > 0.1
    assert knee_offset(wolf(), 1)[2] < -0.1
    assert knee_offset(wolf(), 3)[2] < -0.1


def test_a_low_hinge_of_a_straight_fore_leg_is_a_wrist_and_goes_forward():
    assert knee_offset(horse_fore(), 1)[2] > 0.1


@pytest.mark.parametrize("make", [spider, radial_robot])
def test_knees_of_sprawlers_go_up(make):
    legs = make()
    for leg in range(len(legs.joint_count)):
        assert knee_offset(legs, leg, joint=legs.joint_count[leg] - 1)[1] > 0.1


def test_bends_at_rest_decide_over_guesses():
    hind = wolf()
    assert knee_offset(hind, 0, joint=1)[2] > 0.05
    assert knee_offset(hind, 0, joint=2)[2] < -0.05
    assert not build_ik_table(hind).guessed[0].any()


def test_a_small_bend_of_an_erect_leg_tells_wrist_from_elbow():
    for bulge, sign in ((0.035, 1.0), (-0.035, -1.0)):
        hind = [(0.1, 0, -0.4), (0.1, -0.4, -0.3), (0.1, -0.9, -0.4)]
        fore = [(0.1, 0, 0.4), (0.1, -0.45, 0.4 + bulge), (0.1, -0.9, 0.4)]
        chains = both_sides([hind, fore])
        legs = make_legs(chains, row=[0, 1, 0, 1])
        assert sign * knee_offset(legs, 1)[2] > 0.1


def test_a_small_bend_of_a_stretched_sprawler_does_not_turn_its_knee_sideways():
    chain = [(0.1, 0, 0), (0.5, 0, 0.03), (0.9, 0, 0), (1.3, 0, 0)]
    stance = [(0.9, -0.5, 0), (-0.9, -0.5, 0)]
    legs = make_legs(both_sides([chain]), stance=stance, upright=False)
    assert knee_offset(legs, 0)[1] > 0.1
    assert abs(knee_offset(legs, 0)[2]) < 0.05


def test_guesses_are_told_by_foot():
    told = guesses(build_ik_table(wolf()), ["HindL", "ForeL", "HindR", "ForeR"])
    assert len(told) == 2
    assert "ForeL" in told[0]
    assert "ForeR" in told[1]
    assert all("back" in sentence for sentence in told)
    assert "forward" in guesses(build_ik_table(human()), ["L", "R"])[0]
    assert "up" in guesses(build_ik_table(radial_robot()), list("abcd"))[0]


def test_a_small_frontal_bend_of_an_erect_leg_is_a_spread_not_a_hinge():
    chain = [(0.1, 0, 0), (0.25, -0.45, 0.0), (0.28, -0.9, 0.0)]
    legs = make_legs(both_sides([chain]), stance=[(0.28, -0.8, 0), (-0.28, -0.8, 0)])
    assert knee_offset(legs, 0)[2] > 0.1


@pytest.mark.parametrize("name", CREATURES)
def test_reach_is_ordered_and_short_of_straight(name):
    ik = build_ik_table(CREATURES[name]())
    assert (ik.shortest > 0.0).all()
    assert (ik.shortest < ik.comfortable).all()
    assert (ik.comfortable < ik.longest).all()
    assert (ik.longest <= 0.97 * ik.chain_length * (1 + 1e-12)).all()
    assert (np.diff(ik.fold_of_reach, axis=1) < 0.0).all()


@pytest.mark.parametrize("name", CREATURES)
def test_travel_ends_are_within_reach(name):
    solver = Solver(CREATURES[name]())
    ik = solver.ik
    assert (ik.stance_travel_least <= ik.stance_travel).all()
    assert (ik.stance_travel_least > 0.2 * ik.chain_length).all()
    for leg in range(len(ik.longest)):
        for sign in (1.0, -1.0):
            half = np.array([0, 0, sign * 0.5 * ik.stance_travel[leg]])
            assert solver.reaches(leg, ik.effector_stance[leg] + half)


def test_limits_given_are_kept_and_shorten_the_reach():
    chain = [(0.1, 0, 0), (0.1, -0.4, 0.2), (0.1, -0.8, 0.0)]
    free = Solver(make_legs(both_sides([chain])))
    narrow = np.radians([-20.0, 30.0])
    held = Solver(make_legs(both_sides([chain]), bend_limit=narrow, hip_limit=[0.5, 0.2, 0.2]))
    assert held.ik.longest[0] < free.ik.longest[0]
    assert held.ik.shortest[0] > free.ik.shortest[0]
    rng = np.random.default_rng(3)
    for target in held.around_hip(0, 200, rng):
        _, rotation, _ = held.solve(0, target)
        assert limit_excess(held.ik, 0, rotation) < 1e-9
    assert limit_excess(held.ik, 0, free.solve(0, free.ik.hip_rest[0] + [0, -0.5, 0])[1]) > 0.05


def test_stiff_legs_of_one_joint_aim():
    solver = Solver(pegs())
    length = solver.length(0)
    assert solver.ik.shortest[0] == solver.ik.longest[0] == pytest.approx(length, rel=1e-12)
    target = solver.ik.hip_rest[0] + length * np.array([0.1, -0.9, np.sqrt(0.18)])
    assert solver.solve(0, target)[0] < 1e-9 * length
    assert np.linalg.norm(solver.shift(0, solver.ik.hip_rest[0] + [0, -0.4, 0])) == pytest.approx(
        length - 0.4, rel=1e-6
    )


def test_coincident_pivots_do_no_harm():
    chain = [(0.2, 0, 0), (0.2, 0, 0), (0.6, 0.2, 0), (0.9, -0.4, 0)]
    solver = Solver(make_legs(both_sides([chain]), upright=False))
    residual, rotation, _ = solver.solve(0, solver.ik.effector_stance[0] + [0, 0.05, 0.1])
    assert residual < 1e-9
    assert np.isfinite(rotation).all()


def test_a_leg_made_straight_down_still_folds_outward():
    chain = around([(0, 0, 0.1), (0, -0.5, 0.1), (0, -1.0, 0.1)], np.radians([60, 120]))
    stance = [(1.5 * x, -0.7, 1.5 * z) for x, _, z in (c[-1] for c in chain)]
    solver = Solver(
        make_legs(
            both_sides(chain), stance=stance + [(-x, y, z) for x, y, z in stance], upright=False
        )
    )
    _, _, point = solver.solve(0, solver.ik.effector_stance[0])
    assert point[1, 0] > point[0, 0]
