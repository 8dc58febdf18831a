"""The document: all that is asked for in the studio, as JSON holds it, judged whole.

What a document asks of its creature (how many feet a gait has, which speeds there are) is judged
where the creature is known, in `stage`. Here every key, type and number is.
"""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

from polypod.environment.generators import GENERATORS
from polypod.environment.obstacles import LARGEST, Obstacle
from polypod.environment.scene import MOTION, SPLIT, read_obstacle
from polypod.environment.scene_terrain import read_generated
from polypod.environment.scene_values import SceneTable, shown
from polypod.environment.terrain import Terrain
from polypod.environment.tiled import TiledTerrain
from polypod.errors import SettingError, choices
from polypod.morphology.creature import judge_limits

KEYS = (
    "creature", "crowd", "command", "gait", "spacing", "settings", "path", "terrain", "obstacle",
)  # fmt: skip
CREATURE = ("rig", "leg", "spine", "forward", "height", "body_height", "limit")
# What is asked for, the least and the most that are taken, and whether null stands for a default.
COMMAND = {
    "speed": (0.0, 100.0, True),
    "heading": (-1e4, 1e4, False),
    "travel": (-3.2, 3.2, False),
    "step_height": (0.0, 100.0, True),
    "body_height": (0.0, 1000.0, True),
    "stance_width": (0.3, 3.0, False),
    "period": (1e-3, 1e3, True),
    "duty": (0.01, 0.99, True),
    "blend_cycles": (0.1, 100.0, False),
}
SETTINGS = ("spine", "spine_yaw", "spine_flexion", "gaze", "tail", "bounce", "nod", "sway")
LARGEST_SCALE = 3.0
OPTIONAL = ("obstacle", "terrain")
MOST_OBSTACLES, MOST_WAYPOINTS, MOST_CREATURES, MOST_FEET = 500, 256, 200, 256
MOST_LIMITS = 1000  # joints
WIDEST_SPACING = 10.0  # m
GIVEN = re.compile(r"upload:[0-9a-f]{64}")
# Keys of an obstacle that is a mesh.
MESH = (
    "name", "shape", "position", "yaw", "rotation", "forbidden", *MOTION, "file", "size", *SPLIT,
)  # fmt: skip
Document = dict[str, Any]


def default_document(rig: str = "spider") -> Document:
    """Return what a creature is asked for at first: to walk ahead over flat ground."""
    return {
        "creature": {"rig": rig, **dict.fromkeys(CREATURE[1:])},
        "crowd": [],
        "command": {
            "speed": None,
            "heading": 0.0,
            "travel": 0.0,
            "step_height": None,
            "body_height": None,
            "stance_width": 1.0,
            "period": None,
            "duty": None,
            "blend_cycles": 1.0,
        },
        "gait": None,
        "spacing": [],
        "settings": dict.fromkeys(SETTINGS, 1.0),
        "path": [],
        "terrain": None,
        "obstacle": [],
    }


def edited(document: Document, at: Sequence[str | int], to: Any) -> Document:
    """Return a document with another value at a place; the one given stays as it is.

    Args:
        document: judged.
        at: keys and indices that lead to the place. A list grows by an edit at its length.
        to: the value; None takes an item out of a list.

    Raises:
        SettingError: there is no such place, or the document would not be one.
    """
    if not at:
        raise SettingError("an edit is at a place of the document: a list of keys and indices")
    changed = copy.deepcopy(document)
    inner: Any = changed
    for step in at[:-1]:
        inner = inner[_step_into(inner, step, at)]
    last = at[-1]
    if isinstance(inner, list) and last == len(inner) and to is not None:
        inner.append(to)
    elif isinstance(inner, list) and to is None:
        del inner[_step_into(inner, last, at)]
    elif len(at) > 1 and isinstance(inner, dict) and isinstance(last, str) and at[0] in OPTIONAL:
        # Keys that a scene file may leave out; which there are is judged below.
        inner[last] = to
        if to is None:
            del inner[last]
    else:
        inner[_step_into(inner, last, at)] = to
    return judged(changed)


def _step_into(inner: Any, step: Any, at: Sequence[str | int]) -> Any:
    if isinstance(inner, dict) and isinstance(step, str) and step in inner:
        return step
    whole = isinstance(step, int) and not isinstance(step, bool)
    if isinstance(inner, list) and whole and 0 <= step < len(inner):
        return step
    place = ".".join(str(one)[:40] for one in at[:8])
    if isinstance(inner, dict):
        raise SettingError(f"the document has no place {place}; here it has {choices(inner)}")
    if isinstance(inner, list):
        raise SettingError(f"the document has no place {place}; the list has {len(inner)} items")
    raise SettingError(f"the document has no place {place}; {shown(inner)} has nothing inside")


def judged(values: Any) -> Document:
    """Return a document as it is, if it is one; what its creature leaves out is null.

    Raises:
        SettingError: it is none; the place, what is there and what may be.
    """
    table = SceneTable("the document", values, KEYS)
    for key in KEYS:
        if key not in table:
            table.fail(key, "as docs/studio-protocol.md has it")
    _judge_creature("the document's creature", values["creature"])
    _judge_crowd(_list(table, "crowd", MOST_CREATURES))
    _judge_command(values["command"])
    _judge_gait(values["gait"])
    for i, pair in enumerate(_list(table, "spacing", MOST_FEET)):
        _judge_pair(f"the spacing of foot {i}", pair, WIDEST_SPACING)
    settings = SceneTable("the document's settings", values["settings"], SETTINGS)
    for key in SETTINGS:
        settings.number(key, None, 0.0, LARGEST_SCALE)
    for i, point in enumerate(_list(table, "path", MOST_WAYPOINTS)):
        _judge_pair(f"point {i} of the path", point, LARGEST)
    _judge_place(values["terrain"], _list(table, "obstacle", MOST_OBSTACLES))
    return {**values, "creature": {**dict.fromkeys(CREATURE), **values["creature"]}}


def _list(table: SceneTable, key: str, most: int) -> list[Any]:
    items = table.values[key]
    if not isinstance(items, list) or len(items) > most:
        table.fail(key, f"a list of at most {most}")
    return items


def _judge_creature(place: str, values: Any, others: tuple[str, ...] = ()) -> SceneTable:
    table = SceneTable(place, values, (*CREATURE, *others))
    table.text("rig")
    for key in ("leg", "spine"):
        names = table.values.get(key)
        if names is not None and not (
            isinstance(names, list)
            and len(names) <= MOST_FEET
            and all(isinstance(name, str) for name in names)
        ):
            table.fail(key, "null or a list of texts")
    if table.values.get("forward") not in (None, "+z", "-z", "+x", "-x"):
        table.fail("forward", "null or one of +z, -z, +x and -x")
    for key in ("height", "body_height"):
        if table.values.get(key) is not None:
            table.number(key, None, 1e-6, 1000.0)
    limits = table.values.get("limit")
    if limits is not None:
        if isinstance(limits, dict) and len(limits) > MOST_LIMITS:
            raise SettingError(
                f"{place}: limit has {len(limits)} joints; the most is {MOST_LIMITS}"
            )
        judge_limits(place, limits)
    return table


def _judge_crowd(kinds: list[Any]) -> None:
    total = 1
    for i, kind in enumerate(kinds):
        table = _judge_creature(f"number {i + 1} of the document's crowd", kind, ("count",))
        total += table.whole("count", None, 1, MOST_CREATURES)
    if total > MOST_CREATURES:
        raise SettingError(f"{total} creatures are too many; the most is {MOST_CREATURES}")


def _judge_command(values: Any) -> None:
    table = SceneTable("the document's command", values, COMMAND)
    for key, (least, most, may_miss) in COMMAND.items():
        if not (may_miss and key in table and table.values[key] is None):
            table.number(key, None, least, most)


def _judge_gait(values: Any) -> None:
    if values is None:
        return
    table = SceneTable("the document's gait", values, ("name", "start", "extent"))
    if len(table.text("name")) > 80:
        table.fail("name", "a text of at most 80 characters")
    for key in ("start", "extent"):
        numbers = table.values.get(key)
        if not isinstance(numbers, list) or not 1 <= len(numbers) <= MOST_FEET:
            table.fail(key, "a list of numbers, one for each foot")
        for number in numbers:
            if isinstance(number, bool) or not isinstance(number, int | float):
                table.fail(key, "a list of numbers, one for each foot")
            if not 0.0 <= number <= 1.0:
                table.fail(key, "fractions of the cycle, from 0 to 1")


def _judge_pair(place: str, pair: Any, most: float) -> None:
    good = isinstance(pair, list) and len(pair) == 2
    for number in pair if good else ():
        good = good and isinstance(number, int | float) and not isinstance(number, bool)
        good = good and abs(number) <= most
    if not good:
        raise SettingError(f"{place} is {shown(pair)}; it must be two numbers within {most:g} m")


def _judge_place(terrain: Any, obstacles: list[Any]) -> None:
    if terrain is not None:
        place = "the document's terrain"
        if not isinstance(terrain, dict) or not {"generator", "given"} & set(terrain):
            raise SettingError(
                f"{place} is {shown(terrain)}; it must be null for flat ground, or have a "
                f"generator, one of {choices(GENERATORS)}"
            )
        if "given" in terrain:
            SceneTable(place, terrain, ("given",)).text("given")
        else:
            made_terrain(json.dumps(terrain, sort_keys=True))
    for i, obstacle in enumerate(obstacles):
        still_obstacle(i, obstacle, (1.0, 1.0, 1.0))


@lru_cache(maxsize=8)
def made_terrain(terrain: str) -> Terrain | TiledTerrain:
    """Return the terrain that a generator makes of a document's `terrain`, as JSON text.

    Raises:
        SceneError: no such generator, or a key or value that it does not take.
    """
    return read_generated("the document's terrain", json.loads(terrain), 0)


def still_obstacle(index: int, values: Any, own_size: Sequence[float]) -> Obstacle:
    """Return an obstacle of a document; what it may have is a scene file's [[obstacle]].

    A mesh is returned as the box that it fills: its file is known where the world is made.

    Args:
        index: its number.
        values: what the document says of it.
        own_size: m, of a mesh for which the document says none.

    Raises:
        SettingError: it is none.
    """
    place = f"obstacle {index + 1}"
    if isinstance(values, dict) and values.get("shape") == "mesh":
        table = SceneTable(f"{place}, a mesh,", values, MESH)
        if not GIVEN.fullmatch(table.text("file")):
            table.fail("file", "one that was given to the studio: upload: and its SHA-256")
        box = {key: value for key, value in values.items() if key not in ("file", *SPLIT)}
        values = {"size": list(own_size), **box, "shape": "box"}
    return read_obstacle(None, place, values)
