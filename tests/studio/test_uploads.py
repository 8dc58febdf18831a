"""Rigs and scenes that are given: what is found, what is refused, what is kept."""

from __future__ import annotations

import hashlib
import io
import json
import struct
import time
import tracemalloc
import zlib
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from polypod.errors import RigError, SettingError
from polypod.morphology.builtin import build
from polypod.morphology.creature import read_creature
from polypod.studio import rig_limits, rigs_given
from polypod.studio.document import default_document
from polypod.studio.rigs_given import GivenRigs, clean_name
from polypod.studio.scenes import creature_toml
from polypod.studio.toml_text import table
from rigs.sample_rigs import pack_glb, pack_text
from studio.server import HOME, OURS, Served


def spider() -> bytes:
    return build("spider").glb


def parts_of(glb: bytes) -> tuple[dict[str, Any], bytes]:
    """Return the JSON and the BIN chunk of one of our own files."""
    size = struct.unpack_from("<I", glb, 12)[0]
    return json.loads(glb[20 : 20 + size]), glb[28 + size :]


def kept(studio: Served) -> list[str]:
    return sorted(path.name for path in studio.rigs._folder.iterdir())


def test_a_rig_is_taken_in_and_what_was_found_is_said(studio: Served) -> None:
    data = spider()
    answer = studio.client.post("/rig?name=C:%5CMy%20Spider.GLB", headers=OURS, content=data)
    assert answer.status_code == 200
    found = answer.json()
    digest = hashlib.sha256(data).hexdigest()
    assert found["rig"] == f"upload:{digest}"
    assert found["name"] == "My Spider.glb"
    assert kept(studio) == [digest]
    assert Path(studio.rigs.find(found["rig"])).name == "My Spider.glb"
    assert found["walks"] is True
    assert found["forward"] == "+z"
    assert len(found["legs"]) == 8
    nodes = {joint["node"]: joint for joint in found["joints"]}
    document = parts_of(data)[0]["nodes"]
    for joint in found["joints"]:
        assert joint["name"] == document[joint["node"]]["name"]
        assert joint["parent"] == -1 or joint["parent"] in nodes
        assert len(joint["place"]) == 3
    for leg in found["legs"]:
        above = leg["foot"]
        while above != leg["hip"]:
            above = nodes[above]["parent"]
            assert above >= 0
    assert "--" not in json.dumps(found["guesses"])


def test_a_built_in_is_judged_with_what_is_asked(studio: Served) -> None:
    asked = {"rig": "wolf", "leg": None, "spine": None, "forward": None, "height": 2.0}
    found = studio.client.post("/judge", headers=OURS, json=asked).json()
    assert (found["walks"], found["rig"], found["name"]) == (True, "wolf", "wolf")
    assert found["height"] == pytest.approx(2.0)
    assert len(found["legs"]) == 4
    assert found["spine"]
    turned = studio.client.post("/judge", headers=OURS, json={"rig": "wolf", "forward": "-z"})
    assert turned.json()["forward"] == "-z"


def test_a_rig_that_cannot_walk_says_why_and_shows_its_joints(studio: Served) -> None:
    asked: dict[str, Any] = {"rig": "spider", "leg": ["Nose:Tail"]}
    found = studio.client.post("/judge", headers=OURS, json=asked).json()
    assert found["walks"] is False
    assert "Nose" in found["why"]
    assert "--" not in found["why"]
    assert found["legs"] == []
    assert len(found["joints"]) > 20
    assert found["height"] > 0.0


@pytest.mark.parametrize(
    "asked",
    [
        [], "spider", {}, {"rig": ""}, {"rig": 3}, {"rig": "upload:0"}, {"rig": "../spider.glb"},
        {"rig": "/etc/passwd"}, {"rig": "spider", "legs": []}, {"rig": "spider", "leg": "a:b"},
        {"rig": "spider", "height": "tall"}, {"rig": "spider", "height": -1.0},
        {"rig": "spider", "spine": [1]}, {"rig": "spider", "forward": 1},
    ],
    ids=str,
)  # fmt: skip
def test_other_questions_are_refused(studio: Served, asked: Any) -> None:
    answer = studio.client.post("/judge", headers=OURS, json=asked)
    assert answer.status_code == 422
    assert "root:" not in answer.text
    assert 10 < len(answer.json()["why"]) < 500


def bomb(**changes: Any) -> bytes:
    """Return the spider with other JSON."""
    content, binary = parts_of(spider())
    return pack_glb(content | changes, binary)


def many_vertices() -> bytes:
    content, binary = parts_of(spider())
    for accessor in content["accessors"]:
        if accessor["type"] == "VEC3":
            accessor.pop("bufferView")
            accessor["count"] = 160_000
    return pack_glb(content, binary)


def many_shown() -> bytes:
    content, binary = parts_of(spider())
    first = len(content["nodes"])
    content["nodes"] += [{"mesh": 0, "children": [first + i + 1]} for i in range(600)]
    content["nodes"].append({})
    return pack_glb(content, binary)


def many_primitives() -> bytes:
    content, binary = parts_of(spider())
    content["meshes"][0]["primitives"] *= 3000
    return pack_glb(content, binary)


def deep_tree(depth: int) -> bytes:
    content, binary = parts_of(spider())
    first = len(content["nodes"])
    content["nodes"] += [{"children": [first + i + 1]} for i in range(depth)]
    content["nodes"].append({})
    return pack_glb(content, binary)


def with_picture(data: bytes) -> bytes:
    content, binary = parts_of(spider())
    at = len(binary)
    content["bufferViews"].append({"buffer": 0, "byteOffset": at, "byteLength": len(data)})
    content["images"] = [{"bufferView": len(content["bufferViews"]) - 1, "mimeType": "image/png"}]
    binary += data + b"\0" * (-len(data) % 4)
    content["buffers"][0]["byteLength"] = len(binary)
    return pack_glb(content, binary)


def png_of(width: int, height: int) -> bytes:
    """Return a PNG that says it is so large; what is in it does not matter."""

    def chunk(kind: bytes, content: bytes) -> bytes:
        check = struct.pack(">I", zlib.crc32(kind + content))
        return struct.pack(">I", len(content)) + kind + content + check

    head = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
    return (
        b"\x89PNG\r\n\x1a\n"
        + head
        + chunk(b"IDAT", zlib.compress(b"\0" * 1000))
        + chunk(b"IEND", b"")
    )


HEADER = '{"asset": {"version": "2.0"}, "extras": '
BOMBS = {
    "vertices without bytes": (many_vertices, "vertices"),
    "one mesh shown often": (many_shown, "vertices"),
    "one primitive listed often": (many_primitives, "vertices"),
    "a deep tree": (lambda: deep_tree(5000), "nodes"),
    "many nodes": (lambda: bomb(nodes=[{}] * 5000), "nodes"),
    "many joints": (lambda: bomb(skins=[{"joints": [0] * 100_000}]), "joints"),
    "millions of values": (
        lambda: pack_text(HEADER + "[" + "[]," * 3_000_000 + "[]]}", b""), "values"),
    "a wide JSON": (lambda: (HEADER + "[" + "0," * 2_000_000 + "0]}").encode(), "values"),
    "brackets without end": (lambda: pack_text(HEADER + "[" * 200_000, b""), "JSON"),
    "a picture of gigapixels": (lambda: with_picture(png_of(60_000, 60_000)), "picture"),
    "large pictures": (lambda: with_picture(png_of(12_000, 12_000)), "megapixels"),
    "other files": (lambda: json.dumps({"asset": {"version": "2.0"}, "buffers": [
        {"byteLength": 4, "uri": "../../etc/passwd"}]}).encode(), "save the rig as a GLB"),
    "no glTF": (lambda: b"MZ\x90\0" * 1000, "not a glTF"),
    "nothing": (lambda: b"", "not a glTF"),
    "cut off": (lambda: spider()[:5000], "truncated"),
    "no skin": (lambda: pack_glb({"asset": {"version": "2.0"}}, b""), "no skin"),
}  # fmt: skip


@pytest.mark.parametrize("kind", BOMBS)
def test_bombs_are_refused_soon_with_a_word_and_not_kept(studio: Served, kind: str) -> None:
    make, word = BOMBS[kind]
    data = make()
    tracemalloc.start()
    began = time.monotonic()
    answer = studio.client.post("/rig?name=b.glb", headers=OURS, content=data)
    took = time.monotonic() - began
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert answer.status_code == 422
    assert word in answer.json()["why"]
    assert len(answer.json()["why"]) < 500
    assert took < 10.0
    assert most < 200e6
    assert kept(studio) == []


def test_pictures_in_other_formats_are_not_opened(tmp_path: Path) -> None:
    picture = io.BytesIO()
    Image.new("RGB", (8, 8)).save(picture, "EPS")
    glb = with_picture(picture.getvalue())
    rig_limits.judge_upload(glb, "rig.glb")
    with pytest.raises(Image.UnidentifiedImageError):
        Image.open(picture, formats=rig_limits.FORMATS)


def test_a_gigabyte_is_refused_before_it_is_read(studio: Served) -> None:
    # Without a length: cut off as soon as it is too much.
    pieces = (b"x" * (1 << 20) for _ in range(66))
    answer = studio.client.post("/rig", headers=OURS, content=pieces)
    assert answer.status_code == 413
    assert "64 MiB" in answer.json()["why"]
    claimed = studio.client.post("/rig", headers={**OURS, "Content-Length": str(1 << 30)})
    assert claimed.status_code == 413
    scene = studio.client.post("/scene", headers=OURS, content=b"#" * ((1 << 20) + 1))
    assert scene.status_code == 413
    assert kept(studio) == []


def test_the_oldest_unused_rig_goes(studio: Served, monkeypatch: Any) -> None:
    monkeypatch.setattr(rigs_given, "MOST_UPLOADS", 2)
    rigs = studio.rigs
    first = rigs.take(bomb(extras=1), "1.glb")
    second = rigs.take(bomb(extras=2), "2.glb")
    assert rigs.take(bomb(extras=1), "one.glb") == first
    assert Path(rigs.find(first)).name == rigs.name(first) == "one.glb"
    third = rigs.take(bomb(extras=3), "3.glb")
    assert len(kept(studio)) == 2
    assert Path(rigs.find(first)).is_file()
    with pytest.raises(SettingError, match="drop its file"):
        rigs.find(second)
    rigs.use([first, third])
    with pytest.raises(SettingError, match="in use"):
        rigs.take(bomb(extras=4), "4.glb")
    rigs.use([third])
    fourth = rigs.take(bomb(extras=4), "4.glb")
    assert {rigs.name(third), rigs.name(fourth)} == {"3.glb", "4.glb"}


def test_the_rig_that_walks_stays(studio: Served, monkeypatch: Any) -> None:
    monkeypatch.setattr(rigs_given, "MOST_UPLOADS", 2)
    walks = studio.rigs.take(bomb(extras=0), "walks.glb")
    studio.runner.conductor.stage.document["crowd"] = [{"rig": walks, "count": 2}]
    for n in (1, 2, 3):
        answer = studio.client.post("/rig", headers=OURS, content=bomb(extras=n))
        assert answer.status_code == 200
    assert len(kept(studio)) == 2
    assert studio.rigs.name(walks) == "walks.glb"


def test_uploads_go_with_the_studio() -> None:
    rigs = GivenRigs()
    file = Path(rigs.find(rigs.take(spider(), "s.glb")))
    assert file.is_file()
    rigs.close()
    assert not file.parent.parent.exists()


@pytest.mark.parametrize(
    ("given", "cleaned"),
    [
        ("fox.glb", "fox.glb"), ("/etc/passwd", "passwd.glb"), ("..\\..\\a.b.glb", "a.b.glb"),
        ("", "rig.glb"), ("..", "rig.glb"), ("a\0b\n.glb", "ab.glb"), ("<img>.glb", "img.glb"),
        ("CON.glb", "rig.glb"), ("lpt1.x.glb", "rig.glb"), ("a;$(b)&c.glb", "abc.glb"),
        ("x" * 500, "x" * 75 + ".glb"), ("Füchsin.gltf", "Füchsin.glb"),
    ],
)  # fmt: skip
def test_names_are_cleaned(given: str, cleaned: str) -> None:
    assert clean_name(given, ".glb") == cleaned


SCENE = """
[terrain]
generator = "hills"
relief = 0.3
[[obstacle]]
shape = "box"
size = [0.4, 0.1, 0.4]
position = [0.2, 0.25, 1.2]
[[scatter]]
count = 2
area = [-1.0, 1.0, 1.0, 4.0]
size = [[0.08, 0.04, 0.08], [0.3, 0.08, 0.3]]
[[creature]]
rig = "wolf"
speed = 1.5
gait = "trot"
path = [[0, 0], [0, 2]]
"""


def test_a_scene_becomes_the_document(studio: Served) -> None:
    answer = studio.client.post("/scene", headers=OURS, content=SCENE)
    assert answer.status_code == 200, answer.text
    document = studio.runner.conductor.stage.document
    assert answer.json()["document"] == document
    assert document["creature"]["rig"] == "wolf"
    assert document["command"]["speed"] == 1.5
    assert document["gait"]["name"] == "trot"
    assert len(document["gait"]["start"]) == 4
    assert document["terrain"]["generator"] == "hills"
    assert len(document["obstacle"]) == 3
    # What goes out comes in again.
    text = studio.client.get("/export/scene.toml", headers=OURS).text
    assert studio.client.post("/scene", headers=OURS, content=text).status_code == 200
    assert studio.runner.conductor.stage.document == document


@pytest.mark.parametrize(
    ("scene", "word"),
    [
        (b"\xff\xfe", "TOML"), (b"= 3", "TOML"), (b"x = 3", "x"),
        (b'[terrain]\nheightmap = "/etc/passwd.npy"\ncell = 1.0', "not in the scene's folder"),
        (b'[terrain]\ntiles = "/etc/{column}_{row}.npy"\ncell = 1.0', "not in the scene's folder"),
        (b'[terrain]\nmesh = "../passwd.obj"', "not in the scene's folder"),
        (b'[[obstacle]]\nshape = "mesh"\nfile = "/etc/passwd.obj"', "not in the scene's folder"),
        (b'[[creature]]\nrig = "/etc/passwd.glb"', "not in the scene's folder"),
        (b'[[creature]]\nrig = "Fox.glb"', "names Fox.glb, which the studio has not"),
        (b'[[creature]]\nrig = "wolf"\ngait = "/etc/passwd.toml"', "gait"),
        (b'[terrain]\ngenerator = "moon"', "moon"),
        (b"a = " + b"[" * 100_000, "TOML"),
    ],
)  # fmt: skip
def test_other_scenes_are_refused(studio: Served, scene: bytes, word: str) -> None:
    before = studio.runner.conductor.stage.document
    answer = studio.client.post("/scene", headers=OURS, content=scene)
    assert answer.status_code == 422
    assert word in answer.json()["why"]
    assert "polypod-studio-" not in answer.text
    assert studio.runner.conductor.stage.document is before


def test_exports_that_are_not_there_say_so(studio: Served) -> None:
    for name, status in (("walk.glb", 422), ("walk.npz", 422), ("walk.exe", 404)):
        answer = studio.client.get(f"{HOME}/export/{name}", headers=OURS)
        assert answer.status_code == status, name
        assert answer.json()["why"]
    wrong = studio.client.get("/export/walk.glb?creature=-1", headers=OURS)
    assert (wrong.status_code, "creature" in wrong.json()["why"]) == (422, True)


def test_a_creature_file_is_read_back_as_it_was_asked(studio: Served, tmp_path: Path) -> None:
    creature = default_document(studio.rigs.take(spider(), 'a "spider".glb'))["creature"]
    creature |= {"leg": ['A "b"\\:C\n', "é:漢"], "forward": "-x", "height": 0.1 + 0.2}
    file = tmp_path / "creature.toml"
    file.write_text(creature_toml(creature, studio.rigs), encoding="utf-8")
    back = read_creature(file)
    assert back.rig == "a spider.glb"
    assert back.legs == tuple(creature["leg"])
    assert (back.forward, back.height, back.body_height) == ("-x", 0.1 + 0.2, None)
    assert back.spine is None


def test_a_creature_file_keeps_what_the_studio_does_not_change(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        'rig = "spider"\ntail = []\nheight = 0.5\n[body]\nthickness = 0.1\n'
        '[limit."a joint"]\nbend = [-0.5, 1.0]\n[foot."ä"]\nweight = 2.0\n',
        encoding="utf-8",
    )
    rigs = GivenRigs()
    try:
        creature = default_document(rigs.point_to(file))["creature"] | {"height": 0.7}
        written = tmp_path / "written.toml"
        written.write_text(creature_toml(creature, rigs), encoding="utf-8")
    finally:
        rigs.close()
    back, first = read_creature(written), read_creature(file)
    assert (back.height, first.height) == (0.7, 0.5)
    for key in ("rig", "tail", "thickness", "limit", "foot_weight"):
        assert getattr(back, key) == getattr(first, key)


def test_no_rig_error_names_the_studios_own_folder(studio: Served) -> None:
    rig = studio.rigs.take(spider(), "mine.glb")
    found = studio.rigs.judge({"rig": rig, "leg": ["#99999:#1"]})
    assert found["why"].startswith("mine.glb:")
    with pytest.raises(RigError, match=r"^b\.glb"):
        studio.rigs.take(spider()[:100], "b.glb")
    assert table("", {"a": [1, True]}) == "a = [1, true]\n"
