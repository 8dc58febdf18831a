"""Meshes and grounds of files: taken in, walked on, saved with their scene, and refused."""

from __future__ import annotations

import contextlib
import struct
import time
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from polypod.errors import PolypodError, SettingError
from polypod.morphology.builtin import build
from polypod.studio import mesh_limits, world_files
from polypod.studio.document import default_document, edited, judged
from polypod.studio.stage import STEP, Stage
from polypod.studio.world_files import WorldFiles
from studio.meshes_at_hand import WIDE_FACE, block
from studio.server import OURS, Served

QUICK = settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=60
)


@pytest.fixture
def files() -> Any:
    made = WorldFiles()
    yield made
    made.close()


def on_a_mesh(files: WorldFiles, size: list[float], place: list[float]) -> dict[str, Any]:
    mesh = files.take(block(1, 1, 1), "block.obj")["file"]
    document = default_document()
    document["obstacle"] = [{"shape": "mesh", "file": mesh, "size": size, "position": place}]
    return judged(document)


def test_a_mesh_is_stood_on_and_resized_while_it_walks(files: WorldFiles) -> None:
    stage = Stage(on_a_mesh(files, [3.0, 0.1, 3.0], [0.0, 0.05, 0.0]), lambda rig: rig, files)
    for _ in range(60):
        stage.step(STEP)
    state = stage.herd.state
    standing = ~state.swinging[0]
    assert state.foot[0, standing, 1] == pytest.approx(0.1, abs=1e-3)
    assert (state.foot_support[0, standing] == 0).all()
    stage.apply(edited(stage.document, ["obstacle", 0, "size"], [3.0, 0.2, 3.0]))
    (part,) = stage.world.environment.obstacles[0].parts
    assert np.ptp(np.array(part), axis=0) == pytest.approx([3.0, 0.2, 3.0])
    with pytest.raises(SettingError, match="not split so"):
        stage.apply(edited(stage.document, ["obstacle", 0, "concavity"], 0.5))
    with pytest.raises(SettingError, match="not in the studio"):
        stage.apply(edited(stage.document, ["obstacle", 0, "file"], "upload:" + 64 * "0"))


def test_a_mesh_is_posted_drawn_and_named(studio: Served) -> None:
    answer = studio.client.post("/mesh?name=C:%5Crock.OBJ", headers=OURS, content=block(2, 1, 4))
    assert answer.status_code == 200, answer.text
    found = answer.json()
    assert (found["name"], found["size"], found["parts"]) == ("rock.obj", [2.0, 1.0, 4.0], 1)
    assert "close" not in found
    assert studio.runner.said[-1]["meshes"] == {found["file"]: "rock.obj"}
    arrays = studio.client.get(f"/mesh/{found['file']}", headers=OURS).content
    kind, length = struct.unpack_from("<II", arrays)
    assert kind == 2
    place = np.frombuffer(arrays, "<f4", 12 * 9, 8 + length).reshape(-1, 3)
    assert place.min(axis=0).tolist() == [-0.5] * 3
    assert place.max(axis=0).tolist() == [0.5] * 3
    assert studio.client.get("/mesh/upload:0", headers=OURS).status_code == 422


def test_holes_get_lids_and_it_is_said(studio: Served) -> None:
    answer = studio.client.post("/mesh?name=cup.obj", headers=OURS, content=block(1, 1, 1, 5))
    assert answer.json()["close"] is True
    # As a document has it, it is made again from the file.
    document = default_document()
    mesh = {key: answer.json()[key] for key in ("file", "size", "close")}
    document["obstacle"] = [{"shape": "mesh", **mesh, "position": [0.0, 0.5, 3.0]}]
    stage = Stage(judged(document), lambda rig: rig, studio.files)
    assert len(stage.world.environment.obstacles[0].parts) == 1


BAD_MESHES = {
    "an empty one": (b"", "no face", "a.obj"),
    "no mesh at all": (b"MZ\x90\0" * 1000, "no face", "a.obj"),
    "flat": (b"v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3", "flat", "a.obj"),
    "far too many words": (b"v 1 2 3\n" * 2_500_000, "words", "a.obj"),
    "many faces": (b"v 0 0 0\n" + b"f 1 1 1\n" * 450_000, "vertices and faces", "a.obj"),
    "one endless face": (b"v 0 0 0\n" * 3000 + WIDE_FACE, "corners", "a.obj"),
    "no number": (b"v 0 nan 0\nv 1 0 0\nv 0 0 1\nf 1 2 3", "no number", "a.obj"),
    "another kind": (b"solid x", "is no mesh", "a.stl"),
    "a picture": (b"\x89PNG", "is no mesh", "a.png"),
    "a glTF of other files": (
        b'{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": "../x"}]}',
        "a file of its own", "a.gltf"),
    "a broken GLB": (build("spider").glb[:5000], "truncated", "a.glb"),
}  # fmt: skip


@pytest.mark.parametrize("kind", BAD_MESHES)
def test_bad_meshes_are_refused_soon_with_a_word_and_not_kept(studio: Served, kind: str) -> None:
    data, word, name = BAD_MESHES[kind]
    began = time.monotonic()
    answer = studio.client.post(f"/mesh?name={name}", headers=OURS, content=data)
    assert time.monotonic() - began < 20.0
    assert answer.status_code == 422
    assert word in answer.json()["why"]
    assert "/tmp" not in answer.text
    assert studio.files.mesh_names == {}


def test_a_gigabyte_of_mesh_or_file_is_refused_before_it_is_read(studio: Served) -> None:
    for route in ("/mesh", "/file", "/scene"):
        claimed = studio.client.post(route, headers={**OURS, "Content-Length": str(1 << 30)})
        assert claimed.status_code == 413, route


def test_meshes_not_in_use_make_room(files: WorldFiles, monkeypatch: Any) -> None:
    monkeypatch.setattr(world_files, "MOST_MESHES", 2)
    first = files.take(block(1, 1, 1), "1.obj")["file"]
    second = files.take(block(1, 1, 2), "2.obj")["file"]
    files.use([first])
    third = files.take(block(1, 1, 3), "3.obj")["file"]
    assert set(files.mesh_names) == {first, third}
    with pytest.raises(SettingError, match="drop its file"):
        files.solid(second, {})
    files.use([first, third])
    with pytest.raises(SettingError, match="in use"):
        files.take(block(1, 1, 4), "4.obj")
    assert files.mesh(first).file.is_file()


@QUICK
@given(st.binary(max_size=200), st.sampled_from(["a.obj", "a.glb", "a.gltf", "a.npy", "a.png",
                                                 "a.raw", "a.tif", "a.exe"]))  # fmt: skip
def test_any_file_is_judged_in_words(tmp_path_factory: Any, data: bytes, name: str) -> None:
    file = tmp_path_factory.mktemp("file") / name
    file.write_bytes(data)
    with contextlib.suppress(PolypodError):
        mesh_limits.judge_file(file)


@QUICK
@given(st.lists(st.sampled_from(
    ["v 0 0 0", "v 1 0 0", "v 0 1 0", "v 0 0 1", "v 1e9 0 0", "f 1 2 3", "f 1 3 2", "f 1 4 2",
     "f 2 4 3", "f 1 3 4", "f -1 -2 -3", "f 9 9 9", "vn 0 0 1", "# x", "f 1//2 2/1 3/1/1", ""]),
    max_size=16))  # fmt: skip
def test_any_obj_is_a_solid_or_refused(lines: list[str]) -> None:
    files = WorldFiles()
    why = ""
    try:
        found = files.take("\n".join(lines).encode(), "a.obj")
    except PolypodError as error:
        why = str(error)
    assert "polypod-studio" not in why
    try:
        assert (files.mesh_names == {}) == bool(why)
        if why:
            return
        assert found["parts"] >= 1
        assert files.surface(found["file"])
    finally:
        files.close()
