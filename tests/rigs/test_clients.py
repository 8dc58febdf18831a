"""Real clients read the written GLB and put every joint where the record says."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from client_runs import blender_positions, three_positions, validator_errors
from PIL import Image
from sample_rigs import as_gltf_folder, morphology_of, nasty_rig, random_walk, two_joint_rig

from polypod.morphology.builtin import NAMES
from polypod.morphology.load import load_rig
from polypod.report.record import Recording
from polypod.rigs.export import write_glb
from polypod.rigs.gltf import GltfDocument

REAL_RIGS = {
    "khronos_fox/Fox.glb": 0.01,
    "quaternius/spider.glb": 0.2,
    "quaternius/horse.glb": 0.4,
    "quaternius/triceratops.glb": 0.4,
    "quaternius/mech_george.glb": 0.3,
    "spider_bot/spider_bot_model.gltf": 0.1,
}
SAMPLES: dict[str, Callable[[], Any]] = {"nasty": nasty_rig, "two joints": two_joint_rig}
FRAMES = [0, 1, 7, 18, 29]
# Of the largest coordinate, as the issue of clients asks.
TOLERANCE = 1e-5

Positions = Callable[[Path, np.ndarray, np.ndarray], np.ndarray]


def worst_miss(positions: Positions, path: Path, recording: Recording) -> float:
    """The largest distance between client and record, as a share of the largest coordinate."""
    nodes = recording.morphology.joint_node
    found = positions(path, recording.time[FRAMES], nodes)
    wanted = recording.joint_position[FRAMES]
    assert found.shape == wanted.shape
    assert len(nodes) > 0
    return float(np.abs(found - wanted).max() / np.abs(wanted).max())


def walk_of(document: GltfDocument, metres_per_unit: float, folder: Path) -> tuple[Recording, Path]:
    recording = random_walk(morphology_of(document, metres_per_unit), frames=30, far=5.0)
    path = folder / "walk.glb"
    write_glb(recording, path)
    return recording, path


@pytest.mark.parametrize("name", SAMPLES)
def test_samples_in_node(name: str, tmp_path: Path) -> None:
    sample = SAMPLES[name]()
    (tmp_path / "in.glb").write_bytes(sample.glb())
    recording, path = walk_of(GltfDocument.read(tmp_path / "in.glb"), 0.01, tmp_path)
    before, after = validator_errors([tmp_path / "in.glb", path])
    assert before == {}
    assert after == {}
    assert worst_miss(three_positions, path, recording) < TOLERANCE


def test_outside_files_pass_the_validator(tmp_path: Path) -> None:
    Image.new("RGB", (2, 2)).save(tmp_path / "image.png")
    source = as_gltf_folder(nasty_rig(), tmp_path, (tmp_path / "image.png").read_bytes())
    out = tmp_path / "out"
    out.mkdir()
    _, path = walk_of(GltfDocument.read(source), 0.01, out)
    assert validator_errors([source, path]) == [{}, {}]


@pytest.mark.parametrize("name", REAL_RIGS)
def test_real_rigs_in_node(name: str, shared_rig: Callable[[str], Path], tmp_path: Path) -> None:
    source = shared_rig(name)
    recording, path = walk_of(GltfDocument.read(source), REAL_RIGS[name], tmp_path)
    before, after = validator_errors([source, path])
    assert all(after[code] <= before.get(code, 0) for code in after)
    assert worst_miss(three_positions, path, recording) < TOLERANCE


@pytest.mark.parametrize("name", NAMES)
def test_built_in_creatures_in_node(name: str, tmp_path: Path) -> None:
    recording = random_walk(load_rig(name), frames=30, far=5.0)
    path = tmp_path / "walk.glb"
    write_glb(recording, path)
    assert validator_errors([path]) == [{}]
    assert worst_miss(three_positions, path, recording) < TOLERANCE


def test_built_in_spider_in_blender(tmp_path: Path) -> None:
    recording = random_walk(load_rig("spider"), frames=30, far=5.0)
    path = tmp_path / "walk.glb"
    write_glb(recording, path)
    assert worst_miss(blender_positions, path, recording) < TOLERANCE


def test_two_joints_in_blender(tmp_path: Path) -> None:
    recording, path = walk_of(two_joint_rig().document(), 0.2, tmp_path)
    assert worst_miss(blender_positions, path, recording) < TOLERANCE


@pytest.mark.parametrize("name", REAL_RIGS)
def test_real_rigs_in_blender(name: str, shared_rig: Callable[[str], Path], tmp_path: Path) -> None:
    recording, path = walk_of(GltfDocument.read(shared_rig(name)), REAL_RIGS[name], tmp_path)
    assert worst_miss(blender_positions, path, recording) < TOLERANCE
