"""The curve over the requirement is never below the requirement's hull."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.math.vec3 import Vec3
from polypod.paths.curve import PATH_KNOTS, path_point, path_store
from polypod.paths.hull import hull_curve, upper_hull
from polypod.paths.lift import write_knots
from polypod.paths.scratch import lift_scratch

needs = st.lists(st.floats(0.0, 1.0), min_size=PATH_KNOTS, max_size=PATH_KNOTS)
gaps = st.lists(st.floats(0.002, 0.2), min_size=PATH_KNOTS - 1, max_size=PATH_KNOTS - 1)


def brute_hull(station, need):
    """Return the upper hull at every station: the highest chord over it."""
    top = need.copy()
    for i in range(len(station)):
        for j in range(i + 1, len(station)):
            inside = slice(i, j + 1)
            chord = np.interp(station[inside], station[[i, j]], need[[i, j]])
            top[inside] = np.maximum(top[inside], chord)
    return top


@given(need=needs, gap=gaps)
@settings(max_examples=100, deadline=None)
def test_hull_against_all_chords_and_curve_above_it(need, gap):
    need = np.array(need)
    station = np.concatenate([[0.0], np.cumsum(gap)])
    hull = np.zeros(PATH_KNOTS, np.int64)
    corners = upper_hull(station, need, PATH_KNOTS, hull)
    top = brute_hull(station, need)
    kept = hull[:corners]
    assert kept[0] == 0
    assert kept[-1] == PATH_KNOTS - 1
    assert np.abs(np.interp(station, station[kept], need[kept]) - top).max() < 1e-9
    height, slope = np.zeros(PATH_KNOTS), np.zeros(PATH_KNOTS)
    hull_curve(station, need, hull, corners, height, slope)
    assert (height >= top - 1e-9).all()
    assert np.abs(height[kept] - need[kept]).max() < 1e-12
    sides = np.diff(need[kept]) / np.diff(station[kept])
    assert (slope[kept[1:-1]] <= sides[:-1] + 1e-9).all()
    assert (slope[kept[1:-1]] >= sides[1:] - 1e-9).all()


def test_space_curve_stays_above_a_wall_beside_its_start():
    lift = lift_scratch()
    lift.station[:] = 0.2 * (1.0 - np.cos(np.linspace(0.0, np.pi, PATH_KNOTS)))
    lift.need[:] = np.where((lift.station > 0.01) & (lift.station < 0.2), 0.3, 0.0)
    lift.knot[:, 1] = lift.station
    lift.knot[:, 3] = 1.0
    corners = upper_hull(lift.station, lift.need, PATH_KNOTS, lift.hull)
    hull_curve(lift.station, lift.need, lift.hull, corners, lift.height, lift.slope)
    row = path_store()
    write_knots(lift, Vec3(0.0, 0.0, 0.0), 0.0, row)
    top = brute_hull(lift.station, lift.need)
    points = np.array(
        [
            path_point(row.point, row.tangent, row.fraction, PATH_KNOTS, p)
            for p in np.linspace(0.0, 1.0, 800)
        ]
    )
    above = points[:, 1] - np.interp(points[:, 2], lift.station, top)
    assert above.min() > -1e-3 * 0.3
    # A bound on the overshoot keeps "raise everything a lot" from passing.
    assert points[:, 1].max() < 0.3 * 1.35
