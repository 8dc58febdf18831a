"""Documents as scene files and back."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from polypod.environment.scene import read_scene
from polypod.studio.document import default_document, judged
from polypod.studio.saved import document_of_scene, scene_text
from polypod.studio.world_files import WorldFiles

numbers = st.floats(-50.0, 50.0).map(lambda v: round(v, 3))
sizes = st.floats(0.01, 5.0).map(lambda v: round(v, 3))
texts = st.text(st.characters(codec="utf-8", exclude_categories=["C"]), max_size=12).map(str.strip)
boxes = st.builds(
    lambda size, place, yaw, forbidden, name: {
        "shape": "box",
        "position": place,
        **({"name": name} if name else {}),
        "size": size,
        "yaw": yaw,
        **({"forbidden": True} if forbidden else {}),
    },
    st.lists(sizes, min_size=3, max_size=3),
    st.lists(numbers, min_size=3, max_size=3),
    st.floats(-3.0, 3.0).map(lambda v: round(v, 3)),
    st.booleans(),
    texts,
)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(st.lists(boxes, max_size=4), st.lists(st.lists(numbers, min_size=2, max_size=2), max_size=3))
def test_a_saved_scene_opens_as_the_same_place(
    tmp_path: Path, obstacles: list[dict[str, object]], path: list[list[float]]
) -> None:
    document = default_document("ant")
    document["obstacle"] = obstacles
    document["path"] = path
    document["command"]["speed"] = 0.25
    document["terrain"] = {"generator": "hills", "relief": 0.3, "seed": 4}
    file = tmp_path / "scene.toml"
    file.write_text(scene_text(judged(document)), encoding="utf-8")
    files = WorldFiles()
    opened = document_of_scene(file, default_document(), files, own=False)
    assert files.ground_names == []
    for key in ("creature", "terrain", "path", "crowd"):
        assert opened[key] == document[key], key
    assert opened["command"]["speed"] == 0.25
    assert len(opened["obstacle"]) == len(obstacles)
    for one, other in zip(opened["obstacle"], obstacles, strict=True):
        assert one.pop("yaw") == pytest.approx(other["yaw"])
        assert one == {k: v for k, v in other.items() if k != "yaw"}


def test_a_scene_with_creatures_brings_them(tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    text = '[[creature]]\nrig = "wolf"\nspeed = 0.8\ncount = 3\n[[creature]]\nrig = "ant"\n'
    file.write_text(text, encoding="utf-8")
    document = document_of_scene(file, default_document(), WorldFiles(), own=False)
    assert document["creature"]["rig"] == "wolf"
    assert document["crowd"] == [{"rig": "wolf", "count": 2}, {"rig": "ant", "count": 1}]
    assert len(read_scene(file).creatures) == 2


def test_a_crowd_is_saved_and_opened_as_large_as_it_is(tmp_path: Path) -> None:
    document = default_document("wolf")
    small = {"rig": "wolf", "height": 0.5, "limit": {"Head": {"yaw": 0.2}}}
    document["crowd"] = [{**small, "count": 3}, {"rig": "ant", "count": 2}]
    file = tmp_path / "scene.toml"
    file.write_text(scene_text(judged(document)), encoding="utf-8")
    opened = document_of_scene(file, default_document(), WorldFiles(), own=False)
    assert opened["crowd"] == document["crowd"]
    herd = '[[creature]]\nrig = "wolf"\nheight = 0.5\ncount = 3\n'
    file.write_text(herd, encoding="utf-8")
    opened = document_of_scene(file, default_document(), WorldFiles(), own=False)
    assert opened["crowd"] == [{"rig": "wolf", "height": 0.5, "count": 2}]
