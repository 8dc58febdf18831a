"""Distances between segments, by two independent ways and by brute force."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.math.segments import segment_gap
from polypod.math.vec3 import Vec3
from polypod.report.apart import segment_distance

place = st.tuples(*[st.floats(-1.0, 1.0).map(lambda v: round(v, 3))] * 3)


def least_by_search(a, b, c, d):
    """Return the least distance over a fine net of places on both segments."""
    share = np.linspace(0.0, 1.0, 201)[:, None]
    first, second = a + (b - a) * share, c + (d - c) * share
    return float(np.linalg.norm(first[:, None] - second[None], axis=2).min())


@given(place, place, place, place)
@settings(max_examples=200, deadline=None)
def test_the_gap_is_the_least_over_both_segments(a, b, c, d):
    ends = [np.array(p) for p in (a, b, c, d)]
    gap = segment_gap(*[Vec3(*p) for p in (a, b, c, d)])
    searched = least_by_search(*ends)
    step = 0.5 * max(np.linalg.norm(ends[1] - ends[0]), np.linalg.norm(ends[3] - ends[2])) / 200
    assert searched - 2.0 * step - 1e-9 <= gap <= searched + 1e-9
    assert segment_distance(*[p[None] for p in ends])[0] == pytest.approx(gap, abs=1e-6)


@pytest.mark.parametrize(
    ("ends", "expected"),
    [
        (((0, 0, 0), (1, 0, 0), (0.5, 1, -1), (0.5, 1, 1)), 1.0),  # crossing over
        (((0, 0, 0), (1, 0, 0), (0, 0, 2), (1, 0, 2)), 2.0),  # parallel
        (((0, 0, 0), (1, 0, 0), (3, 0, 0), (4, 0, 0)), 2.0),  # in a line
        (((0, 0, 0), (1, 0, 0), (0.2, -1, 0), (0.2, 1, 0)), 0.0),  # through each other
        (((0, 0, 0), (0, 0, 0), (0, 3, 4), (0, 3, 4)), 5.0),  # two points
        (((0, 0, 0), (0, 0, 0), (-1, 2, 0), (1, 2, 0)), 2.0),  # a point and a segment
    ],
)
def test_known_gaps(ends, expected):
    assert segment_gap(*[Vec3(*map(float, p)) for p in ends]) == pytest.approx(expected)
    rows = [np.array([p], float) for p in ends]
    assert segment_distance(*rows)[0] == pytest.approx(expected)
