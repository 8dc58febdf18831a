"""Scenes with their files: opened, saved, laid out and unpacked, and refused."""

from __future__ import annotations

import argparse
import io
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from polypod.environment.scene import read_scene
from polypod.errors import PolypodError, SceneError
from polypod.morphology.builtin import build
from polypod.morphology.load import load_rig
from polypod.studio import mesh_limits
from polypod.studio.document import default_document, judged
from polypod.studio.luggage import Luggage
from polypod.studio.opening import opening
from polypod.studio.rigs_given import GivenRigs
from polypod.studio.scene_folder import confine, lay_out, unpack
from polypod.studio.scenes import document_of, scene_zip
from polypod.studio.stage import STEP, Stage
from polypod.studio.toml_text import table
from polypod.studio.world_files import WorldFiles
from studio.meshes_at_hand import WIDE_FACE, block
from studio.server import OURS, Served


@pytest.fixture
def files() -> Any:
    made = WorldFiles()
    yield made
    made.close()


WORLD = """
[terrain]
heightmap = "ground/hills.npy"
cell = 0.5
origin = [-10.0, -10.0]
water = "ground/wet.png"
[[obstacle]]
name = "step"
shape = "mesh"
file = "things/block.obj"
size = [1.0, 0.1, 1.0]
position = [0.0, 0.3, 3.0]
close = true
[[obstacle]]
shape = "box"
size = [0.4, 0.1, 0.4]
position = [0.2, 0.25, 1.2]
[[creature]]
rig = "spider"
speed = 0.3
"""


def wavy() -> bytes:
    held = io.BytesIO()
    along = np.linspace(0.0, 12.0, 41)
    np.save(held, 0.1 * np.sin(along)[:, None] * np.cos(along)[None])
    return held.getvalue()


def dry() -> bytes:
    from PIL import Image

    held = io.BytesIO()
    Image.new("L", (41, 41)).save(held, "PNG")
    return held.getvalue()


def written(folder: Path) -> Path:
    """Write the scene and its files, and return it."""
    for name, data in (
        ("things/block.obj", block(2, 1, 2, 5)), ("ground/hills.npy", wavy()),
        ("ground/wet.png", dry()), ("valley.toml", WORLD.encode()),
    ):  # fmt: skip
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)
    return folder / "valley.toml"


def opened(path: Path, rigs: GivenRigs, files: WorldFiles) -> dict[str, Any]:
    """Return the document with which `polypod studio PATH` begins."""
    none = dict.fromkeys(("leg", "spine", "forward", "height", "body_height"))
    asked = argparse.Namespace(rig=str(path), scene=None, **none)
    return opening(asked, rigs, files)


def test_a_scene_with_files_opens_is_walked_saved_and_opened_again(
    studio: Served, tmp_path: Path
) -> None:
    rigs, files = GivenRigs(), WorldFiles()
    document = opened(written(tmp_path / "first"), rigs, files)
    assert document["terrain"] == {"given": "valley"}
    assert document["obstacle"][0]["close"] is True
    stage = Stage(document, rigs.find, files)
    for _ in range(30):
        stage.step(STEP)
    heights = [stage.world.environment.obstacles[0].parts, stage.world.environment.terrain.heights]

    data = scene_zip(document, rigs, files)
    names = set(zipfile.ZipFile(io.BytesIO(data)).namelist())
    assert names == {"scene.toml", "things/block.obj", "ground/hills.npy", "ground/wet.png"}
    # By the command line, unpacked.
    folder = tmp_path / "second"
    folder.mkdir()
    zipfile.ZipFile(io.BytesIO(data)).extractall(folder)
    scene = read_scene(folder / "scene.toml")
    assert scene.obstacles[0].parts == heights[0]
    assert np.array_equal(scene.terrain.heights, heights[1])
    again = opened(folder / "scene.toml", rigs, files)
    # By the page.
    answer = studio.client.post("/scene?name=mine.zip", headers=OURS, content=data)
    assert answer.status_code == 200, answer.text
    by_page = answer.json()["document"]
    assert by_page["terrain"] == {"given": "scene"}
    for other in (again, by_page):
        for key in ("obstacle", "creature", "crowd", "path"):
            assert other[key] == document[key]
    walked = Stage(by_page, studio.rigs.find, studio.files)
    assert np.array_equal(walked.world.environment.terrain.heights, heights[1])
    # And once more from there.
    saved = studio.client.get("/export/scene.zip", headers=OURS)
    assert saved.headers["content-type"] == "application/zip"
    assert set(zipfile.ZipFile(io.BytesIO(saved.content)).namelist()) == names
    rigs.close()
    files.close()


def test_a_scene_says_which_files_it_wants_and_takes_them(studio: Served, tmp_path: Path) -> None:
    folder = written(tmp_path).parent
    answer = studio.client.post("/scene?name=valley.toml", headers=OURS, content=WORLD)
    assert answer.status_code == 422
    assert answer.json()["wants"] == ["hills.npy", "wet.png", "block.obj"]
    assert "hills.npy" in answer.json()["why"]
    for name in ("ground/hills.npy", "things/block.obj"):
        data = (folder / name).read_bytes()
        kept = studio.client.post(f"/file?name={Path(name).name}", headers=OURS, content=data)
        assert kept.status_code == 200
    answer = studio.client.post("/scene?name=valley.toml", headers=OURS, content=WORLD)
    assert answer.json()["wants"] == ["wet.png"]
    studio.client.post("/file?name=wet.png", headers=OURS, content=dry())
    answer = studio.client.post("/scene?name=valley.toml", headers=OURS, content=WORLD)
    assert answer.status_code == 200, answer.text
    assert answer.json()["document"]["terrain"] == {"given": "valley"}
    assert studio.files.waiting.files == {}


def test_tiles_and_rigs_come_along(studio: Served) -> None:
    scene = (
        '[terrain]\ntiles = "t/{column}_{row}.npy"\ncell = 1.0\norigin = [-4.0, -4.0]\n'
        '[[creature]]\nrig = "legs/mine.glb"\n'
    )
    held = io.BytesIO()
    np.save(held, np.zeros((5, 5)))
    for name in ("0_0.npy", "1_0.npy", "0_1.npy", "1_1.npy"):
        studio.client.post(f"/file?name={name}", headers=OURS, content=held.getvalue())
    studio.client.post("/file?name=mine.glb", headers=OURS, content=build("ant").glb)
    answer = studio.client.post("/scene?name=plain.toml", headers=OURS, content=scene)
    assert answer.status_code == 200, answer.text
    document = answer.json()["document"]
    assert document["creature"]["rig"].startswith("upload:")
    saved = studio.client.get("/export/scene.zip", headers=OURS).content
    names = zipfile.ZipFile(io.BytesIO(saved)).namelist()
    assert "t/1_0.npy" in names
    assert "mine.glb" in names
    answer = studio.client.post("/scene", headers=OURS, content=saved)
    assert answer.status_code == 200, answer.text
    stage = Stage(answer.json()["document"], studio.rigs.find, studio.files)
    for _ in range(10):
        stage.step(STEP)


def test_a_creature_file_comes_along_with_its_rig(studio: Served, tmp_path: Path) -> None:
    (tmp_path / "legs").mkdir()
    (tmp_path / "legs" / "body.glb").write_bytes(build("ant").glb)
    (tmp_path / "legs" / "mine.toml").write_text('rig = "body.glb"\nheight = 0.5\n')
    scene = tmp_path / "scene.toml"
    scene.write_text('[[creature]]\nrig = "legs/mine.toml"\n')
    rigs, files = GivenRigs(), WorldFiles()
    document = opened(scene, rigs, files)
    data = scene_zip(document, rigs, files)
    names = zipfile.ZipFile(io.BytesIO(data)).namelist()
    assert sorted(names) == ["body.glb", "mine.toml", "scene.toml"]
    answer = studio.client.post("/scene", headers=OURS, content=data)
    assert answer.status_code == 200, answer.text
    rig = load_rig(studio.rigs.find(answer.json()["document"]["creature"]["rig"]))
    skeleton = rig.legs.length
    assert skeleton == pytest.approx(load_rig(scene.parent / "legs" / "mine.toml").legs.length)
    rigs.close()


@pytest.mark.parametrize("name", ["../block.obj", "/etc/passwd.obj", "link.obj", "a/../../b.obj"])
def test_the_command_line_reads_nothing_outside_the_scenes_folder(
    tmp_path: Path, files: WorldFiles, name: str
) -> None:
    folder = tmp_path / "inside"
    folder.mkdir()
    (tmp_path / "block.obj").write_bytes(block(1, 1, 1))
    (folder / "link.obj").symlink_to(tmp_path / "block.obj")
    scene = folder / "scene.toml"
    for text in (
        f'[[obstacle]]\nshape = "mesh"\nposition = [0, 0, 2]\nfile = "{name}"\n',
        f'[terrain]\nmesh = "{name}"\n',
    ):
        scene.write_text(text, encoding="utf-8")
        with pytest.raises(SceneError, match="not in the scene's folder"):
            opened(scene, GivenRigs(), files)


def test_files_of_one_name_get_names_of_their_own(files: WorldFiles) -> None:
    document = default_document()
    document["obstacle"] = [
        {"shape": "mesh", "file": files.take(block(1, 1, n), "rock.obj")["file"],
         "position": [0.0, 0.0, 3.0 * n]}
        for n in (1, 2)
    ]  # fmt: skip
    document["obstacle"].append(dict(document["obstacle"][0]))
    named = Luggage(judged(document), GivenRigs(), files)
    assert [one["file"] for one in named.named["obstacle"]] == [
        "rock.obj", "rock-2.obj", "rock.obj",
    ]  # fmt: skip
    assert named.contents() == {"rock.obj": block(1, 1, 1), "rock-2.obj": block(1, 1, 2)}


def packed(entries: dict[str, bytes]) -> bytes:
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in entries.items():
            archive.writestr(name, data)
    return held.getvalue()


PLAIN = b'[terrain]\ngenerator = "hills"\n'
BAD_ZIPS = {
    "leads out": ({"scene.toml": PLAIN, "../out.obj": block(1, 1, 1)}, "leads out"),
    "absolute": ({"scene.toml": PLAIN, "/etc/out.obj": block(1, 1, 1)}, "leads out"),
    "no scene": ({"rock.obj": block(1, 1, 1)}, "0 scenes"),
    "two scenes": ({"a.toml": PLAIN, "b.toml": PLAIN}, "2 scenes"),
    "a bomb": ({"scene.toml": PLAIN, "a.raw": bytes(300 << 20)}, "unpacks to more"),
    "many": ({f"{i}.obj": b"" for i in range(600)}, "600 files"),
    "bad mesh": ({"scene.toml": PLAIN, "a.obj": WIDE_FACE}, "corners"),
}  # fmt: skip


@pytest.mark.parametrize("kind", BAD_ZIPS)
def test_bad_zips_are_refused_and_leave_nothing(studio: Served, kind: str) -> None:
    entries, word = BAD_ZIPS[kind]
    before = studio.runner.conductor.stage.document
    answer = studio.client.post("/scene", headers=OURS, content=packed(entries))
    assert answer.status_code == 422
    assert word in answer.json()["why"]
    assert studio.runner.conductor.stage.document is before
    assert not list(studio.files.new_folder().parent.rglob("*.toml"))


names = st.one_of(
    st.text(max_size=12),
    st.sampled_from(["..", "a/../..", "/", "{row}.npy", "t/{column}_{row}.npy", "x.obj", "\0"]),
)
lists = st.lists(st.fixed_dictionaries({}, optional={"file": names, "rig": names, "shape": names}))
scenes = st.fixed_dictionaries(
    {},
    optional={
        "terrain": st.dictionaries(st.sampled_from(["heightmap", "tiles", "mesh", "water"]), names),
        "obstacle": lists,
        "creature": lists,
    },
)
QUICK = settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=60
)


@QUICK
@given(scenes, st.dictionaries(st.sampled_from(["x.obj", "a_b.npy", "1_2.npy"]), st.binary()))
def test_what_a_scene_names_is_laid_out_inside_or_refused(
    tmp_path_factory: Any, values: dict[str, Any], at_hand: dict[str, bytes]
) -> None:
    folder = tmp_path_factory.mktemp("lay")
    outside = set(folder.parent.iterdir())
    loose = {}
    (folder / "loose").mkdir()
    for name, data in at_hand.items():
        loose[name] = folder / "loose" / name
        loose[name].write_bytes(data)
    inside = folder / "scene"
    inside.mkdir()
    parts = [table("[terrain]", values["terrain"])] if "terrain" in values else []
    parts += [table("[[obstacle]]", one) for one in values.get("obstacle", [])]
    parts += [table("[[creature]]", one) for one in values.get("creature", [])]
    try:
        scene = lay_out("\n".join(parts).encode(), "s.toml", inside, loose, lambda name: False)
    except PolypodError:
        pass
    else:
        confine(scene, values)
    assert set(folder.parent.iterdir()) == outside
    assert {file.name for file in folder.iterdir()} == {"loose", "scene"}
    for file in inside.rglob("*"):
        assert file.resolve().is_relative_to(inside)


@QUICK
@given(st.dictionaries(st.one_of(names, st.just("scene.toml")), st.binary(max_size=64)), st.data())
def test_any_zip_is_unpacked_inside_or_refused(
    tmp_path_factory: Any, entries: dict[str, bytes], data: Any
) -> None:
    content = bytearray(
        packed({name.replace("\0", "") or "_": held for name, held in entries.items()})
    )
    # Broken somewhere, or cut off.
    for _ in range(data.draw(st.integers(0, 3))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    content = content[: data.draw(st.integers(len(content) // 2, len(content)))]
    folder = tmp_path_factory.mktemp("zip")
    before = set(folder.parent.iterdir())
    try:
        scene = unpack(bytes(content), folder)
    except PolypodError:
        pass
    else:
        assert scene.resolve().is_relative_to(folder)
    assert set(folder.parent.iterdir()) == before


def test_a_scene_of_another_page_or_far_too_large_ground_is_refused(
    studio: Served, monkeypatch: Any
) -> None:
    monkeypatch.setattr(mesh_limits, "MOST_SAMPLES", 1000)
    answer = studio.client.post("/file?name=hills.npy", headers=OURS, content=wavy())
    assert answer.status_code == 422
    assert "samples" in answer.json()["why"]
    stranger = {**OURS, "Origin": "http://elsewhere.example"}
    for route in ("/mesh", "/file", "/scene"):
        assert studio.client.post(route, headers=stranger, content=b"x").status_code == 403


def test_a_document_from_the_page_opens_a_scene_without_files(files: WorldFiles) -> None:
    document = document_of(PLAIN, "s.toml", default_document(), GivenRigs(), files)
    assert document["terrain"] == {"generator": "hills"}


def test_a_creature_file_brings_its_creature_and_leaves_the_world(files: WorldFiles) -> None:
    rigs = GivenRigs()
    before = judged(default_document())
    before["obstacle"] = [{"shape": "box", "size": [1.0, 0.1, 1.0], "position": [0.0, 0.05, 3.0]}]
    text = b'rig = "beast.glb"\nheight = 0.5\n'
    try:
        with pytest.raises(PolypodError, match=r"beast\.glb"):
            document_of(text, "creature.toml", before, rigs, files)
        rigs.take(build("wolf").glb, "beast.glb")
        document = judged(document_of(text, "creature.toml", before, rigs, files))
        assert document["obstacle"] == before["obstacle"]
        own = load_rig(rigs.find(rigs.named("beast.glb")))
        small = load_rig(rigs.find(document["creature"]["rig"]))
        assert small.legs.length[0] == pytest.approx(
            0.5 * own.legs.length[0] / rigs.judge({"rig": rigs.named("beast.glb")})["height"]
        )
        for wrong in (b'rig = "../beast.glb"', b"rig = 3", b'rig = "ant"\nwings = 2'):
            with pytest.raises(PolypodError):
                document_of(wrong, "creature.toml", before, rigs, files)
    finally:
        rigs.close()
