"""A foot turns with its heading and tilts toward the ground, up to a limit."""

from __future__ import annotations

import math

import pytest

from polypod.ik.foot import foot_rotation
from polypod.math.quat import angle_of, conjugate, from_heading, rotate
from polypod.math.vec3 import Vec3

UP = Vec3(0.0, 1.0, 0.0)


def test_on_level_ground_only_the_heading_turns_it():
    foot = foot_rotation(0.7, UP, 1.0, 0.5)
    assert angle_of(foot * conjugate(from_heading(0.7))) == pytest.approx(0.0, abs=1e-12)


def test_a_full_share_lies_flat_on_the_slope():
    normal = Vec3(math.sin(0.3), math.cos(0.3), 0.0)
    sole = rotate(foot_rotation(1.1, normal, 1.0, 0.5), UP)
    assert sole == pytest.approx(normal, abs=1e-12)


@pytest.mark.parametrize(("share", "most", "expected"), [(0.5, 1.0, 0.4), (1.0, 0.25, 0.25)])
def test_share_and_limit_bound_the_tilt(share, most, expected):
    normal = Vec3(0.0, 2.0 * math.cos(0.8), 2.0 * math.sin(0.8))
    sole = rotate(foot_rotation(-2.0, normal, share, most), UP)
    assert sole == pytest.approx(Vec3(0.0, math.cos(expected), math.sin(expected)), abs=1e-12)
