"""Every built-in creature: what it is made of, how it stands, and what is found in its file."""

from __future__ import annotations

import hashlib
import subprocess
import sys
import time
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from polypod.errors import RigError
from polypod.morphology.builtin import NAMES, build
from polypod.morphology.load import load_rig
from polypod.morphology.types import Morphology
from polypod.rigs.gltf import GltfDocument

FloatArray = NDArray[np.float64]

TOLERANCE = 1e-6  # m: positions are kept to the micrometre


class Expected(NamedTuple):
    """What the design says of a creature."""

    legs: int
    hip_height: float  # m
    leg_length: tuple[float, float]  # m, the mean is between
    most_triangles: int


EXPECTED = {
    "spider": Expected(8, 0.25, (0.45, 0.58), 8_000),
    "ant": Expected(6, 0.25, (0.45, 0.58), 8_000),
    "crab": Expected(8, 0.25, (0.45, 0.58), 8_000),
    "pentapod": Expected(5, 0.25, (0.45, 0.58), 8_000),
    "centipede": Expected(40, 0.08, (0.12, 0.20), 12_000),
    "wolf": Expected(4, 0.5, (0.5, 0.75), 10_000),
    "lizard": Expected(4, 0.12, (0.12, 0.25), 10_000),
    "biped": Expected(2, 0.9, (0.9, 1.05), 10_000),
    "centaur": Expected(6, 0.6, (0.6, 0.9), 12_000),
}
ARTHROPODS = ("spider", "ant", "crab", "centipede")

every_creature = pytest.mark.parametrize("name", NAMES)


class Mesh(NamedTuple):
    """A creature's surface and who carries it; V vertices, T triangles, N nodes."""

    positions: FloatArray  # [V, 3] m
    normals: FloatArray  # [V, 3]
    colours: FloatArray  # [V, 4]
    weights: FloatArray  # [V, N] by node
    triangles: NDArray[np.int64]  # [T, 3]
    names: tuple[str, ...]  # [N]


@cache
def document_of(name: str) -> GltfDocument:
    return GltfDocument.from_bytes(build(name).glb, f"{name}.glb")


@cache
def rig_of(name: str) -> Morphology:
    return load_rig(name)


@cache
def mesh_of(name: str) -> Mesh:
    """Return the mesh as the file has it, all primitives as one."""
    document = document_of(name)
    nodes = document.json["skins"][0]["joints"]
    count = len(document.json["nodes"])
    columns, triangles, first = [], [], 0
    for primitive in document.json["meshes"][0]["primitives"]:
        places = primitive["attributes"]
        position, normal, colour, joint, weight = (
            document.accessor(places[key])
            for key in ("POSITION", "NORMAL", "COLOR_0", "JOINTS_0", "WEIGHTS_0")
        )
        by_node = np.zeros((len(position), count))
        for k in range(4):
            np.add.at(
                by_node, (np.arange(len(position)), np.array(nodes)[joint[:, k]]), weight[:, k]
            )
        columns.append((position, normal, colour, by_node))
        triangles.append(document.accessor(primitive["indices"]).reshape(-1, 3) + first)
        first += len(position)
    whole = [np.concatenate(part).astype(np.float64) for part in zip(*columns, strict=True)]
    return Mesh(*whole, np.concatenate(triangles).astype(np.int64), document.node_names())


def extensions(rig: Morphology) -> FloatArray:
    """Return [K] how far each leg is stretched from its hip to its effector."""
    legs, result = rig.legs, []
    for k, count in enumerate(legs.joint_count):
        points = legs.point_rest[k, : count + 1]
        chain = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
        result.append(np.linalg.norm(points[-1] - points[0]) / chain)
    return np.array(result)


def test_there_are_the_creatures_that_the_design_names() -> None:
    assert set(NAMES) == set(EXPECTED)


def test_a_wrong_name_is_answered_with_the_right_ones() -> None:
    with pytest.raises(RigError, match=f'"slug".*{NAMES[0]}.*{NAMES[-1]}'):
        build("slug")


@every_creature
def test_its_legs_are_those_it_says(name: str) -> None:
    rig, made = rig_of(name), build(name)
    assert rig.foot_name == tuple(leg.split(":")[1] for leg in made.legs)
    assert len(made.legs) == EXPECTED[name].legs
    assert rig.guesses == ()
    assert tuple(rig.joint_name[row] for row in rig.spine) == made.spine


@every_creature
def test_its_legs_are_found_without_being_named(name: str, tmp_path: Path) -> None:
    path = tmp_path / f"{name}.glb"
    path.write_bytes(build(name).glb)
    found, named = load_rig(path), rig_of(name)
    assert set(found.foot_name) == set(named.foot_name)
    order = [found.foot_name.index(foot) for foot in named.foot_name]
    assert np.array_equal(found.legs.joint_count[order], named.legs.joint_count)
    assert np.allclose(found.legs.sole_stance[order], named.legs.sole_stance, atol=TOLERANCE)
    assert np.allclose(found.legs.length[order], named.legs.length, atol=TOLERANCE)


@every_creature
def test_its_size_is_that_of_the_design(name: str) -> None:
    legs, expected = rig_of(name).legs, EXPECTED[name]
    hip_height = (legs.point_rest[:, 0, 1] - legs.sole_rest[:, 1]).mean()
    assert hip_height == pytest.approx(expected.hip_height, rel=0.06)
    low, high = expected.leg_length
    assert low <= legs.length.mean() <= high


@every_creature
def test_it_stands_on_the_ground_with_bent_legs(name: str) -> None:
    rig = rig_of(name)
    in_file = rig.legs.sole_rest - rig.source.body_from_file[:3, 3]
    assert np.abs(in_file[:, 1]).max() < TOLERANCE
    assert mesh_of(name).positions[:, 1].min() > -TOLERANCE
    # It stands as it rests, no crouch was needed; erect legs' feet move under their hips.
    moved = rig.legs.sole_stance - rig.legs.sole_rest
    assert np.allclose(moved[:, :2], 0.0, atol=TOLERANCE)
    assert np.allclose(moved[~rig.legs.upright], 0.0, atol=TOLERANCE)
    assert extensions(rig).min() >= 0.7
    assert extensions(rig).max() <= 0.95


@pytest.mark.parametrize("name", [name for name in NAMES if name in ARTHROPODS])
def test_the_knees_of_arthropods_are_above_their_feet_and_not_below_their_hips(name: str) -> None:
    legs = rig_of(name).legs
    for k, count in enumerate(legs.joint_count):
        points = legs.point_rest[k, : count + 1]
        knee = points[1:-1, 1].max()
        assert knee > points[0, 1]
        assert knee > points[-1, 1] + 0.4 * legs.length[k]


@every_creature
def test_its_legs_do_not_cross_in_plan(name: str) -> None:
    legs = rig_of(name).legs
    lines = [
        (legs.point_rest[k, 0, [0, 2]], legs.sole_rest[k, [0, 2]]) for k in range(len(legs.row))
    ]

    def turn(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
        return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))

    for i, (a, b) in enumerate(lines):
        for c, d in lines[:i]:
            crossed = turn(a, b, c) * turn(a, b, d) < 0.0 and turn(c, d, a) * turn(c, d, b) < 0.0
            assert not crossed


@every_creature
def test_its_right_half_is_the_image_of_its_left(name: str) -> None:
    mesh = mesh_of(name)
    twin = [mesh.names.index(_twin(node)) for node in mesh.names]
    here, weights = _by_place(mesh.positions, mesh.weights)
    image, image_weights = _by_place(mesh.positions * (-1.0, 1.0, 1.0), mesh.weights[:, twin])
    assert np.array_equal(here, image)
    assert np.allclose(weights, image_weights, atol=1e-3)
    at = document_of(name).node_world_matrices()[:, :3, 3]
    assert np.allclose(at[twin], at * (-1.0, 1.0, 1.0), atol=TOLERANCE)


def _by_place(positions: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the places [P, 3] in micrometres, sorted, and the mean weights [P, N] there."""
    place, index, count = np.unique(
        np.rint(positions * 1e6) + 0.0, axis=0, return_inverse=True, return_counts=True
    )
    total = np.zeros((len(place), weights.shape[1]))
    np.add.at(total, index, weights)
    return place, total / count[:, None]


def _twin(name: str) -> str:
    for side, other in (("Left", "Right"), ("Right", "Left")):
        if name.startswith(side):
            return other + name.removeprefix(side)
    return name


def test_the_pentapod_has_the_same_leg_every_72_degrees_and_one_ahead() -> None:
    mesh, rig = mesh_of("pentapod"), rig_of("pentapod")
    angle = 2.0 * np.pi / 5.0
    turn = np.array(
        [[np.cos(angle), 0.0, np.sin(angle)], [0.0, 1.0, 0.0], [-np.sin(angle), 0.0, np.cos(angle)]]
    )
    ring = ["FrontLeg", "LeftMidLeg", "LeftBackLeg", "RightBackLeg", "RightMidLeg"]
    order = [rig.foot_name.index(leg + "Foot") for leg in ring]
    soles = rig.legs.sole_rest[order] - rig.source.body_from_file[:3, 3]
    assert abs(soles[0, 0]) < TOLERANCE
    assert soles[0, 2] == soles[:, 2].max()
    assert np.allclose(np.roll(soles, -1, axis=0), soles @ turn.T, atol=2 * TOLERANCE)
    parts = []
    for leg in ring:
        own = [node for node, name in enumerate(mesh.names) if name.startswith(leg)]
        parts.append(mesh.positions[mesh.weights[:, own].sum(axis=1) > 0.5])
    for part, following in zip(parts, [*parts[1:], parts[0]], strict=True):
        away = np.linalg.norm((part @ turn.T)[:, None] - following[None], axis=2)
        assert len(part) == len(following)
        assert away.min(axis=1).max() < 3 * TOLERANCE
        assert away.min(axis=0).max() < 3 * TOLERANCE


@every_creature
def test_its_skin_is_sound(name: str) -> None:
    mesh = mesh_of(name)
    assert np.allclose(mesh.weights.sum(axis=1), 1.0, atol=1e-6)
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-5)
    assert mesh.colours.min() >= 0.0
    assert mesh.colours.max() <= 1.0
    assert 2_000 <= len(mesh.triangles) <= EXPECTED[name].most_triangles
    corners = mesh.positions[mesh.triangles]
    facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.linalg.norm(facing, axis=1).min() > 0.0
    # Solids, seen from outside: the volume that the surface encloses is positive.
    assert np.einsum("tk,tk->", corners[:, 0], facing) > 0.0
    smooth = np.einsum("tk,tk->t", facing, mesh.normals[mesh.triangles].sum(axis=1))
    assert np.mean(smooth > 0.0) > 0.95


@every_creature
def test_every_joint_of_a_leg_carries_skin_that_blends_into_the_next(name: str) -> None:
    mesh, made = mesh_of(name), build(name)
    document = document_of(name)
    parents = document.node_parents()
    joints = set(document.json["skins"][0]["joints"])
    for leg in made.legs:
        hip, foot = (mesh.names.index(node) for node in leg.split(":"))
        chain = [foot]
        while chain[-1] != hip:
            chain.append(int(parents[chain[-1]]))
        for node in chain:
            if node in joints:
                assert mesh.weights[:, node].max() > 0.5
    if name != "pentapod":  # a machine is stiff between its joints
        assert np.mean((mesh.weights > 0.0).sum(axis=1) > 1) > 0.05


@every_creature
def test_it_is_bound_as_its_nodes_stand(name: str) -> None:
    document = document_of(name)
    skin = document.skins()[0]
    world = document.node_world_matrices()[skin.joints]
    assert np.allclose(world @ skin.inverse_bind, np.eye(4), atol=1e-5)


@every_creature
def test_it_is_made_quickly(name: str) -> None:
    times = []
    for _ in range(3):
        start = time.process_time()
        build(name)
        times.append(time.process_time() - start)
    assert min(times) < 1.0


def test_the_bytes_are_the_same_in_another_process() -> None:
    script = (
        "import hashlib; from polypod.morphology.builtin import NAMES, build;"
        "print([hashlib.sha256(build(name).glb).hexdigest() for name in NAMES])"
    )
    there = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    ).stdout.strip()
    assert there == str([hashlib.sha256(build(name).glb).hexdigest() for name in NAMES])
