"""What the page draws of a creature's inside is what its walk obeys."""

from __future__ import annotations

import numpy as np
import pytest

from polypod import World, load_rig
from polypod.herd import Herd
from polypod.ik.limits import limit_excess
from polypod.studio.anatomy import limit_fans, pelvis_nodes, spine_line


@pytest.fixture(scope="module", params=["spider", "wolf"])
def herd(request: pytest.FixtureRequest) -> Herd:
    """Return a herd of one that has not walked."""
    return World().add(load_rig(request.param))


def _about(axis: np.ndarray, angle: float) -> np.ndarray:
    return np.append(np.sin(0.5 * angle) * axis, np.cos(0.5 * angle))


def test_a_fan_is_a_direction_turned_about_an_axis(herd: Herd) -> None:
    for fan in limit_fans(herd):
        axis, start = np.array(fan["axis"]), np.array(fan["from"])
        assert np.linalg.norm(axis) == pytest.approx(1.0, abs=1e-5)
        assert np.linalg.norm(start) == pytest.approx(1.0, abs=1e-5)
        assert axis @ start == pytest.approx(0.0, abs=1e-5)
        assert fan["least"] <= fan["most"]
        assert 0 <= fan["of"] <= len(herd.morphology.joint_node)


def test_a_hinge_within_its_fan_is_within_the_limits_and_beyond_it_is_not(herd: Herd) -> None:
    ik, legs = herd.tables.ik, herd.morphology.legs
    fans = {(fan["of"], tuple(fan["place"])): fan for fan in limit_fans(herd)}
    met = 0
    for leg, count in enumerate(ik.joint_count):
        for joint in range(1, int(count)):
            place = tuple(np.round(legs.point_rest[leg, joint], 6).tolist())
            fan = fans.get((int(legs.joint[leg, joint - 1]), place))
            if fan is None:
                continue
            for angle, outside in ((fan["most"], 0.0), (fan["most"] + 0.1, 0.1),
                                   (fan["least"], 0.0), (fan["least"] - 0.1, 0.1)):  # fmt: skip
                own = _about(np.array(fan["axis"]), angle)
                turned = np.tile(ik.hip_stance[leg], (int(count), 1))
                for after in range(joint, int(count)):
                    turned[after] = _multiplied(ik.hip_stance[leg], own)
                others = [i for i in range(1, int(count)) if i != joint]
                # A joint whose range is not about the rest would exceed on its own.
                if any(ik.turn_low[leg, i] > 0.0 or ik.turn_high[leg, i] < 0.0 for i in others):
                    continue
                met += 1
                excess = limit_excess(ik, leg, turned)
                assert excess == pytest.approx(outside, abs=1e-3)
    assert met > 0


def _multiplied(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    vector = a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])
    return np.append(vector, a[3] * b[3] - a[:3] @ b[:3])


def test_a_spine_is_one_line_as_long_as_its_bones(herd: Herd) -> None:
    spine, line = herd.morphology.segments, spine_line(herd.morphology)
    if len(spine.joint) == 0:
        assert line == []
        return
    places = np.array([node["place"] for node in line])
    lengths = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert lengths == pytest.approx(spine.bone_length, abs=1e-5)


def test_pelvis_nodes_lie_amid_the_hips_of_their_row(herd: Herd) -> None:
    legs, nodes = herd.morphology.legs, pelvis_nodes(herd.morphology)
    assert len(nodes) == len(set(legs.row.tolist()))
    for row, node in enumerate(nodes):
        hips = legs.point_rest[legs.row == row, 0]
        assert np.all(hips.min(axis=0) - 1e-6 <= np.array(node["place"]))
        assert np.all(np.array(node["place"]) <= hips.max(axis=0) + 1e-6)
