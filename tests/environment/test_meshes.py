"""Meshes as obstacles: what their parts are, what stands on them, and what is refused."""

from __future__ import annotations

import dataclasses
import itertools
import math
import subprocess
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from solids import Mesh, box, ell, ring, table, together, write_obj

from polypod.environment import Environment, Obstacle, convex_parts
from polypod.environment.convex import polygon_around
from polypod.environment.hulls import hull_planes, hull_triangles
from polypod.environment.scene import read_scene
from polypod.environment.splitting import Split, mesh_parts
from polypod.environment.table import penetration, surface
from polypod.environment.welding import facing_out, open_edges, pieces, weld
from polypod.errors import SceneError
from polypod.math.vec3 import Vec3


def coacd_or_skip() -> None:
    pytest.importorskip("coacd", reason="coacd is not installed: Polypod's extra meshes")


@given(seed=st.integers(0, 100_000), count=st.integers(4, 40), flat=st.booleans())
@settings(max_examples=100, deadline=None)
def test_a_hull_is_the_planes_with_all_points_on_one_side(
    seed: int, count: int, flat: bool
) -> None:
    random = np.random.default_rng(seed)
    # On a lattice many points lie in one plane and on one line.
    points = random.integers(0, 3, (count, 3)) * 0.3 if flat else random.normal(size=(count, 3))
    planes = hull_planes(points)
    expected = []
    for a, b, c in itertools.combinations(np.unique(points, axis=0), 3):
        normal = np.cross(b - a, c - a)
        if np.linalg.norm(normal) < 1e-6:
            continue
        normal = normal / np.linalg.norm(normal)
        for side in (normal, -normal):
            height = (points - a) @ side
            if height.max() < 1e-9 and height.min() < -1e-6:
                expected.append([*side, side @ a])
    found = {tuple(row) for row in np.round(planes, 5) + 0.0}
    assert found == {tuple(row) for row in np.round(np.array(expected).reshape(-1, 4), 5) + 0.0}


def test_a_hull_of_few_corners_is_nearly_that_of_many() -> None:
    points = np.random.default_rng(1).normal(size=(500, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    for most, within in ((24, 0.25), (64, 0.1), (128, 0.06)):
        faces = hull_triangles(points, most)
        kept = np.unique(faces)
        assert len(kept) <= most
        planes = hull_planes(points[kept])
        outside = (points @ planes[:, :3].T - planes[:, 3]).max()
        assert 0.0 < outside < within
    # Close the surface of its faces is, and seen from outside.
    assert len(open_edges(faces)) == 0
    assert np.array_equal(facing_out(points, faces), faces)


@given(seed=st.integers(0, 10_000))
@settings(max_examples=30, deadline=None)
def test_faces_are_made_to_look_outward(seed: int) -> None:
    random = np.random.default_rng(seed)
    corners, faces = ring(0.2, 0.3, 0.1)
    flip = random.random(len(faces)) < random.choice([0.0, 0.3, 1.0])
    mixed = np.where(flip[:, None], faces[:, ::-1], faces)
    out = facing_out(corners, mixed)
    a, b, c = (corners[out[:, i]] for i in range(3))
    volume = np.sum(a * np.cross(b, c)) / 6.0
    expected = math.pi * (0.3**2 - 0.2**2) * 0.1
    assert volume == pytest.approx(expected, rel=0.03)


def test_corners_of_faces_that_touch_are_one(tmp_path: Path) -> None:
    corners, faces = box((0, 0, 0), (1, 1, 1))
    apart = corners[faces].reshape(-1, 3)
    random = np.random.default_rng(0)
    shaken = apart + random.uniform(-2e-7, 2e-7, apart.shape)
    welded, joined = weld(np.concatenate([shaken.reshape(-1, 3, 3), shaken.reshape(-1, 3, 3)[:3]]))
    assert len(welded) == 8
    assert len(joined) == 12
    assert len(open_edges(joined)) == 0
    assert [len(piece) for piece in pieces(weld(apart.reshape(-1, 3, 3))[1])] == [12]


def solid(folder: Path, mesh: Mesh, **wanted: object) -> Obstacle:
    path = write_obj(folder / "mesh.obj", mesh)
    return Obstacle.mesh(path, (0.0, 0.5, 0.0), **wanted)  # type: ignore[arg-type]


def test_a_convex_mesh_is_its_own_hull(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(convex_parts, "find_spec", lambda name: None)
    obstacle = solid(tmp_path, box((5, 5, 5), (6, 7, 8)), size=(0.4, 0.2, 0.6))
    assert len(obstacle.parts) == 1
    same = Obstacle.box((0.4, 0.2, 0.6), (0.0, 0.5, 0.0))
    assert obstacle.size == pytest.approx(same.size)
    assert np.allclose(
        np.sort(obstacle.solids()[0].corners(), axis=0), np.sort(same.corners(), axis=0)
    )


def test_a_table_needs_no_library_and_feet_stand_on_top(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(convex_parts, "find_spec", lambda name: None)
    obstacle = dataclasses.replace(solid(tmp_path, table()), position=(0.0, 0.175, 0.0))
    assert len(obstacle.parts) == 5
    env = Environment(obstacles=[Obstacle.box((1, 1, 1), (9, 0, 9)), obstacle]).kernel_table
    # The highest surface counts, over the legs and between them, and it is one obstacle.
    for x, z in ((0.0, 0.0), (0.38, 0.23), (-0.38, 0.0)):
        assert surface(env, x, z) == (pytest.approx(0.35), 1)
    # Between the legs there is room all the same.
    assert penetration(env, Vec3(0.0, 0.2, 0.0))[0] < 0.0
    assert penetration(env, Vec3(0.38, 0.2, 0.23)) == (pytest.approx(0.02), 1)


def dense_surface(mesh: Mesh, x: float, z: float) -> float:
    """Return the height at which a vertical line leaves a mesh, minus infinity where it misses."""
    top = -math.inf
    corners, faces = mesh
    for a, b, c in corners[faces]:
        size = (b[0] - a[0]) * (c[2] - a[2]) - (c[0] - a[0]) * (b[2] - a[2])
        if abs(size) < 1e-12:
            continue
        u = ((x - a[0]) * (c[2] - a[2]) - (c[0] - a[0]) * (z - a[2])) / size
        v = ((b[0] - a[0]) * (z - a[2]) - (x - a[0]) * (b[2] - a[2])) / size
        if min(u, v, 1.0 - u - v) >= 0.0:
            top = max(top, a[1] + u * (b[1] - a[1]) + v * (c[1] - a[1]))
    return top


@pytest.mark.parametrize("name", ["ell", "ring"])
def test_concave_meshes_keep_their_hollows(tmp_path: Path, name: str) -> None:
    coacd_or_skip()
    mesh = ell() if name == "ell" else ring(0.25, 0.5, 0.1)
    obstacle = solid(tmp_path, mesh)
    again = solid(tmp_path, mesh)
    assert 2 <= len(obstacle.parts) <= 32
    assert obstacle == again
    env = Environment(obstacles=[obstacle]).kernel_table
    middle = 0.5 * (mesh[0].min(axis=0) + mesh[0].max(axis=0))
    inside = wrong = 0
    for x, z in np.random.default_rng(0).uniform(-0.55, 0.55, (400, 2)):
        top = dense_surface(mesh, x + middle[0], z + middle[2])
        height, support = surface(env, x, z)
        inside += top > -math.inf
        expected = top - middle[1] + 0.5 if top > -math.inf else 0.0
        wrong += abs(height - expected) > 0.01
        assert (support == 0) == (height > 0.0)
    assert inside > 100
    assert wrong <= 0.04 * 400


def test_parts_are_limited_in_number_and_corners(tmp_path: Path) -> None:
    coacd_or_skip()
    path = write_obj(tmp_path / "ring.obj", ring(0.2, 0.3, 0.1, 24))
    parts, extent = mesh_parts(path, None, Split(most_parts=6, most_corners=8))
    assert 2 <= len(parts) <= 6
    assert max(len(part) for part in parts) <= 8
    assert extent == pytest.approx((0.6, 0.1, 0.6))


def test_what_is_open_is_refused_or_closed(tmp_path: Path) -> None:
    corners, faces = box((0, 0, 0), (1, 1, 1))
    path = write_obj(tmp_path / "open.obj", (corners, faces[:-2]))
    with pytest.raises(SceneError, match=r"open\.obj: its surface is open: 4 edges.*close = true"):
        mesh_parts(path, None, Split())
    parts, _ = mesh_parts(path, None, Split(close=True))
    assert [len(part) for part in parts] == [8]


def test_what_cannot_be_split_is_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write_obj(tmp_path / "ell.obj", ell())
    with monkeypatch.context() as patch:
        patch.setattr(convex_parts, "find_spec", lambda name: None)
        with pytest.raises(SceneError, match=r"ell\.obj: the mesh is concave.*coacd"):
            mesh_parts(path, None, Split())
    coacd_or_skip()
    with monkeypatch.context() as patch:
        patch.setattr(convex_parts, "MOST_FACES", 3)
        with pytest.raises(SceneError, match="faces; simplify it"):
            mesh_parts(path, None, Split())

    monkeypatch.setenv("POLYPOD_CACHE", str(tmp_path))
    monkeypatch.setattr(subprocess, "run", abort)
    with pytest.raises(SceneError, match="splitting the mesh into convex parts failed"):
        mesh_parts(path, None, Split())


def abort(*arguments: object, **keywords: object) -> None:
    raise subprocess.CalledProcessError(-6, "split")


def test_a_mesh_is_split_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    coacd_or_skip()
    monkeypatch.setenv("POLYPOD_CACHE", str(tmp_path))
    path = write_obj(tmp_path / "ell.obj", ell())
    made, _ = mesh_parts(path, None, Split())
    (kept,) = (tmp_path / "meshes").iterdir()
    with monkeypatch.context() as patch:
        patch.setattr(subprocess, "run", abort)
        again, _ = mesh_parts(path, None, Split())
    assert all(np.array_equal(a, b) for a, b in zip(made, again, strict=True))
    # One that is broken is made anew.
    kept.write_bytes(kept.read_bytes()[:100])
    again, _ = mesh_parts(path, None, Split())
    assert all(np.array_equal(a, b) for a, b in zip(made, again, strict=True))


MANY = together(*(box((i, 0, 0), (i + 0.5, 1, 1)) for i in range(5)))


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ("", ["needs file"]),
        ('file = "none.obj"', ["none.obj", "can be read"]),
        ('file = "none.glb"', ["none.glb"]),
        ('file = "box.stl"', ["box.stl", ".obj, .glb, .gltf"]),
        ('file = "flat.obj"', ["flat.obj", "flat"]),
        ('file = "box.obj"\nconcavity = 2', ["concavity = 2", "0.01 to 1"]),
        ('file = "box.obj"\nmost_parts = 0', ["most_parts = 0"]),
        ('file = "box.obj"\nmost_corners = 3', ["most_corners = 3"]),
        ('file = "box.obj"\nclose = 1', ["close = 1", "true or false"]),
        ('file = "box.obj"\nsize = [1, 1]', ["size", "[x, y, z]"]),
        ('file = "box.obj"\npoints = [[0, 0, 0]]', ["'points'", "file, size"]),
        ('file = "box.obj"\nturn_rate = 1e3', ["turn_rate"]),
        ('file = "many.obj"\nmost_parts = 4', ["5 separate pieces", "most_parts is 4"]),
    ],
)
def test_a_scene_says_what_is_wrong_with_a_mesh(
    tmp_path: Path, keys: str, words: list[str]
) -> None:
    write_obj(tmp_path / "box.obj", box((0, 0, 0), (1, 1, 1)))
    write_obj(tmp_path / "flat.obj", box((0, 0, 0), (1, 0, 1)))
    write_obj(tmp_path / "many.obj", MANY)
    scene = tmp_path / "scene.toml"
    scene.write_text(f'[[obstacle]]\nshape = "mesh"\nposition = [0, 0, 0]\n{keys}\n')
    with pytest.raises(SceneError) as caught:
        read_scene(scene)
    assert str(scene) in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def test_a_scene_places_a_mesh_as_it_does_a_box(tmp_path: Path) -> None:
    write_obj(tmp_path / "crate.obj", box((3, 3, 3), (4, 5, 6)))
    (tmp_path / "scene.toml").write_text(
        '[[obstacle]]\nshape = "mesh"\nfile = "crate.obj"\nsize = [0.4, 0.2, 0.6]\n'
        "position = [1.0, 0.3, 2.0]\nyaw = 0.4\nforbidden = true\nturn_rate = 0.5\n"
        "velocity = [0.1, 0.0, 0.0]\n"
    )
    obstacle = read_scene(tmp_path / "scene.toml").obstacles[0]
    same = Obstacle.box((0.4, 0.2, 0.6), (1.0, 0.3, 2.0), 0.4)
    outline = obstacle.solids()[0].footprint()
    assert np.allclose(polygon_around(outline), polygon_around(same.footprint()))
    assert obstacle.forbidden
    assert obstacle.turn_rate == 0.5
    assert obstacle.moves


@given(cut=st.integers(0, 400), junk=st.binary(max_size=12))
@settings(max_examples=60, deadline=None)
def test_a_broken_file_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, cut: int, junk: bytes
) -> None:
    path = tmp_path_factory.mktemp("mesh") / "broken.obj"
    write_obj(path, box((0, 0, 0), (1, 1, 1)))
    whole = path.read_bytes()
    path.write_bytes(whole[:cut] + junk + whole[cut:])
    refused = ""
    try:
        Obstacle.mesh(path, (0.0, 0.0, 0.0), split=Split(close=True))
    except SceneError as error:
        refused = str(error)
    assert not refused or "broken.obj" in refused
