"""The place that a document asks for, changed as little as a new document needs."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.environment.terrain import Terrain
from polypod.report.arrays import FloatArray
from polypod.studio.document import Document, made_terrain, still_obstacle
from polypod.studio.world_files import Ground, WorldFiles, mesh_obstacle

# What may change of an obstacle while it stays the same to whoever stands on it.
MOVED = ("position", "yaw")


class Change(NamedTuple):
    """How to get from one place to the next."""

    environment: Environment | None  # None: the one before stays, moved
    renumbered: tuple[int, ...]  # of each obstacle before, its number now, -1: gone


def terrain_of(document: Document, files: WorldFiles) -> Ground:
    """Return the terrain that a document asks for.

    Raises:
        SettingError: it is one of the scenes that were opened, and none of that name was.
    """
    terrain = document["terrain"]
    if terrain is None:
        return Terrain.flat()
    if "given" in terrain:
        return files.ground(terrain["given"]).ground
    return made_terrain(json.dumps(terrain, sort_keys=True))


def made_obstacle(index: int, values: dict[str, Any], files: WorldFiles) -> Obstacle:
    """Return an obstacle of a document.

    Raises:
        SettingError: a mesh that is not in the studio.
    """
    if values["shape"] != "mesh":
        return still_obstacle(index, values, ())
    solid = files.solid(values["file"], values)
    return mesh_obstacle(still_obstacle(index, values, solid.size), solid)


def make_place(document: Document, files: WorldFiles) -> Environment:
    """Return the place that a document asks for, in which what stands may be moved."""
    obstacles = [made_obstacle(i, one, files) for i, one in enumerate(document["obstacle"])]
    return Environment(terrain_of(document, files), obstacles, movable=True)


def change_of(
    before: Document, after: Document, environment: Environment, files: WorldFiles
) -> Change:
    """Return how the obstacles of a document come to those of the next, on the same terrain."""
    old, new = before["obstacle"], after["obstacle"]
    alike = len(old) == len(new)
    if alike and all(_only_moved(a, b) for a, b in zip(old, new, strict=True)):
        for i, (a, b) in enumerate(zip(old, new, strict=True)):
            if a != b:
                _move(i, b, environment)
        return Change(None, ())
    return Change(make_place(after, files), renumbered(old, new, len(environment.obstacles)))


def _only_moved(before: dict[str, Any], after: dict[str, Any]) -> bool:
    if before == after:
        return True
    stands = not any(key in after for key in ("velocity", "path", "turn_rate", "rotation"))
    kept = [{k: v for k, v in one.items() if k not in MOVED} for one in (before, after)]
    return stands and kept[0] == kept[1]


def _move(index: int, values: dict[str, Any], environment: Environment) -> None:
    made = environment.obstacles[index]
    turned = float(values.get("yaw", 0.0)) - yaw_of(made)
    environment.move(index, values["position"], turned=turned)


def yaw_of(obstacle: Obstacle) -> float:
    """Return the turn about the vertical, rad, of an obstacle that has no other."""
    return 2.0 * math.atan2(obstacle.rotation[1], obstacle.rotation[3])


def renumbered(
    before: Sequence[dict[str, Any]], after: Sequence[dict[str, Any]], total: int
) -> tuple[int, ...]:
    """Return which obstacle after a change each one before is, -1: it is gone.

    One that was changed is the one at its number, unless that is another one that was there before.
    What follows them, to the `total`, is the terrain's own.
    """
    shift = len(after) - len(before)
    return (*_found_again(before, after), *(i + shift for i in range(len(before), total)))


def on_other_ground(
    before: Sequence[dict[str, Any]], after: Sequence[dict[str, Any]], total: int
) -> tuple[int, ...]:
    """Return the same where the terrain is another: what was its own, to the `total`, is gone."""
    return (*_found_again(before, after), *[-1] * (total - len(before)))


def _found_again(before: Sequence[dict[str, Any]], after: Sequence[dict[str, Any]]) -> list[int]:
    found = [i if i < len(after) and one == after[i] else -1 for i, one in enumerate(before)]
    free = [j for j in range(len(after)) if j >= len(before) or found[j] != j]
    for i, one in enumerate(before):
        if found[i] < 0:
            found[i] = next((j for j in free if after[j] == one), -1)
            free = [j for j in free if j != found[i]]
    return [i if found[i] < 0 and i in free else found[i] for i in range(len(before))]


def obstacle_poses(environment: Environment, shown: int) -> FloatArray:
    """Return [O, 7] quaternions and positions of the first `shown` obstacles, world, m."""
    if shown == 0:
        return np.zeros((0, 7))
    return np.concatenate([environment.rotations, environment.places()], axis=1)[:shown]
