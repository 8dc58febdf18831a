"""The scene file: terrain, obstacles, creatures and pushes in one TOML."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from polypod.environment.convex_parts import COARSEST, FINEST
from polypod.environment.environment import Environment
from polypod.environment.lattice import Lattice
from polypod.environment.obstacles import (
    FASTEST_TURN,
    LARGEST,
    MOST_HULL_POINTS,
    SHAPES,
    SMALLEST,
    Obstacle,
    from_yaw,
    three_numbers,
)
from polypod.environment.scattering import scatter
from polypod.environment.scene_terrain import LARGEST_SEED, read_terrain
from polypod.environment.scene_values import SceneTable, shown, within
from polypod.environment.splitting import MOST_PARTS, Split
from polypod.environment.terrain import Terrain
from polypod.environment.tiled import TiledTerrain
from polypod.errors import RigError, SceneError, choices
from polypod.morphology.creature import judge_limits

MOST_THINGS = 100_000  # obstacles, or creatures
MOST_WAYPOINTS = 10_000
LARGEST_TURN = 1e4  # rad
FASTEST = 1e3  # m/s
LATEST = 1e6  # s
MOTION = ("velocity", "path", "speed", "turn_rate")
SPLIT = ("concavity", "most_parts", "most_corners", "close")
# What gives an obstacle of each shape its extent; all others have a size.
EXTENT = {"hull": ("points",), "mesh": ("file", "size", *SPLIT)}


@dataclass(frozen=True)
class CreatureSpec:
    """Some creatures of one kind, as a scene asks for them; None where it says nothing.

    `leg`, `spine`, `forward`, `height` and `body_height` mean what the command line's options of
    the same names mean, `limit` what it means in a creature file. `position` is x, z in metres,
    `heading` radians from +Z toward +X, `speed` metres per second, `path` waypoints x, z in metres.
    """

    rig: str
    leg: tuple[str, ...] = ()
    spine: tuple[str, ...] = ()
    forward: str | None = None
    height: float | None = None
    body_height: float | None = None
    limit: Mapping[str, Mapping[str, Any]] | None = None
    count: int = 1
    position: tuple[float, float] | None = None
    heading: float | None = None
    gait: str | None = None
    speed: float | None = None
    path: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True)
class PushSpec:
    """A change of a creature's velocity (m/s, world) at a time (s).

    `creature` counts single creatures, in the scene's order; `at` is how far ahead of its body's
    centre it is struck, m.
    """

    creature: int
    time: float
    velocity: tuple[float, float, float]
    at: float = 0.0


@dataclass(frozen=True)
class Scene:
    """What a scene file says. Obstacles are in its order, scattered ones after."""

    path: Path
    terrain: Terrain | TiledTerrain
    obstacles: tuple[Obstacle, ...] = ()
    creatures: tuple[CreatureSpec, ...] = ()
    pushes: tuple[PushSpec, ...] = ()

    def environment(self) -> Environment:
        """Return the place to walk in."""
        return Environment(self.terrain, self.obstacles)


def read_scene(path: str | Path, seed: int = 0) -> Scene:
    """Read a scene file.

    Args:
        path: a TOML file; files that it names are found from its own folder.
        seed: added to each seed of the scene, of its terrain and of what it scatters: the same
            kind of place, another place.

    Returns:
        The scene, every value judged.

    Raises:
        SceneError: the file, or one that it names, cannot be read or used; one sentence with file,
            place and the valid choices.
    """
    path = Path(path)
    try:
        values = tomllib.loads(path.read_bytes().decode("utf-8"))
    except OSError as error:
        raise SceneError(f"{path}: the scene cannot be read ({error.strerror or error})") from None
    except (ValueError, RecursionError) as error:
        raise SceneError(f"{path}: the scene is no valid TOML ({error})") from None
    top = SceneTable(str(path), values, ("terrain", "obstacle", "scatter", "creature", "push"))
    terrain: Terrain | TiledTerrain = Terrain.flat()
    if "terrain" in top:
        terrain = read_terrain(path, top.values["terrain"], seed)
    obstacles = [read_obstacle(path, place, entry) for place, entry in _entries(top, "obstacle")]
    for place, entry in _entries(top, "scatter"):
        obstacles += _scatter(place, entry, terrain, seed)
    creatures = tuple(_creature(place, entry) for place, entry in _entries(top, "creature"))
    number = sum(creature.count for creature in creatures) if creatures else 1
    for what, much in (("obstacles", len(obstacles)), ("creatures", number)):
        if much > MOST_THINGS:
            raise SceneError(f"{path}: {much} {what} are too many; the most is {MOST_THINGS}")
    pushes = tuple(_push(place, entry, number) for place, entry in _entries(top, "push"))
    return Scene(path, terrain, tuple(obstacles), creatures, pushes)


def _entries(top: SceneTable, key: str) -> list[tuple[str, Any]]:
    """Return each [[key]] with its place in words."""
    entries = top.values.get(key, [])
    if not isinstance(entries, list):
        raise SceneError(
            f"{top.place} has [{key}] = {shown(entries)}; write [[{key}]], once for each"
        )
    return [(f"{top.place}: [[{key}]] number {i + 1}", entry) for i, entry in enumerate(entries)]


def read_obstacle(path: Path | None, place: str, values: Any) -> Obstacle:
    """Return an obstacle of a scene.

    Args:
        path: the scene file, beside which a mesh's file is; None where no file may be read.
        place: file and table, the start of each error.
        values: what the scene says of it.

    Raises:
        SceneError: a key or value that cannot be used.
    """
    every = ("name", "shape", "position", "yaw", "rotation", "forbidden", *MOTION)
    table = SceneTable(place, values, (*every, "size", "points", "file", *SPLIT))
    shape = table.text("shape")
    if shape not in SHAPES:
        table.fail("shape", f"one of {choices(SHAPES)}")
    own = EXTENT.get(shape, ("size",))
    # Keys of other shapes are refused with those that this one has.
    table = SceneTable(f"{place}, a {shape},", values, (*every, *own))
    if "yaw" in table and "rotation" in table:
        raise SceneError(f"{place} has both yaw and rotation; leave one out")
    name = table.text("name", " ").strip()
    position = table.numbers("position", "x y z", None, -LARGEST, LARGEST)
    rotation: tuple[float, ...] = from_yaw(table.number("yaw", 0.0, -LARGEST_TURN, LARGEST_TURN))
    if "rotation" in table:
        rotation = table.numbers("rotation", "x y z w", None, -1.01, 1.01)
    forbidden = table.flag("forbidden", False)

    def make() -> Obstacle:
        if shape == "hull":
            points = table.rows("points", "x y z", 4, MOST_HULL_POINTS)
            still = Obstacle.hull(points, position, rotation, forbidden, name)
        elif shape == "mesh":
            if path is None:
                raise SceneError("it is a mesh, and no file is read here")
            still = _mesh(path, table, position, rotation, forbidden, name)
        else:
            size = three_numbers(table.numbers("size", "x y z", None, SMALLEST, LARGEST))
            x, y, z, w = rotation
            centre = three_numbers(position)
            still = Obstacle(shape, size, centre, (x, y, z, w), forbidden, name)
        return replace(still, **_motion(table))

    return within(place, make)


def _mesh(
    path: Path,
    table: SceneTable,
    position: tuple[float, ...],
    rotation: tuple[float, ...],
    forbidden: bool,
    name: str,
) -> Obstacle:
    """Return a mesh obstacle; its file is beside the scene's."""
    usual = Split()
    split = Split(
        concavity=table.number("concavity", usual.concavity, FINEST, COARSEST),
        most_parts=table.whole("most_parts", usual.most_parts, 1, MOST_PARTS),
        most_corners=table.whole("most_corners", usual.most_corners, 4, MOST_HULL_POINTS),
        close=table.flag("close", usual.close),
    )
    size = table.numbers("size", "x y z", None, SMALLEST, LARGEST) if "size" in table else None
    file = path.parent / table.text("file")
    return Obstacle.mesh(file, position, rotation, forbidden, name, size=size, split=split)


def _motion(table: SceneTable) -> dict[str, Any]:
    """Return how an obstacle moves; nothing where it stands."""
    if "path" in table and "velocity" in table:
        raise SceneError("it has both velocity and path; leave one out")
    motion: dict[str, Any] = {}
    if "velocity" in table:
        motion["velocity"] = table.numbers("velocity", "x y z", None, -FASTEST, FASTEST)
    if "path" in table:
        motion["path"] = tuple(table.rows("path", "x y z", 1, MOST_WAYPOINTS))
    if "speed" in table:
        motion["speed"] = table.number("speed", None, 0.0, FASTEST)
    if "turn_rate" in table:
        motion["turn_rate"] = table.number("turn_rate", None, -FASTEST_TURN, FASTEST_TURN)
    return motion


def _scatter(place: str, values: Any, terrain: Lattice, more_seed: int) -> tuple[Obstacle, ...]:
    table = SceneTable(place, values, ("name", "count", "area", "size", "seed", "forbidden_share"))
    count = table.whole("count", None, 0, MOST_THINGS)
    area = table.numbers("area", "x0 z0 x1 z1", None, -LARGEST, LARGEST)
    size = table.rows("size", "x y z", 2, 2)
    seed = table.whole("seed", 0, 0, LARGEST_SEED) + more_seed
    share = table.number("forbidden_share", 0.0, 0.0, 1.0)
    name = table.text("name", "crate")
    return within(place, lambda: scatter(terrain, count, area, size, seed, share, name))


def _creature(place: str, values: Any) -> CreatureSpec:
    table = SceneTable(place, values, CreatureSpec.__dataclass_fields__)
    forwards = ("+x", "-x", "+y", "-y", "+z", "-z")
    if "forward" in table and table.text("forward") not in forwards:
        table.fail("forward", f"one of {choices(forwards)}")

    def size(key: str) -> float | None:
        return table.number(key, None, SMALLEST, LARGEST) if key in table else None

    x, z = table.numbers("position", "x z", (0.0, 0.0), -LARGEST, LARGEST)
    path = table.rows("path", "x z", 2, MOST_WAYPOINTS, ())
    if any(abs(value) > LARGEST for point in path for value in point):
        table.fail("path", f"waypoints within {LARGEST:g} m of the origin")
    return CreatureSpec(
        rig=table.text("rig"),
        leg=table.texts("leg"),
        spine=table.texts("spine"),
        forward=table.text("forward") if "forward" in table else None,
        height=size("height"),
        body_height=size("body_height"),
        limit=_limits(place, values["limit"]) if "limit" in table else None,
        count=table.whole("count", 1, 1, MOST_THINGS),
        position=(x, z) if "position" in table else None,
        heading=(
            table.number("heading", None, -LARGEST_TURN, LARGEST_TURN)
            if "heading" in table
            else None
        ),
        gait=table.text("gait") if "gait" in table else None,
        speed=table.number("speed", None, 0.0, FASTEST) if "speed" in table else None,
        path=tuple((point[0], point[1]) for point in path),
    )


def _limits(place: str, values: Any) -> Mapping[str, Mapping[str, Any]]:
    try:
        judge_limits(place, values)
    except RigError as error:
        raise SceneError(str(error)) from None
    return dict(values)


def _push(place: str, values: Any, creatures: int) -> PushSpec:
    table = SceneTable(place, values, PushSpec.__dataclass_fields__)
    x, y, z = table.numbers("velocity", "x y z", None, -FASTEST, FASTEST)
    return PushSpec(
        creature=table.whole("creature", 0, 0, creatures - 1),
        time=table.number("time", None, 0.0, LATEST),
        velocity=(x, y, z),
        at=table.number("at", 0.0, -LARGEST, LARGEST),
    )
