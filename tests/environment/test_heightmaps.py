"""Files of bare samples and GeoTIFFs: the numbers come back, and what cannot be used is refused."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray
from PIL import Image

from environment.test_scene import scene_of
from polypod.environment import Terrain
from polypod.environment.heightmaps import FORMATS
from polypod.errors import SceneError

IN_FOLDER = [HealthCheck.function_scoped_fixture]


@settings(max_examples=60, deadline=None, suppress_health_check=IN_FOLDER)
@given(
    format=st.sampled_from(sorted(FORMATS)),
    shape=st.tuples(st.integers(1, 7), st.integers(1, 7)),
    said=st.sampled_from(["rows", "columns", "both"]),
    data=st.data(),
)
def test_bare_samples_come_back(
    tmp_path: Path, format: str, shape: tuple[int, int], said: str, data: st.DataObject
) -> None:
    kind = np.dtype(FORMATS[format])
    numbers = st.floats(-1000, 1000, width=32) if kind.kind == "f" else None
    values = data.draw(arrays.arrays(kind, shape, elements=numbers))
    (tmp_path / "a.raw").write_bytes(values.tobytes())
    sides = {"rows": shape[0], "columns": shape[1]}
    keys = sides if said == "both" else {said: sides[said]}
    terrain = Terrain.from_raw(tmp_path / "a.raw", format, 0.5, relief=4.0, **keys)
    white = 1.0 if kind.kind == "f" else 2.0 ** (8 * kind.itemsize) - 1.0
    assert np.allclose(terrain.heights, values.astype(np.float64) * (4.0 / white), rtol=1e-12)


def test_bare_floats_are_metres_and_square(tmp_path: Path) -> None:
    values = np.arange(9, dtype="<f4").reshape(3, 3)
    values.tofile(tmp_path / "ground.raw")
    scene = scene_of(
        tmp_path,
        '[terrain]\nheightmap = "ground.raw"\nformat = "float32"\ncell = 0.5\norigin = [1, 2]',
    )
    assert np.array_equal(scene.terrain.heights, values)
    assert scene.terrain.height_at(1.5, 2.5) == 4.0


def test_bare_samples_are_scaled_as_those_of_a_picture(tmp_path: Path) -> None:
    values = np.array([[0, 65535, 4], [40000, 257, 1]], dtype=np.uint16)
    Image.fromarray(values).save(tmp_path / "a.png")
    values.astype(">u2").tofile(tmp_path / "a.raw")
    scene = scene_of(
        tmp_path,
        '[terrain]\nheightmap = "a.raw"\nformat = "uint16-big"\ncell = 1\nrelief = 3\ncolumns = 3',
    )
    picture = Terrain.from_png(tmp_path / "a.png", 1.0, 3.0)
    assert np.allclose(scene.terrain.heights, picture.heights, rtol=1e-15)


@pytest.mark.parametrize(
    ("content", "keys", "words"),
    [
        (b"", {}, "no whole number"),
        (bytes(7), {"format": "float32"}, "no whole number"),
        (bytes(12), {}, "6 samples of uint16, no square"),
        (bytes(12), {"rows": 4}, "6 samples of uint16, not 4 rows of 1"),
        (bytes(12), {"rows": 7}, "not 7 rows of 1"),
        (bytes(12), {"columns": 5}, "not 1 rows of 5"),
        (bytes(12), {"rows": 0}, "rows = 0 must be"),
        (bytes(12), {"columns": -2}, "columns = -2 must be"),
        (bytes(12), {"rows": 2, "columns": 2}, "not 2 rows of 2"),
        (bytes(8), {"format": "uint12"}, "'uint12' must be one of uint8, uint16, uint16-big"),
        (bytes(8), {"relief": None}, "needs relief: the metres from 0 to 65535"),
        (bytes(8), {"relief": math.nan}, "relief = nan"),
        (b"\xff\xff\xff\xff", {"format": "float32"}, "no number"),
        (b"\xff\xff\x7f\x7f", {"format": "float32", "relief": 1e4}, "no number"),
    ],
)
def test_other_bare_samples_are_refused(
    tmp_path: Path, content: bytes, keys: dict[str, Any], words: str
) -> None:
    (tmp_path / "a.raw").write_bytes(content)
    usual: dict[str, Any] = {"format": "uint16", "cell": 1.0, "relief": 1.0}
    with pytest.raises(SceneError, match=rf"a\.raw: .*{words}"):
        Terrain.from_raw(tmp_path / "a.raw", **(usual | keys))


def test_too_many_bare_samples_are_refused_unread(tmp_path: Path) -> None:
    with (tmp_path / "a.raw").open("wb") as file:
        file.truncate(10**11)  # a hole: it takes no space
    with pytest.raises(SceneError, match="too many"):
        Terrain.from_raw(tmp_path / "a.raw", "uint8", 1.0, 1.0)
    with pytest.raises(SceneError, match=r"none\.raw: no raw heightmap can be read"):
        Terrain.from_raw(tmp_path / "none.raw", "uint8", 1.0, 1.0)


PLAN = {1024: 1, 1025: 1, 3072: 32632, 3076: 9001}


def write_geotiff(
    path: Path,
    values: NDArray[Any],
    keys: dict[int, int] | None = None,
    scale: tuple[float, ...] | None = (10.0, 10.0, 0.0),
    no_data: str | None = None,
    more: list[tuple[Any, ...]] | None = None,
    **options: Any,
) -> Path:
    """Write a GeoTIFF with given geo keys, of a projected plan in metres where omitted."""
    tifffile = pytest.importorskip("tifffile")
    listed = (PLAN if keys is None else keys).items()
    directory = [1, 1, 0, len(listed), *(n for key, v in listed for n in (key, 0, 1, v))]
    tags: list[tuple[Any, ...]] = [(34735, "H", len(directory), directory, True)]
    tags.append((33922, "d", 6, (0.0, 0.0, 0.0, 5e5, 5e6, 0.0), True))
    if scale is not None:
        tags.append((33550, "d", len(scale), scale, True))
    if no_data is not None:
        tags.append((42113, "s", 0, no_data, True))
    tifffile.imwrite(path, values, extratags=tags + (more or []), metadata=None, **options)
    return path


@pytest.mark.parametrize("kind", ["u1", "<i2", ">i2", "<u2", "<f4", "<f8"])
@pytest.mark.parametrize("options", [{}, {"compression": "zlib"}, {"tile": (16, 16)}])
def test_a_geotiff_says_heights_and_scale(
    tmp_path: Path, kind: str, options: dict[str, Any]
) -> None:
    values = np.arange(40 * 30).reshape(40, 30).astype(kind)
    path = write_geotiff(tmp_path / "a.tif", values, **options)
    terrain = Terrain.from_geotiff(path, origin=(3.0, 4.0))
    assert terrain.cell == 10.0
    assert terrain.origin == (3.0, 4.0)
    assert terrain.water is None
    assert np.array_equal(terrain.heights, values)


def test_feet_become_metres(tmp_path: Path) -> None:
    keys = {1024: 1, 3072: 2263, 3076: 9003, 4099: 9002}
    path = write_geotiff(tmp_path / "a.tiff", np.full((3, 3), 100.0), keys, (30.0, 30.0, 0.0))
    terrain = scene_of(tmp_path, f'[terrain]\nheightmap = "{path.name}"').terrain
    assert terrain.cell == pytest.approx(30.0 * 1200.0 / 3937.0, rel=1e-15)
    assert terrain.heights[1, 1] == pytest.approx(30.48, rel=1e-15)


@pytest.mark.parametrize(
    ("kind", "held", "said"),
    [
        ("<f4", -9999.0, "-9999"),
        ("<f4", np.nan, "nan"),
        ("<f4", -np.inf, "-inf"),
        ("<f4", np.finfo(np.float32).min, "-3.40282e+38"),
        ("<f4", 0.1, "0.1"),
        ("<i2", -32768, "-32768.0"),
        ("u1", 0, "0"),
    ],
)
def test_no_data_is_low_and_no_foot_stands_there(
    tmp_path: Path, kind: str, held: float, said: str
) -> None:
    values = np.array([[7, held, 5], [held, 6, 9]]).astype(kind)
    water = np.array([[0, 0, 255], [0, 0, 0]], dtype=np.uint8)
    Image.fromarray(water).save(tmp_path / "water.png")
    path = write_geotiff(tmp_path / "a.tif", values, no_data=said)
    terrain = Terrain.from_geotiff(path)
    assert np.array_equal(terrain.heights, [[7, 5, 5], [5, 6, 9]])
    assert terrain.water is not None
    assert np.array_equal(terrain.water, [[False, True, False], [True, False, False]])
    both = Terrain.from_geotiff(path, water=tmp_path / "water.png").water
    assert both is not None
    assert np.array_equal(both, [[False, True, True], [True, False, False]])


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"keys": {1024: 2, 2048: 4326}, "scale": (1e-4, 1e-4, 0.0)}, "degrees.*project it"),
        ({"keys": {2048: 4326}}, "degrees"),
        ({"keys": {1024: 3}}, "degrees"),
        ({"keys": PLAN | {3076: 9036}}, "unit of plan is EPSG 9036"),
        ({"keys": PLAN | {4099: 9999}}, "unit of elevation is EPSG 9999"),
        ({"scale": None}, "does not say how large its pixels are"),
        ({"scale": None, "more": [(34264, "d", 16, [1.0] * 16, True)]}, "by a matrix"),
        ({"scale": (10.0, 12.0, 0.0)}, "10 by 12; they must be squares"),
        ({"scale": (math.nan, 1.0, 0.0)}, "nan m wide"),
        ({"scale": (0.0, 0.0, 0.0)}, "0 m wide"),
        ({"scale": (1.0,)}, "no GeoTIFF can be read"),
        ({"no_data": "none"}, "'none' is no number"),
        ({"no_data": "0"}, "every sample is marked as no data"),
        ({"values": np.zeros((4, 4, 3), np.uint8), "photometric": "rgb"}, "3 bands"),
        ({"values": np.zeros((4, 4), np.complex64)}, "real numbers"),
        ({"values": np.array([[0.0, np.nan]])}, "no number"),
        ({"values": np.full((2, 2), 1e30)}, "no number"),
        (
            {"more": [(42112, "s", 0, '<Item name="SCALE" role="scale">0.1</Item>', True)]},
            "packed.*-unscale",
        ),
    ],
)
def test_other_geotiffs_are_refused(tmp_path: Path, keys: dict[str, Any], words: str) -> None:
    path = write_geotiff(tmp_path / "a.tif", keys.pop("values", np.zeros((4, 4))), **keys)
    with pytest.raises(SceneError, match=rf"a\.tif: .*{words}") as caught:
        Terrain.from_geotiff(path)
    assert "\n" not in str(caught.value)


def test_a_missing_library_is_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "tifffile", None)
    with pytest.raises(SceneError, match=r"a\.tif: .* pip install tifffile$"):
        Terrain.from_geotiff(tmp_path / "a.tif")


@settings(max_examples=150, deadline=None, suppress_health_check=IN_FOLDER)
@given(place=st.integers(0, 1), junk=st.binary(max_size=6), cut=st.integers(0, 400), at=st.data())
def test_no_damaged_geotiff_raises_anything_else(
    tmp_path: Path, place: int, junk: bytes, cut: int, at: st.DataObject
) -> None:
    options = {"compression": "zlib"} if place else {}
    values = np.arange(64, dtype=np.int16).reshape(8, 8)
    whole = write_geotiff(tmp_path / "whole.tif", values, **options).read_bytes()
    start = at.draw(st.integers(0, len(whole)))
    end = start + (len(junk) if cut > 200 else cut)
    path = tmp_path / "cut.tif"
    path.write_bytes(whole[:start] + junk + whole[end:])
    refused = f"{path}: "
    try:
        assert Terrain.from_geotiff(path).heights.size > 0
    except SceneError as error:
        refused = str(error)
    assert refused.startswith(f"{path}: ")
    assert "\n" not in refused


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.99])
def test_a_cut_geotiff_is_refused(tmp_path: Path, share: float) -> None:
    path = write_geotiff(tmp_path / "a.tif", np.ones((50, 50)))
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(SceneError, match=r"a\.tif: no GeoTIFF can be read"):
        Terrain.from_geotiff(path)
