"""Meshes as ground: closed forms, a brute-force search, and what is refused."""

from __future__ import annotations

import base64
import json
import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from environment.test_scene import scene_of
from polypod.environment import Environment, Terrain
from polypod.environment.polygons import triangulate
from polypod.environment.surfaces import highest_surface
from polypod.environment.table import is_wet, surface
from polypod.errors import SceneError

FloatArray = NDArray[np.float64]

IN_FOLDER = [HealthCheck.function_scoped_fixture]
PLANE = "v 0 0 0\nv 4 1 0\nv 4 3 4\nv 0 2 4\n"  # y = x / 4 + z / 2


def obj(folder: Path, text: str) -> Path:
    path = folder / "mesh.obj"
    path.write_text(text)
    return path


def plan(terrain: Terrain) -> tuple[FloatArray, FloatArray]:
    """Return x [1, columns] and z [rows, 1] of the samples."""
    rows, columns = terrain.heights.shape
    x = terrain.origin[0] + terrain.cell * np.arange(columns)
    return x[None, :], (terrain.origin[1] + terrain.cell * np.arange(rows))[:, None]


@pytest.mark.parametrize(
    "faces",
    [
        "f 1 2 3\nf 1 3 4",
        "f 1 2 3 4",
        "f -4 -3 -2 -1",
        "f 1/1 2/2/3 3//5 4",
        "f 4 3 2 1",
        "f 1 2 \\\n3 4 # a comment",
        "o name\nvn 0 1 0\nusemtl \xe9\nf 1 2 3\nl 1 2\nf 3 4 1",
    ],
)
@pytest.mark.parametrize("cell", [None, 0.1, 0.37, 1.0])
def test_a_tilted_plane(tmp_path: Path, faces: str, cell: float | None) -> None:
    terrain = Terrain.from_mesh(obj(tmp_path, PLANE + faces), cell)
    side = 1025 if cell is None else math.floor(4.0 / cell + 1e-9) + 1
    assert terrain.heights.shape == (side, side)
    assert terrain.water is None
    x, z = plan(terrain)
    assert np.allclose(terrain.heights, x / 4 + z / 2, rtol=0, atol=1e-12)


def test_a_pyramid_in_a_scene(tmp_path: Path) -> None:
    base = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 2 0\nf 1 2 3 4\n"
    obj(tmp_path, base + "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5")
    terrain = scene_of(
        tmp_path, '[terrain]\nmesh = "mesh.obj"\ncell = 0.125\nscale = 2.0\norigin = [10, 20]'
    ).terrain
    assert terrain.origin == (10.0, 20.0)
    x, z = plan(terrain)
    far = np.maximum(np.abs(x - 12.0), np.abs(z - 22.0))
    assert np.allclose(terrain.heights, 4.0 - 2.0 * far, rtol=0, atol=1e-12)
    assert terrain.heights.max() == 4.0


def test_nothing_is_ground_beside_the_mesh(tmp_path: Path) -> None:
    terrain = Terrain.from_mesh(obj(tmp_path, "v 0 1 0\nv 2 1 0\nv 0 3 2\nf 1 2 3"), 0.5)
    x, z = plan(terrain)
    outside = x + z > 2.0
    assert terrain.water is not None
    assert np.array_equal(terrain.water, outside)
    assert np.allclose(terrain.heights, np.where(outside, 1.0, 1.0 + z))
    table = Environment(terrain).kernel_table
    assert is_wet(table, 2.0, 2.0)
    assert not is_wet(table, 0.5, 0.5)
    assert surface(table, 0.5, 0.5) == pytest.approx((1.5, -1))


def test_the_highest_floor_counts_and_walls_do_not(tmp_path: Path) -> None:
    table_top = "v 1 2 1\nv 2 2 1\nv 2 2 2\nv 1 2 2\nf 5 6 7 8\nf 1 2 6 5\n"
    floor = "v 0 0 0\nv 3 0 0\nv 3 0 3\nv 0 0 3\nf 4 3 2 1\n"
    terrain = Terrain.from_mesh(obj(tmp_path, floor + table_top), 0.5)
    wall = "v 0.2 9 0.3\nv 0.9 9 0.3\nv 0.9 0 0.3\nf -1 -2 -3\n"
    walled = Terrain.from_mesh(obj(tmp_path, floor + table_top + wall), 0.5)
    x, z = plan(terrain)
    on = (x >= 1) & (x <= 2) & (z >= 1) & (z <= 2)
    assert np.all(terrain.heights[on] == 2.0)
    assert terrain.heights[0, 6] == terrain.heights[6, 0] == 0.0
    assert np.array_equal(terrain.heights, walled.heights)


def brute_force(triangles: FloatArray, x: float, z: float) -> tuple[float, float]:
    """Return the highest surface over a place, and how far it is from each triangle's edges."""
    highest, nearest = -math.inf, math.inf
    for a, b, c in triangles:
        matrix = np.array([[b[0] - a[0], c[0] - a[0]], [b[2] - a[2], c[2] - a[2]]])
        if abs(np.linalg.det(matrix)) < 1e-6:
            nearest = 0.0
            continue
        u, v = np.linalg.solve(matrix, (x - a[0], z - a[2]))
        nearest = min(nearest, abs(u), abs(v), abs(1.0 - u - v))
        if min(u, v, 1.0 - u - v) >= 0.0:
            highest = max(highest, a[1] + u * (b[1] - a[1]) + v * (c[1] - a[1]))
    return highest, nearest


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 100_000), count=st.integers(1, 12), size=st.sampled_from([0.2, 1.0, 5]))
def test_each_sample_is_the_highest_of_all_triangles(seed: int, count: int, size: float) -> None:
    random = np.random.default_rng(seed)
    triangles = random.uniform(-3, 3, (count, 1, 3)) + random.uniform(-size, size, (count, 3, 3))
    try:
        field = highest_surface("mesh", triangles, 0.25)
    except SceneError:
        field = None
    least = triangles.reshape(-1, 3).min(axis=0)
    samples = {(0, 0)} if field is None else set(np.ndindex(field.heights.shape))
    for row, column in samples:
        x, z = least[0] + 0.25 * column, least[2] + 0.25 * row
        highest, nearest = brute_force(triangles, float(x), float(z))
        if nearest < 1e-6:
            continue
        assert (field is None or field.unknown[row, column]) == (highest == -math.inf)
        if field is not None and highest > -math.inf:
            assert field.heights[row, column] == pytest.approx(highest, abs=1e-9)


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 100_000), side=st.integers(1, 9), scale=st.floats(0.001, 1000))
def test_a_mesh_without_holes_has_none(seed: int, side: int, scale: float) -> None:
    """Samples that lie on edges and corners belong to a triangle, however numbers are rounded."""
    random = np.random.default_rng(seed)
    ticks = np.sort(random.uniform(-1, 1, (2, side + 1)), axis=1)
    ticks[:, 0], ticks[:, -1] = -1.0, 1.0
    x, z = np.meshgrid(ticks[0], ticks[1])
    points = np.stack([x, 0.3 * x - 0.2 * z, z], axis=-1) * scale
    quads = [points[:-1, :-1], points[:-1, 1:], points[1:, 1:], points[1:, :-1]]
    triangles = np.concatenate(
        [np.stack([quads[0], quads[i], quads[i + 1]], axis=-2).reshape(-1, 3, 3) for i in (1, 2)]
    )
    turn = random.integers(0, 3)
    field = highest_surface("mesh", np.roll(triangles, turn, axis=1), 2.0 * scale / 24)
    assert field.heights.shape == (25, 25)
    assert not field.unknown.any()
    at = scale * np.linspace(-1, 1, 25)
    exact = 0.3 * at[None, :] - 0.2 * at[:, None]
    assert np.allclose(field.heights, exact, rtol=0, atol=1e-9 * scale)


@settings(max_examples=80, deadline=None)
@given(seed=st.integers(0, 100_000), count=st.integers(3, 14), axis=st.integers(0, 2))
def test_triangles_of_a_concave_face_fill_it_once(seed: int, count: int, axis: int) -> None:
    random = np.random.default_rng(seed)
    angle = (np.arange(count) + random.uniform(0, 0.8, count)) * (2 * math.pi / count)
    star = random.uniform(0.2, 1.0, count)[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)
    star = star[:: random.choice([-1, 1])]
    corners = np.insert(star, axis, star @ [0.3, -0.2], axis=1)
    triangles = triangulate(corners[None])[0]
    flat = np.delete(corners, axis, axis=1)

    def doubled(shape: FloatArray) -> float:
        after = np.roll(shape, -1, axis=0)
        return float(np.sum(shape[:, 0] * after[:, 1] - shape[:, 1] * after[:, 0]))

    areas = [doubled(flat[triangle]) for triangle in triangles]
    # As much as the face, and all turned the same way: nothing is covered twice.
    assert sum(areas) == pytest.approx(doubled(flat))
    assert max(areas) <= 1e-12 or min(areas) >= -1e-12


def gltf(folder: Path, nodes: list[dict[str, Any]], **more: Any) -> Path:
    """Write a .gltf of one mesh: the unit square in x and z at y = 0."""
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], dtype="<f4").tobytes()
    indices = np.array([0, 1, 2, 0, 2, 3], dtype="<u2").tobytes()
    joints = np.zeros((4, 4), dtype="u1").tobytes()
    weights = np.tile(np.array([1, 0, 0, 0], dtype="<f4"), (4, 1)).tobytes()
    data = points + indices + joints + weights
    starts = np.cumsum([0, len(points), len(indices), len(joints), len(weights)]).tolist()
    kinds = [(5126, 4, "VEC3"), (5123, 6, "SCALAR"), (5121, 4, "VEC4"), (5126, 4, "VEC4")]
    document = {
        "asset": {"version": "2.0"},
        "buffers": [
            {
                "byteLength": len(data),
                "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode(),
            }
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": start, "byteLength": end - start}
            for start, end in pairwise(starts)
        ],
        "accessors": [
            {"bufferView": i, "componentType": kind, "count": count, "type": form}
            for i, (kind, count, form) in enumerate(kinds)
        ],
        "meshes": [
            {
                "primitives": [
                    {"attributes": {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}, "indices": 1}
                ]
            }
        ],
        "nodes": nodes,
        **more,
    }
    path = folder / "mesh.gltf"
    path.write_text(json.dumps(document))
    return path


def test_nodes_place_the_triangles_of_a_gltf(tmp_path: Path) -> None:
    nodes: list[dict[str, Any]] = [
        {"mesh": 0, "scale": [4, 1, 2]},
        {"children": [2], "translation": [1, 3, 0]},
        {"mesh": 0, "translation": [0, -2, 0.5]},
    ]
    terrain = Terrain.from_mesh(gltf(tmp_path, nodes), 0.25)
    x, z = plan(terrain)
    raised = (x >= 1) & (x <= 2) & (z >= 0.5) & (z <= 1.5)
    assert terrain.heights.shape == (9, 17)
    assert np.array_equal(terrain.heights, np.where(raised, 1.0, 0.0))


def test_joints_place_the_triangles_of_a_skin(tmp_path: Path) -> None:
    nodes: list[dict[str, Any]] = [
        {"mesh": 0, "skin": 0, "translation": [50, 50, 50]},  # a skin does not follow its node
        {"translation": [2, 5, 3]},
    ]
    terrain = Terrain.from_mesh(gltf(tmp_path, nodes, skins=[{"joints": [1]}]), 0.5)
    assert terrain.origin == (2.0, 3.0)
    assert np.array_equal(terrain.heights, np.full((3, 3), 5.0))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no face"),
        (PLANE, "no face"),
        ("\0\xff\n\x80 f\n", "no face"),
        ("v 0 0\nf 1 1 1", "line 1: a vertex must be three numbers"),
        ("\nv 0 0 a\n", "line 2: a vertex must be three numbers"),
        (PLANE + "f 1 2", "line 5: a face must have 3"),
        (PLANE + "f 1 2 x", "line 5: a face must be whole numbers"),
        (PLANE + "f 1 2 1.5", "line 5: a face must be whole numbers"),
        (PLANE + "f 1 2 0", "line 5: the face names vertex 0, but there are 4 so far"),
        (PLANE + "f 1 2 -5", "line 5: the face names vertex -5"),
        (PLANE + "f 1 2 3\nf 1 2 5", "line 6: the face names vertex 5, but there are 4"),
        (PLANE + "f 1 2 99999999999999999999", "line 5: the face names vertex 99999"),
        (PLANE + "f" + " 1" * 5000, "line 5: a face must have 3 to 4096 vertices, not 5000"),
        ("v 0 0 nan\nv 1 0 0\nv 0 0 1\nf 1 2 3", "no number"),
        ("v 0 0 1e7\nv 1 0 0\nv 0 0 1\nf 1 2 3", "scale says"),
        ("v 0 0 1e300\nv 1 0 0\nv 0 0 1e308\nf 1 2 3", "scale says"),
        ("v 0 0 0\nv 0 1 0\nv 0 1 1\nf 1 2 3", "seen from above"),
        ("v 0 0 0\nv 1 1 1\nv 1 0 1\nf 1 2 3", "no triangle of the mesh lies over"),
    ],
)
def test_other_meshes_are_refused(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(SceneError, match=rf"mesh\.obj: .*{words}") as caught:
        Terrain.from_mesh(obj(tmp_path, text), scale=1.0)
    assert "\n" not in str(caught.value)


def test_absurd_cells_and_files_are_refused(tmp_path: Path) -> None:
    path = obj(tmp_path, PLANE + "f 1 2 3 4")
    with pytest.raises(SceneError, match="too many for 2 triangles; choose a larger cell"):
        Terrain.from_mesh(path, 1e-5)
    with pytest.raises(SceneError, match="cell = nan"):
        Terrain.from_mesh(path, math.nan)
    with pytest.raises(SceneError, match="scale = -1"):
        Terrain.from_mesh(path, scale=-1.0)
    with pytest.raises(SceneError, match=r"\.obj, \.glb, \.gltf"):
        Terrain.from_mesh(tmp_path / "a.stl")
    (tmp_path / "cut.glb").write_bytes(b"glTF\x02\0\0\0")
    with pytest.raises(SceneError, match=r"cut\.glb: is truncated"):
        Terrain.from_mesh(tmp_path / "cut.glb")
    with pytest.raises(SceneError, match=r"mesh\.gltf: .*no triangle"):
        Terrain.from_mesh(gltf(tmp_path, [{}]))
    with (tmp_path / "vast.obj").open("wb") as file:
        file.truncate(10**11)  # a hole: it takes no space
    with pytest.raises(SceneError, match="too large"):
        Terrain.from_mesh(tmp_path / "vast.obj")


@settings(max_examples=200, deadline=None, suppress_health_check=IN_FOLDER)
@given(
    text=st.lists(
        st.one_of(
            st.sampled_from(["v", "f", "\n", "\nv", "\nf", "\\\n", "#", "1/", "-1", "nan", "1e9"]),
            st.integers(-5, 5).map(str),
            st.text(max_size=3),
        ),
        max_size=40,
    ).map(" ".join)
)
def test_no_obj_raises_anything_else(tmp_path: Path, text: str) -> None:
    path = tmp_path / "mesh.obj"
    path.write_bytes((PLANE + "f 1 2 3\n" + text).encode("utf-8", "surrogatepass"))
    refused = f"{path}: "
    try:
        assert Terrain.from_mesh(path, 0.5).heights.size > 0
    except SceneError as error:
        refused = str(error)
    assert refused.startswith(f"{path}: ")
