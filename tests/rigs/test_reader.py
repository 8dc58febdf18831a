"""What the reader reads is what the file says, and what it cannot read it names."""

from __future__ import annotations

import base64
import contextlib
import copy
import json
import struct
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PIL import Image
from sample_rigs import SampleFile, as_gltf_folder, nasty_rig, pack_glb, two_joint_rig

from polypod.errors import RigError
from polypod.rigs.gltf import GltfDocument
from polypod.rigs.nodes import compose, decompose, quaternions
from polypod.rigs.playback import Playback

SMALL = two_joint_rig().glb()
NASTY = nasty_rig().glb()


def edited(change: Callable[[dict[str, Any]], Any], sample: SampleFile | None = None) -> bytes:
    """The small rig as GLB after a change of its JSON."""
    sample = sample or two_joint_rig()
    sample.finish()
    content = copy.deepcopy(sample.json)
    change(content)
    return pack_glb(content, sample.binary)


def read_all(data: bytes) -> GltfDocument:
    """Read a document and everything it offers."""
    document = GltfDocument.from_bytes(data, "file.glb")
    document.mesh_parts()
    document.node_world_matrices()
    for index in range(len(document.json.get("accessors", []))):
        document.accessor(index)
    for index in range(len(document.json.get("animations", []))):
        Playback(document, index).world_matrices(np.array([0.0, 0.5]))
    return document


# ---- what is read


def test_accessors_of_every_component_type() -> None:
    sample = SampleFile()
    whole = [[1, 2, 3], [4, 5, 6]]
    plain = {kind: sample.accessor(whole, kind) for kind in ("i1", "u1", "i2", "u2", "u4", "f4")}
    document = sample.document()
    for kind, index in plain.items():
        values = document.accessor(index)
        assert values.dtype == (np.float64 if kind == "f4" else np.int64)
        np.testing.assert_array_equal(values, whole)


@pytest.mark.parametrize(
    ("kind", "stored", "meant"),
    [
        ("u1", [0, 51, 255], [0.0, 0.2, 1.0]),
        ("i1", [-128, -127, 127], [-1.0, -1.0, 1.0]),
        ("u2", [0, 13107, 65535], [0.0, 0.2, 1.0]),
        ("i2", [-32768, 0, 32767], [-1.0, 0.0, 1.0]),
    ],
)
def test_normalised_integers(kind: str, stored: list[int], meant: list[float]) -> None:
    sample = SampleFile()
    index = sample.accessor(stored, kind, normalized=True)
    np.testing.assert_allclose(sample.document().accessor(index), meant, atol=1e-12)


def test_matrices_are_read_as_mathematics_writes_them() -> None:
    sample = SampleFile()
    matrix = compose(np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.6, 0.0, 0.8]), np.ones(3))
    index = sample.accessor(matrix.T[None])
    read = sample.document().accessor(index)
    assert read.shape == (1, 4, 4)
    np.testing.assert_allclose(read[0], matrix, atol=1e-7)


def test_narrow_matrices_have_padded_columns() -> None:
    sample = SampleFile()
    content = bytes([1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0])
    view = sample.view(content)
    sample.json["accessors"].append(
        {"bufferView": view, "componentType": 5121, "count": 1, "type": "MAT3"}
    )
    read = sample.document().accessor(0)
    np.testing.assert_array_equal(read, [[[1, 4, 7], [2, 5, 8], [3, 6, 9]]])


def test_interleaved_and_sparse_and_without_view() -> None:
    sample = SampleFile()
    rows = struct.pack("<fffBBBB", 1, 2, 3, 9, 8, 7, 6) + struct.pack(
        "<fffBBBB", 4, 5, 6, 5, 4, 3, 2
    )
    view = sample.view(rows, byteStride=16)
    indices, values = sample.view(struct.pack("<H", 1)), sample.view(struct.pack("<fff", 7, 8, 9))
    sparse = {
        "count": 1,
        "indices": {"bufferView": indices, "componentType": 5123},
        "values": {"bufferView": values},
    }
    vec3 = {"componentType": 5126, "count": 2, "type": "VEC3"}
    sample.json["accessors"] = [
        {"bufferView": view, **vec3},
        {"bufferView": view, "byteOffset": 12, "componentType": 5121, "count": 2, "type": "VEC4"},
        {"bufferView": view, **vec3, "sparse": sparse},
        {**vec3, "sparse": sparse},
        vec3,
    ]
    document = sample.document()
    np.testing.assert_array_equal(document.accessor(0), [[1, 2, 3], [4, 5, 6]])
    np.testing.assert_array_equal(document.accessor(1), [[9, 8, 7, 6], [5, 4, 3, 2]])
    np.testing.assert_array_equal(document.accessor(2), [[1, 2, 3], [7, 8, 9]])
    np.testing.assert_array_equal(document.accessor(3), [[0, 0, 0], [7, 8, 9]])
    np.testing.assert_array_equal(document.accessor(4), np.zeros((2, 3)))


def test_nodes_in_any_order() -> None:
    document = nasty_rig().document()
    parents, local = document.node_parents(), document.node_local_matrices()
    assert parents.tolist() == [-1, 0, 1, 7, 3, 4, 1, 2, 3, -1, -1]
    assert document.node_names()[3:6] == ("Leg", "Leg", "")
    chain = local[0] @ local[1] @ local[2] @ local[7] @ local[3]
    np.testing.assert_allclose(document.node_world_matrices()[3], chain, atol=1e-12)


def test_skin_and_mesh() -> None:
    document = two_joint_rig().document()
    skin = document.skins()[0]
    assert skin.joints.tolist() == [0, 1]
    assert skin.skeleton == -1
    np.testing.assert_array_equal(skin.inverse_bind[0, :3, 3], [0, -1, 0])
    (part,) = document.mesh_parts()
    assert (part.node, part.skin) == (2, 0)
    assert part.triangles.tolist() == [[0, 1, 2]]
    assert part.joints[:, 0].tolist() == [1, 0, 1]
    np.testing.assert_array_equal(part.weights.sum(axis=1), 1.0)


def test_weights_are_normalised_over_all_sets() -> None:
    sample = two_joint_rig()
    attributes = sample.json["meshes"][0]["primitives"][0]["attributes"]
    attributes["JOINTS_1"] = sample.accessor(np.tile([1, 0, 0, 0], (3, 1)), "u2")
    attributes["WEIGHTS_0"] = sample.accessor(
        [[64, 0, 0, 0]] * 2 + [[0] * 4], "u1", normalized=True
    )
    attributes["WEIGHTS_1"] = sample.accessor(
        [[192, 0, 0, 0]] * 2 + [[0] * 4], "u1", normalized=True
    )
    (part,) = sample.document().mesh_parts()
    assert part.joints.shape == (3, 8)
    np.testing.assert_allclose(part.weights[0, [0, 4]], [0.25, 0.75])
    np.testing.assert_array_equal(part.weights[2], [1, 0, 0, 0, 0, 0, 0, 0])


def test_quantised_positions_are_readable() -> None:
    sample = two_joint_rig()
    primitive = sample.json["meshes"][0]["primitives"][0]
    primitive["attributes"]["POSITION"] = sample.accessor([[0, 0, 0], [0, 9, 0], [5, 0, 0]], "i2")
    sample.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    (part,) = sample.document().mesh_parts()
    np.testing.assert_array_equal(part.positions, [[0, 0, 0], [0, 9, 0], [5, 0, 0]])


def test_primitives_without_indices_and_of_other_modes() -> None:
    sample = two_joint_rig()
    primitives = sample.json["meshes"][0]["primitives"]
    del primitives[0]["indices"]
    primitives.append({"attributes": primitives[0]["attributes"], "mode": 1})
    (part,) = sample.document().mesh_parts()
    assert part.triangles.tolist() == [[0, 1, 2]]


def test_colours_of_material_vertices_and_texture(tmp_path: Path) -> None:
    image = Image.new("RGB", (2, 1))
    image.putdata([(255, 0, 0), (0, 0, 255)])
    image.save(tmp_path / "i.png")
    encoded = base64.b64encode((tmp_path / "i.png").read_bytes()).decode()
    sample = two_joint_rig()
    primitive = sample.json["meshes"][0]["primitives"][0]
    primitive["attributes"]["TEXCOORD_0"] = sample.accessor([[0.25, 0.5], [0.75, 0.5], [1.25, 0]])
    primitive["material"] = 0
    metallic: dict[str, Any] = {"baseColorFactor": [1, 1, 1, 1], "baseColorTexture": {"index": 0}}
    sample.json["materials"] = [{"pbrMetallicRoughness": metallic}]
    sample.json["textures"] = [{"source": 0}]
    sample.json["images"] = [{"uri": f"data:image/png;base64,{encoded}"}]
    (part,) = sample.document().mesh_parts()
    np.testing.assert_allclose(part.vertex_colour, [[1, 0, 0], [0, 0, 1], [1, 0, 0]], atol=1e-6)
    np.testing.assert_allclose(part.colour, [2 / 3, 0, 1 / 3], atol=1e-6)
    sample.json["images"] = [{"uri": "data:image/png;base64,iVBORw0KGgo="}]
    metallic["baseColorFactor"] = [0.2140411, 0, 1, 1]
    (part,) = sample.document().mesh_parts()
    np.testing.assert_allclose(part.colour, [0.5, 0, 1], atol=1e-3)


def test_gltf_with_outside_files(tmp_path: Path) -> None:
    sample = nasty_rig()
    document = GltfDocument.read(as_gltf_folder(sample, tmp_path, b"no image"))
    assert document.binary == sample.binary
    assert len(document.mesh_parts()) == 2


@pytest.mark.parametrize(
    ("name", "nodes", "joints"),
    [
        ("khronos_fox/Fox.glb", 26, 24),
        ("quaternius/spider.glb", 62, 39),
        ("quaternius/mech_george.glb", 49, 47),
        ("spider_bot/spider_bot_model.gltf", 25, 21),
    ],
)
def test_real_rigs(name: str, nodes: int, joints: int, shared_rig: Callable[[str], Path]) -> None:
    document = GltfDocument.read(shared_rig(name))
    assert len(document.node_names()) == nodes
    assert len(document.skins()[0].joints) == joints
    assert sum(len(part.triangles) for part in document.mesh_parts()) > 100


# ---- what is refused


def set_node(index: int, **fields: Any) -> Callable[[dict[str, Any]], Any]:
    return lambda content: content["nodes"][index].update(fields)


def set_accessor(index: int, **fields: Any) -> Callable[[dict[str, Any]], Any]:
    return lambda content: content["accessors"][index].update(fields)


REFUSED: dict[str, tuple[Callable[[dict[str, Any]], Any], str]] = {
    "cycle": (set_node(1, children=[0]), "own ancestor"),
    "node in itself": (set_node(2, children=[2]), "own ancestor"),
    "two parents": (set_node(2, children=[1]), "already a child of node 0"),
    "no such child": (set_node(0, children=[99]), r"nodes\[0\].children\[0\] is 99"),
    "negative child": (set_node(0, children=[-1]), r"children\[0\] is -1"),
    "wordy translation": (set_node(0, translation=["up", 0, 0]), r"nodes\[0\].translation"),
    "short matrix": (set_node(0, matrix=[1, 2]), r"nodes\[0\].matrix must be 16 numbers"),
    "no rotation": (set_node(0, rotation=[0, 0, 0, 0]), "length zero"),
    "absurd scale": (
        lambda c: [set_node(i, scale=[1e200, 1e200, 1e200])(c) for i in (0, 1)],
        "absurdly large",
    ),
    "no such skin": (set_node(2, skin=7), r"nodes\[2\].skin is 7"),
    "no such mesh": (set_node(2, mesh=True), r"nodes\[2\].mesh must be a whole number"),
    "skin without joints": (lambda c: c["skins"][0].update(joints=[]), r"skins\[0\].joints"),
    "no such joint": (lambda c: c["skins"][0].update(joints=[0, 55]), r"joints\[1\] is 55"),
    "weights of joints not there": (
        lambda c: c["skins"][0].update(joints=[0]),
        r"names joint 1, but skins\[0\] has 1",
    ),
    "billions": (set_accessor(1, count=4_000_000_000), "claims 4000000000 elements"),
    "endless digits": (set_accessor(1, count=10**400), "not an enormous number"),
    "billions of zeros": (
        lambda c: c["accessors"].append({"componentType": 5126, "count": 10**12, "type": "MAT4"}),
        r"accessors\[5\].count is 1000000000000",
    ),
    "negative count": (set_accessor(1, count=-3), r"accessors\[1\].count"),
    "unknown component": (set_accessor(1, componentType=5124), "componentType is 5124"),
    "unknown type": (set_accessor(1, type="VEC9"), "must be one of SCALAR"),
    "offset beyond": (set_accessor(1, byteOffset=10**9), "claims 3 elements"),
    "view beyond": (
        lambda c: c["bufferViews"][1].update(byteLength=10**6),
        r"bufferViews\[1\] ends at byte",
    ),
    "tiny stride": (lambda c: c["bufferViews"][1].update(byteStride=4), "byteStride is 4"),
    "long buffer": (lambda c: c["buffers"][0].update(byteLength=10**6), "only 232 are there"),
    "indices in fractions": (
        lambda c: c["meshes"][0]["primitives"][0].update(indices=3),
        "indices must be whole numbers",
    ),
    "positions of whole numbers in pairs": (set_accessor(1, type="VEC2"), "must have type VEC3"),
    "old version": (lambda c: c["asset"].update(version="1.0"), "asset.version"),
    "no version": (lambda c: c.pop("asset"), "asset.version"),
    "draco": (
        lambda c: c.update(extensionsRequired=["KHR_draco_mesh_compression"]),
        "KHR_draco_mesh_compression",
    ),
    "meshopt": (
        lambda c: c.update(extensionsRequired=["EXT_meshopt_compression"]),
        "EXT_meshopt_compression",
    ),
    "nodes no list": (lambda c: c.update(nodes={}), "nodes must be a list"),
    "scene of no node": (lambda c: c["scenes"][0].update(nodes=[77]), r"scenes\[0\].nodes"),
    "web buffer": (
        lambda c: c["buffers"][0].update(uri="https://example.org/b.bin"),
        r"buffers\[0\].uri",
    ),
    "bad base64": (
        lambda c: c["buffers"][0].update(uri="data:application/octet-stream;base64,@@@"),
        "bad base64",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refusals_name_file_and_place(case: str) -> None:
    change, expected = REFUSED[case]
    with pytest.raises(RigError, match=expected) as caught:
        read_all(edited(change))
    assert str(caught.value).startswith("file.glb: ")
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 300


@pytest.mark.parametrize(
    ("attribute", "values"),
    [
        ("POSITION", np.full((3, 3), np.nan)),
        ("POSITION", np.full((3, 3), np.inf)),
        ("WEIGHTS_0", np.full((3, 4), np.nan)),
    ],
)
def test_numbers_that_are_not_finite(attribute: str, values: np.ndarray) -> None:
    sample = two_joint_rig()
    attributes = sample.json["meshes"][0]["primitives"][0]["attributes"]
    attributes[attribute] = sample.accessor(values)
    with pytest.raises(RigError, match=f"{attribute} holds numbers that are not finite"):
        sample.document()


def test_indices_beyond_the_vertices() -> None:
    sample = two_joint_rig()
    sample.json["meshes"][0]["primitives"][0]["indices"] = sample.accessor([0, 1, 3], "u2")
    with pytest.raises(RigError, match="indices must be below the 3 vertices"):
        sample.document()


def test_inverse_bind_matrices_that_are_not_finite() -> None:
    sample = two_joint_rig()
    matrices = np.tile(np.eye(4), (2, 1, 1))
    matrices[1, 2, 2] = np.nan
    sample.json["skins"][0]["inverseBindMatrices"] = sample.accessor(matrices)
    with pytest.raises(RigError, match="inverseBindMatrices holds numbers that are not finite"):
        sample.document()


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"", "not a glTF file"),
        (b"\x89PNG\r\n", "not a glTF file"),
        (SMALL[:15], "truncated"),
        (SMALL[:-1], "truncated"),
        (SMALL + b"tail", "wrong length"),
        (SMALL[:4] + struct.pack("<I", 1) + SMALL[8:], "version 1"),
        (SMALL[:12] + struct.pack("<I", 10**9) + SMALL[16:], "longer than the file"),
        (SMALL[:16] + b"BIN\0" + SMALL[20:], "first chunk is not JSON"),
        (b'{"asset": {"version": "2.0"}', "cannot be parsed"),
        (b'{"asset": NaN}', "cannot be parsed"),
        (b'{"asset": 1e999}', "cannot be parsed"),
        (b'{"a":' * 100_000, "cannot be parsed"),
        (b'{"\xff": 1}', "cannot be parsed"),
    ],
)
def test_files_that_are_no_gltf(data: bytes, expected: str) -> None:
    with pytest.raises(RigError, match=expected):
        GltfDocument.from_bytes(data, "file.glb")


def test_missing_file_and_folder(tmp_path: Path) -> None:
    with pytest.raises(RigError, match=r"missing\.glb"):
        GltfDocument.read(tmp_path / "missing.glb")
    with pytest.raises(RigError, match="cannot be read"):
        GltfDocument.read(tmp_path)


@pytest.mark.parametrize(
    ("uri", "expected"),
    [
        ("missing.bin", "is not in"),
        ("../secret.bin", "outside"),
        ("%2e%2e/secret.bin", "outside"),
        ("/etc/hostname", "outside"),
        ("link.bin", "outside"),
        ("x" * 5000, "is not in"),
        ("", "is not in"),
        ("a\0b", "only files beside"),
    ],
)
def test_outside_buffers_stay_in_the_folder(uri: str, expected: str, tmp_path: Path) -> None:
    (tmp_path / "secret.bin").write_bytes(b"secret" * 100)
    folder = tmp_path / "rig"
    folder.mkdir()
    (folder / "link.bin").symlink_to(tmp_path / "secret.bin")
    path = as_gltf_folder(two_joint_rig(), folder, b"")
    content = json.loads(path.read_text())
    content["buffers"][0]["uri"] = uri
    path.write_text(json.dumps(content))
    with pytest.raises(RigError, match=expected):
        GltfDocument.read(path)


# ---- properties


@settings(
    max_examples=400, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)
@given(
    source=st.sampled_from([SMALL, NASTY]),
    changes=st.lists(
        st.tuples(st.integers(0, 1 << 30), st.integers(0, 255)), min_size=1, max_size=8
    ),
    cut=st.one_of(st.none(), st.integers(0, 1 << 30)),
)
def test_corrupted_bytes_give_a_document_or_an_error(
    source: bytes, changes: list[tuple[int, int]], cut: int | None
) -> None:
    data = bytearray(source)
    for at, value in changes:
        data[at % len(data)] = value
    if cut is not None:
        del data[cut % len(data) :]
        struct.pack_into("<I", data, 8, len(data)) if len(data) >= 12 else None
    with contextlib.suppress(RigError):
        read_all(bytes(data))


JSON_VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-3, 70000),
    st.sampled_from([10**9, 10**30, -1, 1e300, 0.5, 5126, 5121, "SCALAR", "VEC3", "MAT4", ""]),
    st.lists(st.integers(-1, 12), max_size=4),
    st.dictionaries(st.sampled_from(["count", "bufferView", "x"]), st.integers(-1, 9), max_size=2),
)


@settings(
    max_examples=400, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)
@given(pick=st.lists(st.tuples(st.integers(0, 1 << 30), JSON_VALUES), min_size=1, max_size=3))
def test_any_json_value_in_any_place_gives_a_document_or_an_error(
    pick: list[tuple[int, Any]],
) -> None:
    sample = nasty_rig()
    sample.finish()
    content = copy.deepcopy(sample.json)
    for at, value in pick:
        places = list(_places(content))
        holder, key = places[at % len(places)]
        holder[key] = value
    tracemalloc.start()
    try:
        with contextlib.suppress(RigError):
            read_all(pack_glb(content, sample.binary))
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert most < 64 << 20


def _places(part: Any) -> Any:
    """Every (container, key) of a JSON value."""
    keys = range(len(part)) if isinstance(part, list) else list(part)
    for key in keys:
        yield part, key
        if isinstance(part[key], list | dict):
            yield from _places(part[key])


unit_floats = st.floats(-1.0, 1.0)


@settings(deadline=None, derandomize=True)
@given(
    turn=st.lists(unit_floats, min_size=4, max_size=4),
    shift=st.lists(st.floats(-1e3, 1e3), min_size=3, max_size=3),
    scale=st.lists(st.floats(0.01, 100.0), min_size=3, max_size=3),
    mirrored=st.booleans(),
)
def test_matrices_come_apart_and_together_again(
    turn: list[float], shift: list[float], scale: list[float], mirrored: bool
) -> None:
    rotation = np.array(turn)
    if np.linalg.norm(rotation) < 1e-3:
        rotation = np.array([0.0, 0.0, 0.0, 1.0])
    rotation /= np.linalg.norm(rotation)
    signs = np.array([1.0, -1.0 if mirrored else 1.0, 1.0])
    matrix = compose(np.array(shift), rotation, np.array(scale) * signs)[None]
    parts = decompose(matrix, signs)
    np.testing.assert_allclose(np.linalg.norm(parts[1], axis=1), 1.0, atol=1e-12)
    np.testing.assert_allclose(parts[2][0], np.array(scale) * signs, rtol=1e-9)
    np.testing.assert_allclose(compose(*parts), matrix, atol=1e-7 * max(scale))


def test_half_turns_have_quaternions() -> None:
    for axis in np.vstack([np.eye(3), -np.eye(3), [[0.6, 0.8, 0.0]]]):
        rotation = np.append(axis, 0.0)
        matrix = compose(np.zeros(3), rotation, np.ones(3))
        found = quaternions(matrix[None, :3, :3])[0]
        assert abs(found @ rotation) == pytest.approx(1.0, abs=1e-12)
