"""How feet roll: found from their skin, so that nothing sinks while they do."""

from __future__ import annotations

import math

import numpy as np
import pytest

from polypod.morphology.load import load_rig
from polypod.morphology.roll import FLAT, HEEL_FIRST, STEEPEST_ROLL, SUNK, TOE_FIRST
from polypod.report.skin import flesh_of


@pytest.mark.parametrize(
    ("rig", "kind"),
    [("wolf", TOE_FIRST), ("biped", HEEL_FIRST), ("spider", FLAT), ("pentapod", FLAT)],
)
def test_kinds(rig, kind):
    legs = load_rig(rig).legs
    assert (legs.roll_kind == kind).all()
    if kind == FLAT:
        assert (legs.foot_behind == 0.0).all()
        assert np.array_equal(legs.roll_pivot, legs.sole_rest)
    else:
        assert (legs.foot_behind > 0.03 * legs.length).all()
        assert (legs.foot_behind < legs.foot_half_size[:, 1]).all()


def test_no_skin_of_a_paw_sinks_when_it_rolls():
    wolf = load_rig("wolf")
    legs = wolf.legs
    surfaces = flesh_of(wolf)
    for k, joint in enumerate(legs.foot_joint):
        away = np.concatenate(
            [
                flesh.place[(flesh.weight * (flesh.row == joint)).sum(axis=1) >= 0.5, 0]
                for flesh in surfaces
            ]
        )
        away = away - legs.sole_rest[k]
        assert len(away) > 20
        for angle in np.linspace(0.0, STEEPEST_ROLL, 10):
            height = away[:, 1] * math.cos(angle) - away[:, 2] * math.sin(angle)
            assert height.min() > -1.01 * SUNK * legs.length[k]


def test_a_joint_for_the_toes_is_what_a_foot_rolls_about():
    biped = load_rig("biped")
    legs = biped.legs
    for k, row in enumerate(legs.toe_joint):
        assert "Toes" in biped.joint_name[row]
        assert legs.roll_pivot[k] == pytest.approx(biped.joint_rest[row])
        # The sole is below it, and fixed to it: the toes stay flat.
        assert legs.sole_rest[k, 2] == pytest.approx(biped.joint_rest[row, 2])
        assert biped.foot_node[k] == biped.joint_node[row]
