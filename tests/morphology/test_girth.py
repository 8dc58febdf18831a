"""How thick legs are: from their skin, and never more than the rest pose leaves room for."""

from __future__ import annotations

import numpy as np
import pytest

from polypod.ik.table import build_ik_table
from polypod.morphology.builtin import NAMES
from polypod.morphology.load import load_rig
from polypod.report.apart import segment_distance


@pytest.mark.parametrize("rig", NAMES)
def test_legs_at_rest_are_not_inside_one_another(rig):
    legs = load_rig(rig).legs
    count = build_ik_table(legs).joint_count
    for a in range(len(count)):
        for b in range(a + 1, len(count)):
            for i in range(count[a]):
                for j in range(count[b]):
                    ends = legs.point_rest[a, i : i + 2], legs.point_rest[b, j : j + 2]
                    gap = segment_distance(*[end[None] for pair in ends for end in pair])[0]
                    assert gap >= legs.section_radius[a, i] + legs.section_radius[b, j] - 1e-9


@pytest.mark.parametrize("rig", NAMES)
def test_each_section_has_a_thickness_and_sides_are_alike(rig):
    legs = load_rig(rig).legs
    for k, count in enumerate(legs.joint_count):
        sections = count + (legs.foot_joint[k] >= 0)
        assert (legs.section_radius[k, :sections] > 0.0).all()
        assert (legs.section_radius[k, :sections] < 0.2 * legs.length[k]).all()
        assert (legs.section_radius[k, sections:] == 0.0).all()
    for row in np.unique(legs.row[legs.side > 0]):
        left = legs.section_radius[(legs.row == row) & (legs.side > 0)]
        right = legs.section_radius[(legs.row == row) & (legs.side < 0)]
        assert left == pytest.approx(right, rel=0.05)
