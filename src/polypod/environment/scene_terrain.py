"""The [terrain] of a scene file: a generator, a file of heights, or a mesh."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from polypod.environment.generators import GENERATORS, generator_keys
from polypod.environment.heightmaps import FORMATS, MOST_SAMPLES
from polypod.environment.obstacles import LARGEST, SMALLEST
from polypod.environment.scene_values import SceneTable, shown, within
from polypod.environment.terrain import Terrain, generated
from polypod.environment.tiled import LEAST_MEMORY, MEMORY, MOST_MEMORY, TiledTerrain
from polypod.environment.triangles import MESHES
from polypod.errors import SceneError, choices

LARGEST_SEED = 2**62
KINDS = ("generator", "heightmap", "tiles", "mesh")
# Keys of each kind of heightmap, besides heightmap, origin and water.
HEIGHTMAPS = {
    ".npy": ("cell", "memory"),
    ".png": ("cell", "relief"),
    ".raw": ("cell", "relief", "format", "rows", "columns"),
    ".tif": (),
    ".tiff": (),
}


def read_terrain(path: Path, values: Any, more_seed: int) -> Terrain | TiledTerrain:
    """Return the terrain of a scene.

    Args:
        path: the scene file; files that it names are found from its own folder.
        values: what it holds under [terrain].
        more_seed: added to a generator's seed.

    Raises:
        SceneError: a key or a file that cannot be used; the place comes first.
    """
    place = f"{path}: [terrain]"
    if not isinstance(values, dict):
        raise SceneError(f"{place} must be a table of keys, not {shown(values)}")
    kinds = [kind for kind in KINDS if kind in values]
    if not kinds:
        raise SceneError(
            f"{place} needs a heightmap (a file), tiles (files), a mesh (a file) or a generator"
        )
    if len(kinds) > 1:
        raise SceneError(f"{place} has {choices(kinds)}; it must have only one of them")
    if kinds == ["generator"]:
        return read_generated(place, values, more_seed)
    read = {"heightmap": _heightmap, "tiles": _tiles, "mesh": _mesh}[kinds[0]]
    return read(place, values, path.parent)


def read_generated(place: str, values: dict[str, Any], more_seed: int) -> Terrain | TiledTerrain:
    """Return the terrain of a generator with its keys; `more_seed` is added to its seed.

    Raises:
        SceneError: no such generator, or a key or value that it does not take.
    """
    generator = values["generator"]
    if generator not in tuple(GENERATORS):
        raise SceneError(
            f"{place} has generator = {shown(generator)}; it is one of {choices(GENERATORS)}"
        )
    table = SceneTable(place, values, ("generator", *generator_keys(generator)))
    keys = {key: value for key, value in table.values.items() if key != "generator"}
    if "seed" in generator_keys(generator):
        keys["seed"] = table.whole("seed", 0, 0, LARGEST_SEED) + more_seed
    return within(place, lambda: generated(generator, **keys))


def _heightmap(place: str, values: dict[str, Any], folder: Path) -> Terrain | TiledTerrain:
    file = folder / SceneTable(place, values, values).text("heightmap")
    suffix = file.suffix.lower()
    if suffix not in HEIGHTMAPS:
        raise SceneError(
            f"{place} has heightmap = {shown(file.name)}; it must be one of {choices(HEIGHTMAPS)}; "
            f"files of {choices(MESHES)} are named by mesh"
        )
    keys = ("heightmap", *HEIGHTMAPS[suffix], "origin", "water")
    table = SceneTable(f"{place} of a {suffix}", values, keys)
    origin = table.numbers("origin", "x z", (0.0, 0.0), -LARGEST, LARGEST)
    water = folder / table.text("water") if "water" in table else None
    if not HEIGHTMAPS[suffix]:
        return within(place, lambda: Terrain.from_geotiff(file, origin, water))
    cell = table.number("cell", None, SMALLEST, LARGEST)
    if suffix == ".npy":
        memory = _memory(table) if "memory" in table else None
        return within(place, lambda: Terrain.from_npy(file, cell, origin, water, memory))
    if suffix == ".png":
        relief = table.number("relief", None, 0.0, LARGEST)
        return within(place, lambda: Terrain.from_png(file, cell, relief, origin, water))
    return within(place, _raw(table, file, cell, origin, water))


def _memory(table: SceneTable) -> float:
    return table.number("memory", MEMORY, LEAST_MEMORY, MOST_MEMORY)


def _tiles(place: str, values: dict[str, Any], folder: Path) -> TiledTerrain:
    keys = ("tiles", "cell", "origin", "shared", "water", "memory")
    table = SceneTable(f"{place} of tiles", values, keys)
    pattern = folder / table.text("tiles")
    cell = table.number("cell", None, SMALLEST, LARGEST)
    origin = table.numbers("origin", "x z", (0.0, 0.0), -LARGEST, LARGEST)
    shared, memory = table.flag("shared", True), _memory(table)
    water = folder / table.text("water") if "water" in table else None
    return within(place, lambda: Terrain.from_tiles(pattern, cell, origin, shared, water, memory))


def _raw(
    table: SceneTable, file: Path, cell: float, origin: tuple[float, ...], water: Path | None
) -> Callable[[], Terrain]:
    form = table.text("format") if "format" in table else ""
    if form not in FORMATS:
        table.fail("format", f"one of {choices(FORMATS)}")
    needed = "relief" in table or form.startswith("uint")
    relief = table.number("relief", None, 0.0, LARGEST) if needed else None
    rows, columns = (
        table.whole(key, None, 1, MOST_SAMPLES) if key in table else None
        for key in ("rows", "columns")
    )
    return lambda: Terrain.from_raw(file, form, cell, relief, rows, columns, origin, water)


def _mesh(place: str, values: dict[str, Any], folder: Path) -> Terrain | TiledTerrain:
    table = SceneTable(f"{place} of a mesh", values, ("mesh", "cell", "scale", "origin", "water"))
    file = folder / table.text("mesh")
    if file.suffix.lower() not in MESHES:
        table.fail("mesh", f"one of {choices(MESHES)}")
    cell = table.number("cell", None, SMALLEST, LARGEST) if "cell" in table else None
    scale = table.number("scale", 1.0, SMALLEST, LARGEST)
    origin = table.numbers("origin", "x z", None, -LARGEST, LARGEST) if "origin" in table else None
    water = folder / table.text("water") if "water" in table else None
    return within(place, lambda: Terrain.from_mesh(file, cell, scale, origin, water))
