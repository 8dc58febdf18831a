"""Animations are played as glTF 2.0 (3.11 and appendix C) says."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sample_rigs import SampleFile, two_joint_rig

from polypod.errors import RigError
from polypod.rigs.gltf import GltfDocument
from polypod.rigs.playback import Playback


def animated(path: str, times: list[float], values: Any, mode: str = "LINEAR") -> SampleFile:
    sample = two_joint_rig()
    sampler = {"input": sample.accessor(times), "output": sample.accessor(values)}
    sample.json["animations"] = [
        {
            "channels": [{"sampler": 0, "target": {"node": 0, "path": path}}],
            "samplers": [sampler | {"interpolation": mode}],
        }
    ]
    return sample


def hip_heights(sample: SampleFile, times: list[float]) -> np.ndarray:
    return Playback(sample.document()).world_matrices(np.array(times))[:, 0, 1, 3]


def test_linear_holds_both_ends_and_mixes_between() -> None:
    sample = animated("translation", [1.0, 2.0, 4.0], [[0, 1, 0], [0, 2, 0], [0, 6, 0]])
    found = hip_heights(sample, [0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 9.0])
    np.testing.assert_allclose(found, [1.0, 1.0, 1.5, 2.0, 4.0, 6.0, 6.0])


def test_step_jumps_at_the_key() -> None:
    sample = animated("translation", [0.0, 1.0], [[0, 1, 0], [0, 2, 0]], "STEP")
    np.testing.assert_allclose(hip_heights(sample, [0.0, 0.99, 1.0, 2.0]), [1, 1, 2, 2])


def test_cubic_spline_follows_its_tangents() -> None:
    flat, up = [0, 0, 0], [0, 1, 0]
    keys = [flat, flat, up, up, [0, 2, 0], flat]
    sample = animated("translation", [0.0, 2.0], keys, "CUBICSPLINE")
    # With tangents of 1 a second and a rise of 2 in 2 seconds, the spline is the straight line.
    np.testing.assert_allclose(hip_heights(sample, [0.0, 0.5, 1.0, 2.0]), [0, 0.5, 1, 2])


def test_rotations_take_the_shorter_arc_at_even_speed() -> None:
    quarter = np.sqrt(0.5)
    sample = animated("rotation", [0.0, 1.0], [[0, 0, 0, 1], [-quarter, 0, 0, -quarter]])
    world = Playback(sample.document()).world_matrices(np.array([1 / 3]))
    turn = np.deg2rad(30.0)
    np.testing.assert_allclose(world[0, 1, :3, 3], [0, 1 - np.cos(turn), -np.sin(turn)], atol=1e-7)


def test_children_ride_and_others_rest() -> None:
    sample = animated("translation", [0.0], [[5, 1, 0]])
    document = sample.document()
    world = Playback(document).world_matrices(np.array([0.0, 3.0]))
    np.testing.assert_allclose(world[:, 1, :3, 3], [[5, 0, 0], [5, 0, 0]], atol=1e-7)
    np.testing.assert_array_equal(world[0, 2], document.node_world_matrices()[2])


@pytest.mark.parametrize(
    ("times", "values", "mode", "expected"),
    [
        ([1.0, 1.0], [[0, 0, 0]] * 2, "LINEAR", "times that rise"),
        ([0.0, np.nan], [[0, 0, 0]] * 2, "LINEAR", "times that rise"),
        ([0.0, 1.0], [[0, 0, 0]] * 3, "LINEAR", "must hold 2 finite values"),
        ([0.0, 1.0], [[0, np.inf, 0]] * 2, "LINEAR", "must hold 2 finite values"),
        ([0.0, 1.0], [[0, 0, 0]] * 2, "CUBICSPLINE", "must hold 6 finite values"),
        ([0.0, 1.0], [[0, 0, 0]] * 2, "BOUNCE", "must be one of LINEAR, STEP, CUBICSPLINE"),
    ],
)
def test_bad_samplers_are_named(times: list[float], values: Any, mode: str, expected: str) -> None:
    sample = animated("translation", times, values, mode)
    with pytest.raises(RigError, match=expected):
        hip_heights(sample, [0.5])


def test_a_rotation_of_length_zero_is_named() -> None:
    sample = animated("rotation", [0.0], [[0, 0, 0, 0]])
    with pytest.raises(RigError, match="rotation of length zero"):
        hip_heights(sample, [0.0])


def test_no_such_animation() -> None:
    with pytest.raises(RigError, match="animations has no number -1: there are 0"):
        Playback(two_joint_rig().document())


def test_real_clip_moves_its_joints(shared_rig: Callable[[str], Path]) -> None:
    document = GltfDocument.read(shared_rig("khronos_fox/Fox.glb"))
    walk = Playback(document, 1)
    assert walk.end == pytest.approx(0.708, abs=1e-3)
    world = walk.world_matrices(np.linspace(walk.start, walk.end, 9))
    feet = [document.node_names().index(name) for name in ("b_LeftHand_011", "b_RightHand_08")]
    assert (np.ptp(world[:, feet, 2, 3], axis=0) > 10.0).all()
