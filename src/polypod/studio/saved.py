"""Documents as scene files, and scene files as documents (docs/formats.md)."""

from __future__ import annotations

import posixpath
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from polypod.environment.obstacles import Obstacle
from polypod.environment.scene import SPLIT, Scene, read_scene
from polypod.studio.document import Document, default_document, judged
from polypod.studio.places import yaw_of
from polypod.studio.toml_text import table, tables_by_name
from polypod.studio.world_files import GivenGround, WorldFiles

# What a scene's [[creature]] takes over from a document's creature.
NAMED = ("leg", "spine", "forward", "height", "body_height")


def scene_text(document: Document) -> str:
    """Return the scene file of a document: terrain, obstacles, and who walks where.

    What a scene file cannot hold (an edited gait, feet spacing, the body's motion) stays in the
    studio's own link. Rigs, meshes and a ground of files are called here as the document does.
    """
    parts = []
    if document["terrain"] is not None:
        parts.append(table("[terrain]", document["terrain"]))
    parts += [table("[[obstacle]]", one) for one in document["obstacle"]]
    first, *others = _creatures(document)
    kinds = (document["creature"], *document["crowd"])
    for values, asked in zip((first, *others), kinds, strict=True):
        parts.append(table("[[creature]]", values))
        parts += tables_by_name("creature.limit", asked.get("limit") or {})
    return "\n".join(parts)


def _creatures(document: Document) -> list[dict[str, Any]]:
    asked = document["creature"]
    first = _named(asked)
    command, gait = document["command"], document["gait"]
    first["heading"] = command["heading"]
    if command["speed"] is not None:
        first["speed"] = command["speed"]
    if gait is not None and gait["name"] != "edited":
        first["gait"] = gait["name"]
    if document["path"]:
        first["path"] = [[0.0, 0.0], *document["path"]]
    return [first, *(_named(kind) | {"count": kind["count"]} for kind in document["crowd"])]


def _named(asked: Mapping[str, Any]) -> dict[str, Any]:
    return {key: asked[key] for key in ("rig", *NAMED) if asked.get(key) is not None}


def creature_text(values: dict[str, Any]) -> str:
    """Return what a creature file says as its text."""
    parts = ("body", "foot", "limit")
    text = [table("", {key: value for key, value in values.items() if key not in parts})]
    if "body" in values:
        text.append(table("[body]", values["body"]))
    for kind in ("foot", "limit"):
        text += tables_by_name(kind, values.get(kind, {}))
    return "\n".join(text)


def document_of_scene(path: Path, before: Document, files: WorldFiles, own: bool) -> Document:
    """Return the document of a scene file; its meshes and its ground are known from then on.

    The creature stays the one before where the scene has none.

    Args:
        path: of the file.
        before: the document that it takes the place of.
        files: of the world.
        own: its folder is one of the studio's.

    Raises:
        SceneError: the file cannot be used.
    """
    scene = read_scene(path)
    values = tomllib.loads(path.read_text(encoding="utf-8"))
    document = default_document(before["creature"]["rig"])
    document["creature"] = dict(before["creature"])
    terrain = values.get("terrain")
    if terrain is not None and "generator" in terrain:
        document["terrain"] = terrain
    elif terrain is not None:
        given = GivenGround(scene.terrain, terrain, path.parent, own)
        document["terrain"] = {"given": files.keep_ground(path.stem, given)}
    document["obstacle"] = [obstacle_values(one) for one in scene.obstacles]
    for i, one in enumerate(values.get("obstacle", [])):
        if one["shape"] == "mesh":
            split = {key: one[key] for key in SPLIT if key in one}
            name = posixpath.normpath(one["file"])
            mesh = files.point_to(path.parent / name, name, own)
            files.know(mesh, split, scene.obstacles[i])
            document["obstacle"][i] |= {"file": mesh, **split}
    _take_creatures(document, scene)
    return judged(document)


def _take_creatures(document: Document, scene: Scene) -> None:
    for i, spec in enumerate(scene.creatures):
        asked = {
            "rig": spec.rig,
            "leg": list(spec.leg) or None,
            "spine": list(spec.spine) or None,
            "forward": spec.forward,
            "height": spec.height,
            "body_height": spec.body_height,
            "limit": spec.limit,
        }
        kind = {key: value for key, value in asked.items() if value is not None}
        if i > 0:
            document["crowd"].append({**kind, "count": spec.count})
            continue
        document["creature"] = asked
        document["command"]["speed"] = spec.speed
        document["command"]["heading"] = spec.heading or 0.0
        way = [list(point) for point in spec.path]
        document["path"] = way[1:] if way and way[0] == [0.0, 0.0] else way
        if spec.count > 1:
            document["crowd"].append({**kind, "count": spec.count - 1})


def obstacle_values(obstacle: Obstacle) -> dict[str, Any]:
    """Return an obstacle as a document holds it, but for a mesh's file and how that is split."""
    values: dict[str, Any] = {"shape": obstacle.shape, "position": list(obstacle.position)}
    if obstacle.name:
        values["name"] = obstacle.name
    if obstacle.shape == "hull":
        values["points"] = [list(point) for point in obstacle.points]
    else:
        values["size"] = list(obstacle.size)
    x, y, z, w = obstacle.rotation
    if x == 0.0 and z == 0.0:
        values["yaw"] = yaw_of(obstacle)
    else:
        values["rotation"] = [x, y, z, w]
    if obstacle.forbidden:
        values["forbidden"] = True
    if any(obstacle.velocity):
        values["velocity"] = list(obstacle.velocity)
    if obstacle.path:
        values["path"] = [list(point) for point in obstacle.path]
        values["speed"] = obstacle.speed
    if obstacle.turn_rate:
        values["turn_rate"] = obstacle.turn_rate
    return values
