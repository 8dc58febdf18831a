"""Scene files: what is read, and one sentence for whatever is wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PIL import Image

from polypod.environment import Environment
from polypod.environment.scene import Scene, read_scene
from polypod.errors import SceneError

EXAMPLES = Path(__file__).parents[2] / "examples" / "scenes"

FULL = """
[terrain]
heightmap = "ground.npy"
cell = 0.5
origin = [-1.0, -2.0]

[[obstacle]]
name = "crate-1"
shape = "box"
size = [0.4, 0.3, 0.5]
position = [1.0, 0.15, 2.0]
yaw = 0.3
forbidden = true

[[obstacle]]
shape = "hull"
points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
position = [0, 0, 0]
rotation = [0.0, 0.0, 0.0, 1.0]

[[scatter]]
count = 4
area = [-1.0, -1.0, 1.0, 1.0]
size = [[0.1, 0.1, 0.1], [0.2, 0.2, 0.2]]
seed = 7
forbidden_share = 0.5

[[creature]]
rig = "spider"
leg = ["a:b"]
count = 3
position = [0.0, 1.0]
heading = 0.5
gait = "spider"
speed = 0.5
path = [[0, 0], [4, 4.5]]

[[push]]
creature = 2
time = 3.0
velocity = [0.5, 0.0, 0.0]
at = -0.1
"""


def scene_of(folder: Path, text: str | bytes) -> Scene:
    path = folder / "scene.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_scene(path)


def test_everything_is_read(tmp_path: Path) -> None:
    np.save(tmp_path / "ground.npy", np.arange(12.0).reshape(3, 4))
    scene = scene_of(tmp_path, FULL)
    assert scene.terrain.height_at(-1.0 + 0.5, -2.0 + 0.25) == pytest.approx(3.0)
    assert [o.shape for o in scene.obstacles] == ["box", "hull", "box", "box", "box", "box"]
    assert scene.obstacles[0].forbidden
    assert sum(o.forbidden for o in scene.obstacles[2:]) == 2
    assert scene.creatures[0].path == ((0.0, 0.0), (4.0, 4.5))
    assert scene.creatures[0].count == 3
    assert scene.creatures[0].height is None
    assert scene.pushes[0].velocity == (0.5, 0.0, 0.0)
    assert scene.pushes[0].at == -0.1
    assert isinstance(scene.environment(), Environment)


def test_an_empty_scene_is_flat_ground(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, "")
    assert scene.terrain.height_at(5.0, 7.0) == 0.0
    assert scene.obstacles == ()


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda p: p.stem)
def test_the_examples_can_be_read(path: Path) -> None:
    scene = read_scene(path)
    assert scene.creatures[0].rig == "spider"
    table = scene.environment().table
    assert len(table.kind) > 0 or table.terrain_range[1] > table.terrain_range[0]


@pytest.mark.parametrize("bits", [8, 16])
def test_a_grey_picture_is_a_terrain(tmp_path: Path, bits: int) -> None:
    white = 2**bits - 1
    kind = np.uint8 if bits == 8 else np.uint16
    Image.fromarray(np.array([[0, white], [white // 3, 0]], dtype=kind)).save(tmp_path / "g.png")
    water = np.array([[255, 0], [0, 0]], dtype=np.uint8)
    Image.fromarray(water).save(tmp_path / "w.png")
    scene = scene_of(
        tmp_path, '[terrain]\nheightmap = "g.png"\ncell = 1\nrelief = 3.0\nwater = "w.png"'
    )
    assert scene.terrain.height_at(1.0, 0.0) == pytest.approx(3.0)
    assert scene.terrain.height_at(0.0, 1.0) == pytest.approx(1.0, rel=1e-4)
    assert scene.terrain.water is not None
    assert scene.terrain.water[0, 0]


BOX = '[[obstacle]]\nshape = "box"\nposition = [0, 0, 0]\n'
RAW = '[terrain]\nheightmap = "a.raw"\ncell = 1\nformat = "float32"\n'
CREATURE = '[[creature]]\nrig = "spider"\n'
SCATTER = "[[scatter]]\ncount = 1\narea = [0, 0, 1, 1]\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("terain = 1", ["'terain'", "terrain, obstacle"]),
        ("[terrain", ["no valid TOML"]),
        (b"\xff\xfe", ["no valid TOML"]),
        ("[terrain]\ncell = 1", ["needs a heightmap"]),
        ("terrain = 3", ["must be a table"]),
        ('[terrain]\nheightmap = "none.npy"\ncell = 1', ["none.npy", "can be read"]),
        (
            '[terrain]\nheightmap = "a.tif"\ncell = 1',
            ["of a .tif", "no key 'cell'", "origin, water"],
        ),
        ('[terrain]\nheightmap = "a.jpg"\ncell = 1', [".npy, .png, .raw, .tif", ".obj"]),
        ('[terrain]\nheightmap = "a.obj"\ncell = 1', ["a.obj", "named by mesh"]),
        ('[terrain]\nheightmap = "none.tif"', ["none.tif", "GeoTIFF"]),
        ('[terrain]\nheightmap = "a.npy"\ncell = 1\nrelief = 1', ["no key 'relief'"]),
        ('[terrain]\nheightmap = "a.npy"\ngenerator = "hills"', ["only one"]),
        ('[terrain]\nheightmap = "a.raw"\ncell = 1', ["needs format", "uint16-big"]),
        ('[terrain]\nheightmap = "a.raw"\ncell = 1\nformat = "u8"', ["'u8'", "uint8"]),
        ('[terrain]\nheightmap = "a.raw"\ncell = 1\nformat = "uint8"', ["needs relief"]),
        (RAW + "rows = 0", ["rows = 0", "from 1 to"]),
        (RAW + "rows = 4", ["a.raw", "6 samples", "4 rows of 1"]),
        (RAW, ["a.raw", "no square", "rows or columns"]),
        ('[terrain]\nmesh = "a.stl"', ["mesh = 'a.stl'", ".obj, .glb, .gltf"]),
        ('[terrain]\nmesh = "none.obj"', ["none.obj", "can be read"]),
        ('[terrain]\nmesh = "none.glb"', ["none.glb", "cannot be read"]),
        ('[terrain]\nmesh = "a.obj"\nscale = 0', ["scale = 0"]),
        ('[terrain]\nmesh = "a.obj"\nrelief = 1', ["of a mesh", "no key 'relief'"]),
        ('[terrain]\nheightmap = "a.npy"\ncell = 0', ["cell = 0", "1e-06"]),
        ('[terrain]\nheightmap = "a.npy"\ncell = nan', ["cell = nan"]),
        ('[terrain]\nheightmap = "a.png"\ncell = 1', ["needs relief"]),
        ('[terrain]\nheightmap = "nan.npy"\ncell = 1', ["nan.npy", "no number"]),
        ('[terrain]\nheightmap = "empty.npy"\ncell = 1', ["empty.npy", "[0, 3]"]),
        ('[terrain]\nheightmap = "text.npy"\ncell = 1', ["text.npy", "real numbers"]),
        ('[terrain]\nheightmap = "bad.png"\ncell = 1\nrelief = 1', ["bad.png", "picture"]),
        ('[terrain]\nheightmap = "rgb.png"\ncell = 1\nrelief = 1', ["rgb.png", "grey"]),
        ('[terrain]\ngenerator = "hill"', ["'hill'", "hills, stairs"]),
        ('[terrain]\ngenerator = ["hills"]', ["one of hills"]),
        ('[terrain]\ngenerator = "stairs"\nseed = 2', ["'seed'", "rise, run, count"]),
        ('[terrain]\ngenerator = "stairs"\nrise = -1', ["rise = -1"]),
        ('[terrain]\ngenerator = "stairs"\ncount = 1.5', ["count = 1.5", "whole number"]),
        ('[terrain]\ngenerator = "stairs"\ndown = 1', ["down = 1", "true or false"]),
        ('[terrain]\ngenerator = "hills"\nsize = 1e5\nwavelength = 1e-3', ["samples"]),
        ('[terrain]\ngenerator = "slope"\nangle = 1.57', ["angle = 1.57"]),
        (BOX, ["needs size"]),
        (BOX + "size = [1, 1]", ["[x, y, z]"]),
        (BOX + "size = [1, 1, 0]", ["number 1", "from 1e-06"]),
        (BOX + "size = [1, 1, 1]\ncolour = 3", ["'colour'", "name, shape"]),
        (BOX + "size = [1, 1, 1]\nyaw = true", ["yaw = true", "a number"]),
        (BOX + "size = [1, 1, 1]\nyaw = 1\nrotation = [0, 0, 0, 1]", ["both"]),
        (BOX + "size = [1, 1, 1]\nrotation = [0, 0, 0, 0.5]", ["length 1"]),
        (BOX + "size = [1, 1, 1]\nvelocity = [0, 0]", ["velocity", "[x, y, z]"]),
        (BOX + "size = [1, 1, 1]\nvelocity = [0, 0, 500]", ["number 1", "within 100"]),
        (BOX + "size = [1, 1, 1]\nvelocity = [0, 0, 1]\npath = [[0, 0, 1]]", ["both"]),
        (BOX + "size = [1, 1, 1]\npath = [[0, 0, 1]]", ["a speed above 0"]),
        (BOX + "size = [1, 1, 1]\npath = [[0, 0]]\nspeed = 1", ["path"]),
        (BOX + "size = [1, 1, 1]\nspeed = 1", ["without a path"]),
        (BOX + "size = [1, 1, 1]\nturn_rate = 500", ["turn_rate = 500", "-100 to 100"]),
        (BOX + 'size = [1, 1, 1]\nfile = "a.obj"', ["a box", "'file'", "rotation, forbidden"]),
        (BOX.replace("box", "hull") + "size = [1, 1, 1]", ["a hull", "'size'", "points"]),
        (BOX.replace("box", "cone"), ["'cone'", "box, cylinder, sphere, hull", "mesh"]),
        (BOX.replace("box", "sphere") + "size = [1, 1, 2]", ["equal"]),
        (BOX.replace("box", "hull") + "points = [[0,0,0],[1,0,0],[0,1,0],[1,1,0]]", ["plane"]),
        (BOX.replace("box", "hull") + "points = [[0,0,0],[1,0,0]]", ["4 to"]),
        ("[obstacle]\nshape = 'box'", ["[[obstacle]]"]),
        (SCATTER, ["needs size"]),
        (SCATTER + "size = [[1, 1, 1], [0.5, 1, 1]]", ["least, greatest"]),
        (SCATTER + "size = [[1, 1, 1], [1, 1, 1]]\nforbidden_share = 2", ["forbidden_share = 2"]),
        (SCATTER + "size = [[0, 1, 1], [1, 1, 1]]", ["at least 1e-06"]),
        ("[[creature]]\ncount = 2", ["needs rig"]),
        (CREATURE + "count = 0", ["count = 0", "1 to"]),
        (CREATURE + "speed = -1", ["speed = -1"]),
        (CREATURE + 'forward = "z"', ["+z"]),
        (CREATURE + "path = [[0, 0]]", ["2 to"]),
        (CREATURE + "leg = 'a:b'", ["list of texts"]),
        (CREATURE + "position = [1e9, 0]", ["position"]),
        ("[[push]]\ntime = 1\nvelocity = [0, 0, 0]\ncreature = 1", ["creature = 1", "0 to 0"]),
        ("[[push]]\nvelocity = [0, 0, 0]", ["needs time"]),
        ("[[push]]\ntime = 1\nvelocity = [0, 0]", ["velocity = [0, 0]", "x, y, z"]),
        ("[[push]]\ntime = 1\nvelocity = [0, 0, 0]\nat = 'head'", ["at = 'head'"]),
    ],
)
def test_one_sentence_names_file_place_and_choices(
    tmp_path: Path, text: str | bytes, words: list[str]
) -> None:
    np.save(tmp_path / "a.npy", np.zeros((2, 2)))
    np.save(tmp_path / "nan.npy", np.array([[0.0, np.nan]]))
    np.save(tmp_path / "empty.npy", np.zeros((0, 3)))
    np.save(tmp_path / "text.npy", np.array([["a"]]))
    (tmp_path / "a.raw").write_bytes(bytes(24))
    (tmp_path / "bad.png").write_bytes(b"\x89PNG\r\n\x1a\n broken")
    Image.fromarray(np.zeros((2, 2, 3), np.uint8)).save(tmp_path / "rgb.png")
    with pytest.raises(SceneError) as caught:
        scene_of(tmp_path, text)
    sentence = str(caught.value)
    assert str(tmp_path / "scene.toml") in sentence
    for word in words:
        assert word in sentence
    assert "\n" not in sentence


def test_a_missing_file_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"none\.toml: the scene cannot be read"):
        read_scene(tmp_path / "none.toml")
    with pytest.raises(SceneError, match="cannot be read"):
        read_scene(tmp_path)


@pytest.mark.parametrize("size", [0, 7, 60, 100])
def test_a_cut_heightmap_is_an_error(tmp_path: Path, size: int) -> None:
    np.save(tmp_path / "whole.npy", np.zeros((8, 8)))
    (tmp_path / "cut.npy").write_bytes((tmp_path / "whole.npy").read_bytes()[:size])
    with pytest.raises(SceneError, match=r"cut\.npy"):
        scene_of(tmp_path, '[terrain]\nheightmap = "cut.npy"\ncell = 1')


def read_or_refuse(folder: Path, text: str | bytes) -> None:
    refused = ""
    try:
        scene_of(folder, text)
    except SceneError as error:
        refused = str(error)
    assert not refused or "scene.toml" in refused


def toml_value() -> st.SearchStrategy[str]:
    numbers = st.one_of(
        st.integers(-3, 3).map(str),
        st.floats(-10, 10).map(repr),
        st.sampled_from(["nan", "inf", "1e300", "99999999999999999999", "true", "1979-05-27"]),
    )
    texts = st.sampled_from(
        [
            '"box"',
            '"hills"',
            '"sphere"',
            '"hull"',
            '"mesh"',
            '""',
            '"a.npy"',
            '"a.raw"',
            '"a.tif"',
            '"a.obj"',
            '"uint8"',
            '"\\u0000"',
            '"+z"',
            "{}",
        ]
    )
    simple = st.one_of(numbers, texts)
    lists = st.lists(simple, max_size=4).map(lambda v: "[" + ", ".join(v) + "]")
    nested = st.lists(lists, max_size=4).map(lambda v: "[" + ", ".join(v) + "]")
    return st.one_of(simple, lists, nested)


KEYS = [
    "heightmap",
    "cell",
    "relief",
    "origin",
    "generator",
    "water",
    "mesh",
    "scale",
    "format",
    "rows",
    "columns",
    "seed",
    "rise",
    "shape",
    "size",
    "points",
    "position",
    "yaw",
    "rotation",
    "forbidden",
    "velocity",
    "count",
    "area",
    "forbidden_share",
    "rig",
    "leg",
    "speed",
    "path",
    "time",
    "creature",
    "name",
    "height",
]


@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    tables=st.lists(
        st.tuples(
            st.sampled_from(
                ["[terrain]", "[[obstacle]]", "[[scatter]]", "[[creature]]", "[[push]]", "[push]"]
            ),
            st.dictionaries(st.sampled_from(KEYS), toml_value(), max_size=5),
        ),
        max_size=3,
    )
)
def test_no_scene_raises_anything_else(
    tmp_path: Path, tables: list[tuple[str, dict[str, str]]]
) -> None:
    text = "\n".join(
        head + "\n" + "\n".join(f"{key} = {value}" for key, value in keys.items())
        for head, keys in tables
    )
    read_or_refuse(tmp_path, text)


@settings(
    max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(place=st.integers(0, len(FULL)), junk=st.text(max_size=4), cut=st.integers(0, 40))
def test_no_damaged_scene_raises_anything_else(
    tmp_path: Path, place: int, junk: str, cut: int
) -> None:
    np.save(tmp_path / "ground.npy", np.zeros((3, 4)))
    text = FULL[:place] + junk + FULL[place + cut :]
    read_or_refuse(tmp_path, text.encode("utf-8", "surrogatepass"))
