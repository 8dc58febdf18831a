"""Ground in tiles: the same ground as in one piece, within its memory, however far away."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polypod.environment import Environment, Terrain, TiledTerrain, scatter
from polypod.environment.heightmaps import MOST_SAMPLES
from polypod.environment.maps import fill_maps, make_local_map
from polypod.environment.scene import read_scene
from polypod.environment.table import ground_height, ground_normal, is_wet, surface
from polypod.errors import SceneError
from polypod.morphology.load import load_rig
from polypod.recording import record_walk
from polypod.reference import by_reference
from polypod.report.figures import measure
from polypod.report.strip import draw_strip
from polypod.world import World

WALK_SECONDS, FPS = 2.0, 30.0


def rough(rows: int, columns: int, seed: int = 0) -> Terrain:
    random = np.random.default_rng(seed)
    heights = random.normal(size=(rows, columns))
    return Terrain(heights, 0.3, (-4.0, 2.0), random.random(heights.shape) > 0.7)


def in_tiles(whole: Terrain, tile: int = 16, memory: float = 4.0) -> TiledTerrain:
    water = whole.water
    return TiledTerrain(
        lambda row, column: whole.heights[row, column],
        whole.cell,
        whole.origin,
        whole.edge,
        None if water is None else lambda row, column: water[row, column],
        tile,
        memory,
    )


def loaded(terrain: TiledTerrain, reach: float = 100.0) -> Environment:
    place = Environment(terrain)
    place.load_ground(np.array([[0.0, 0.0]]), np.array([reach]))
    return place


def waved(x: Any, z: Any) -> Any:
    return 0.2 * np.sin(1.7 * x) * np.cos(0.9 * z + 0.3)


def digest(recording: Any) -> str:
    arrays = (value for value in vars(recording).values() if isinstance(value, np.ndarray))
    return hashlib.sha256(b"".join(a.tobytes() for a in arrays)).hexdigest()


# Rows and columns of which tiles end before, at and after the terrain's edge.
SHAPES = st.tuples(st.integers(2, 50), st.integers(2, 50)) | st.sampled_from([(17, 33), (16, 32)])


@settings(max_examples=30, deadline=None)
@given(shape=SHAPES, tile=st.sampled_from([16, 32]), seed=st.integers(0, 99))
def test_a_tiled_copy_is_the_same_ground(shape: tuple[int, int], tile: int, seed: int) -> None:
    terrain = rough(*shape, seed)
    one, tiles = Environment(terrain), loaded(in_tiles(terrain, tile))
    random = np.random.default_rng(seed)
    places = random.uniform((-8.0, -2.0), (16.0, 20.0), (60, 2))
    # And right on the samples and the seams between tiles.
    lattice = np.array(terrain.origin) + terrain.cell * random.integers(-1, 50, (30, 2))
    for x, z in np.concatenate([places, lattice]):
        for ask in (ground_height, ground_normal, is_wet, surface):
            assert ask(one.kernel_table, x, z) == ask(tiles.kernel_table, x, z)
    assert np.array_equal(one.terrain.heights_at(places), tiles.terrain.heights_at(places))
    maps = [make_local_map(24), make_local_map(24)]
    x, z = places[0]
    for place, window in zip((one, tiles), maps, strict=True):
        fill_maps(place.kernel_table, by_reference(window), x, z, 0.21, 24, 0.1, 0.2, 0.4, 0.0)
    for whole, tiled in zip(*maps, strict=True):
        assert np.array_equal(whole, tiled)
    assert not tiles.table.missed[0]


@pytest.fixture(scope="module")
def hills() -> Terrain:
    return Terrain.hills(seed=3, relief=0.4, wavelength=2.0, size=20.0)


def walk(place: Environment, threads: int = 1) -> list[Any]:
    world = World(place, threads=threads)
    herd = world.add(load_rig("spider"), 4, speed=0.5)
    herd.command.heading = np.linspace(-0.8, 0.8, 4)
    herd.command.set_path([[1.0, 3.0]], creature=1)
    return record_walk(world, WALK_SECONDS, FPS)


def test_a_walk_over_tiles_is_the_same_walk(hills: Terrain) -> None:
    area, size = (-2.0, -1.0, 2.0, 3.0), ((0.08, 0.04, 0.08), (0.3, 0.08, 0.3))
    crates = scatter(hills, 30, area, size, 1)
    assert scatter(in_tiles(hills), 30, area, size, 1) == crates
    one = Environment(hills, crates)
    expected = walk(one)
    for tile, threads in ((16, 1), (32, 2), (16, 3)):
        tiles = Environment(in_tiles(hills, tile), crates)
        recordings = walk(tiles, threads)
        assert [digest(r) for r in recordings] == [digest(r) for r in expected]
    # Audits and pictures look at all of the way, wherever the tiles now are.
    tiles.load_ground(np.array([[8.0, 8.0]]), np.array([0.5]))
    assert measure(expected[1], one.table) == measure(recordings[1], tiles.table)
    drawn = [draw_strip(expected[:1], place.table, 2, 300, 1) for place in (one, tiles)]
    assert np.array_equal(*drawn)


def test_creatures_far_apart_do_not_matter_to_each_other() -> None:
    places = ([0.0, 0.0], [10_000.0, -7_000.0])

    def records(*positions: list[float]) -> list[str]:
        terrain = Terrain.endless_hills(seed=2, relief=0.3, wavelength=2.0)
        world = World(terrain, threads=2)
        for position in positions:
            world.add(load_rig("spider"), position=position, speed=0.5)
        found = [digest(recording) for recording in record_walk(world, 1.0, FPS)]
        assert world.environment.pager is not None
        assert world.environment.pager.held < terrain.page_count
        return found

    together = records(*places)
    assert together == records(places[0]) + records(places[1])
    assert together == records(*places[::-1])[::-1]


def test_memory_is_bounded_and_a_tile_is_made_once_while_it_is_there() -> None:
    asked: list[tuple[float, float]] = []

    def height_of(x: Any, z: Any) -> Any:
        asked.append((float(x[0]), float(z[0])))
        return waved(x, z)

    terrain = Terrain.tiled(height_of, 0.1, 16, memory=1.0)
    place = Environment(terrain)
    asked.clear()
    pager = place.pager
    assert pager is not None
    room = terrain.page_count
    assert place.table.heights.nbytes <= 2**20
    for step in range(400):
        x = 0.5 * step
        place.load_ground(np.array([[x, 3.0], [-x, 3.0]]), np.array([2.0, 2.0]))
        assert pager.held < room
        assert ground_height(place.kernel_table, x - 1.9, 4.9) == pytest.approx(
            terrain.height_at(x - 1.9, 4.9), abs=1e-12
        )
        del asked[pager.made :]  # what the test itself asked
    assert pager.made > 2 * room
    assert len(set(asked)) == len(asked) == pager.made
    assert not place.table.missed[0]
    # Who goes back finds the latest tiles there.
    place.load_ground(np.array([[x - 2.0, 3.0]]), np.array([2.0]))
    assert pager.made == len(asked)


def test_ground_that_is_not_there_is_level_and_noted() -> None:
    place = loaded(Terrain.tiled(lambda x, z: 5.0 + waved(x, z), 0.1, 16), 1.0)
    assert ground_height(place.kernel_table, 0.5, 0.5) > 4.0
    assert not place.table.missed[0]
    assert ground_height(place.kernel_table, 500.0, 0.5) == 0.0
    assert place.table.missed[0]
    place.load_ground(np.array([[500.0, 0.5]]), np.array([1.0]))
    assert ground_height(place.kernel_table, 500.0, 0.5) > 4.0
    assert not place.table.missed[0]


def test_more_than_fits_is_refused() -> None:
    place = Environment(Terrain.tiled(waved, 0.1, 16, memory=1.0))
    with pytest.raises(SceneError, match=r"need \d+ tiles .* 1 MiB has room for \d+; give it at l"):
        place.load_ground(np.array([[0.0, 0.0]]), np.array([50.0]))


def test_endless_hills_go_on_from_the_hills() -> None:
    whole = Terrain.hills(seed=4, relief=0.7, wavelength=2.0, size=32.0)
    endless = Terrain.endless_hills(seed=4, relief=0.7, wavelength=2.0)
    x, z = np.meshgrid(whole.origin[0] + whole.cell * np.arange(0, 321, 7), [-9.0, 3.3])
    points = np.stack([x.ravel(), z.ravel()], axis=1)
    # Both are bilinear between samples of their own.
    assert np.allclose(endless.heights_at(points), whole.heights_at(points), atol=0.02)
    far = endless.heights_at(points + 5000.0)
    assert 0.3 < np.ptp(far) < 1.4


@pytest.mark.parametrize(
    ("height_of", "keys", "words"),
    [
        (lambda x, z: 0.0, {}, r"shape \[\] for 3 places"),
        (lambda x, z: np.zeros((2, 2)), {}, r"shape \[2, 2\]"),
        (lambda x, z: x * np.nan, {}, "height nan at x 0, z 0"),
        (lambda x, z: 1e9 + x, {}, "within 100000 m"),
        (lambda x, z: np.array(["a"] * len(x)), {}, "must be numbers"),
        (lambda x, z: x + 1j, {}, "complex128 for heights"),
        ("hills", {}, "must be a function"),
        (waved, {"cell": 0.0}, "cell = 0.0"),
        (waved, {"tile": 100}, "power of two"),
        (waved, {"tile": 8}, "from 16 to 1024"),
        (waved, {"tile": 16.0}, "power of two"),
        (waved, {"memory": 0.0}, "MiB"),
        (waved, {"memory": 1.0, "tile": 1024}, "raise memory or lower tile"),
        (waved, {"origin": (0.0, np.inf)}, "origin"),
        (waved, {"water_of": lambda x, z: True}, "gives water of shape"),
        (waved, {"water_of": 3}, "water_of = 3"),
    ],
)
def test_nonsense_is_refused_by_name(height_of: Any, keys: dict[str, Any], words: str) -> None:
    with pytest.raises(SceneError, match=words):
        Terrain.tiled(height_of, **({"cell": 0.1} | keys))


def test_nonsense_far_away_is_refused_where_it_is() -> None:
    terrain = Terrain.tiled(lambda x, z: np.where(x > 50.0, np.nan, 0.0), 0.5, 16)
    place = loaded(terrain, 10.0)
    with pytest.raises(SceneError, match=r"height nan at x 50.5, z"):
        place.load_ground(np.array([[60.0, 0.0]]), np.array([5.0]))


def write_tiles(folder: Path, heights: Any, side: int, shared: bool) -> None:
    """Write an array as tiles of `side` samples, columns counted from -1."""
    stride = side - 1 if shared else side
    for row in range((heights.shape[0] - shared) // stride):
        for column in range((heights.shape[1] - shared) // stride):
            part = heights[row * stride :, column * stride :][:side, :side]
            np.save(folder / f"t{column - 1}_{row:02}.npy", part)


@pytest.mark.parametrize("shared", [True, False])
def test_files_of_tiles_are_one_terrain(tmp_path: Path, shared: bool) -> None:
    rows, columns = (31, 41) if shared else (33, 44)
    heights = np.random.default_rng(1).normal(size=(rows, columns)).astype(np.float32)
    write_tiles(tmp_path, heights, 11, shared)
    (tmp_path / "scene.toml").write_text(
        '[terrain]\ntiles = "t{column}_{row}.npy"\ncell = 0.5\norigin = [3.0, 4.0]\n'
        f"shared = {str(shared).lower()}\nmemory = 8\n"
    )
    tiles = read_scene(tmp_path / "scene.toml").terrain
    # Tile 0, 0 is at the origin, and there is one before it.
    before = 0.5 * (10 if shared else 11)
    whole = Terrain(heights, 0.5, (3.0 - before, 4.0))
    points = np.random.default_rng(2).uniform(-6.0, 30.0, (300, 2))
    assert np.allclose(tiles.heights_at(points), whole.heights_at(points), rtol=0, atol=1e-12)
    one, many = Environment(whole), Environment(tiles)
    many.load_ground(points, np.full(len(points), 1.0))
    for x, z in points:
        assert ground_height(one.kernel_table, x, z) == pytest.approx(
            ground_height(many.kernel_table, x, z), abs=1e-12
        )


def spoiled(folder: Path, how: str) -> None:
    tile = folder / "t0_01.npy"
    if how == "missing":
        tile.unlink()
    elif how == "twice":
        np.save(folder / "t0_1.npy", np.load(tile))
    elif how == "none":
        for file in folder.glob("*.npy"):
            file.unlink()
    else:
        heights = {
            "shape": np.zeros((11, 12)),
            "flat": np.zeros(11),
            "seam": np.load(tile) + 1.0,
            "text": np.full((11, 11), "a"),
            "nan": np.where(np.eye(11), np.nan, np.load(tile)),
        }[how]
        if how == "nan":
            heights[[0, -1]] = np.load(tile)[[0, -1]]
        np.save(tile, heights)


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ("missing", "column 0, row 1 is missing"),
        ("twice", "the same tile as"),
        ("none", "0 such files"),
        ("shape", "11 x 12 samples; all must have 11 x 11"),
        ("flat", r"must have shape \[rows, columns\]"),
        ("seam", "differ from those of t.* along their common side"),
        ("text", "real numbers"),
        ("nan", "height nan at x 0.5, z 5.5"),
    ],
)
def test_a_spoiled_tile_is_named(tmp_path: Path, how: str, words: str) -> None:
    write_tiles(tmp_path, np.random.default_rng(1).normal(size=(31, 41)), 11, True)
    spoiled(tmp_path, how)
    with pytest.raises(SceneError, match=words):
        loaded(Terrain.from_tiles(tmp_path / "t{column}_{row}.npy", 0.5))


@settings(max_examples=25, deadline=None)
@given(data=st.binary(max_size=200), header=st.booleans())
def test_any_bytes_in_a_tile_are_an_error(
    tmp_path_factory: pytest.TempPathFactory, data: bytes, header: bool
) -> None:
    folder = tmp_path_factory.mktemp("tiles")
    np.save(folder / "0_0.npy", np.zeros((3, 3)))
    start = (folder / "0_0.npy").read_bytes()[: 128 if header else 0]
    (folder / "1_0.npy").write_bytes(start + data)
    try:
        loaded(Terrain.from_tiles(folder / "{column}_{row}.npy", 0.5), 5.0)
    except SceneError:
        return
    assert header  # and nine numbers, the first column those of its neighbour


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('tiles = "a.npy"\ncell = 1', "with {column} and {row}"),
        ('tiles = "{column}_{row}.png"\ncell = 1', ".npy"),
        ('tiles = "none/{column}_{row}.npy"\ncell = 1', "no tiles can be read"),
        ('tiles = "{column}_{row}.npy"', "needs cell"),
        ('tiles = "{column}_{row}.npy"\ncell = 1\nmemory = 0', "memory = 0"),
        ('tiles = "{column}_{row}.npy"\ncell = 1\nshared = 1', "true or false"),
        ('tiles = "{column}_{row}.npy"\ncell = 1\nrelief = 1', "no key 'relief'"),
        ('tiles = "{column}_{row}.npy"\ngenerator = "hills"', "only one"),
        ('generator = "endless-hills"\nsize = 3.0', "no key 'size'"),
        ('heightmap = "a.png"\ncell = 1\nrelief = 1\nmemory = 1', "no key 'memory'"),
    ],
)
def test_scenes_with_impossible_tiles_are_refused(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "scene.toml").write_text("[terrain]\n" + text)
    with pytest.raises(SceneError) as error:
        read_scene(tmp_path / "scene.toml")
    assert words in str(error.value)


def test_water_comes_in_tiles_too(tmp_path: Path) -> None:
    heights = np.zeros((21, 21))
    wet = np.arange(21)[None, :] + np.zeros((21, 1)) > 10
    write_tiles(tmp_path, heights, 11, True)
    masks = tmp_path / "water"
    masks.mkdir()
    write_tiles(masks, wet.astype(np.uint8), 11, True)
    name = "t{column}_{row}.npy"
    terrain = Terrain.from_tiles(tmp_path / name, 0.5, (5.0, 0.0), water=masks / name)
    place = loaded(terrain)
    assert [bool(is_wet(place.kernel_table, 0.5 * i, 3.3)) for i in range(21)] == list(wet[0])
    (masks / "t0_01.npy").unlink()
    (masks / "t0_00.npy").unlink()
    with pytest.raises(SceneError, match="as many and as large as"):
        Terrain.from_tiles(tmp_path / name, 0.5, water=masks / name)


def test_a_heightmap_too_large_to_be_held_is_read_where_it_is_needed(tmp_path: Path) -> None:
    path = tmp_path / "huge.npy"
    side = int(MOST_SAMPLES**0.5) + 1
    # A file of holes: it takes no room.
    huge = np.lib.format.open_memmap(path, "w+", np.float32, (side, side))
    huge[side - 40 :, side - 40 :] = 3.0
    huge.flush()
    (tmp_path / "scene.toml").write_text('[terrain]\nheightmap = "huge.npy"\ncell = 0.25\n')
    terrain = read_scene(tmp_path / "scene.toml").terrain
    assert isinstance(terrain, TiledTerrain)
    place = loaded(terrain, 3.0)
    end = 0.25 * (side - 1)
    assert ground_height(place.kernel_table, 1.0, 1.0) == 0.0
    place.load_ground(np.array([[end, end]]), np.array([3.0]))
    assert ground_height(place.kernel_table, end - 1.0, end + 2.0) == 3.0
    assert place.pager is not None
    assert place.pager.made < 10
    with pytest.raises(SceneError, match=r"must be a \.npy"):
        Terrain.from_npy(path, 0.25, water=tmp_path / "mask.png")
    np.save(tmp_path / "mask.npy", np.zeros((3, 3)))
    with pytest.raises(SceneError, match="as many samples"):
        Terrain.from_npy(path, 0.25, water=tmp_path / "mask.npy")
