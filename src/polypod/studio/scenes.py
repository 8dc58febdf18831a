"""Scene files and creature files, to and from the document."""

from __future__ import annotations

import copy
import math
import tempfile
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from polypod.environment.obstacles import Obstacle
from polypod.environment.scene import CreatureSpec, Scene, read_scene
from polypod.environment.scene_values import shown
from polypod.errors import SceneError, SettingError, choices
from polypod.gait.library import make_gait, names
from polypod.morphology.load import load_rig
from polypod.studio.asked import disks_of
from polypod.studio.document import CREATURE, Document, default_document, judged
from polypod.studio.places import Ground
from polypod.studio.rigs_given import GivenRigs
from polypod.studio.toml_text import key_text, table

# Keys of a terrain that name files.
FILES = ("heightmap", "tiles", "mesh", "water")
PLACE = "the scene"


def document_of(data: bytes, before: Document, rigs: GivenRigs) -> Document:
    """Return what a scene file asks for, as the page sends it: its text and no file beside it.

    Args:
        data: the file.
        before: the document whose creature walks there, if the scene has none of its own.
        rigs: where the rigs are that it names.

    Raises:
        PolypodError: it is no scene, or asks for what only a file beside it could say.
    """
    try:
        values = tomllib.loads(data.decode())
    except (ValueError, RecursionError) as error:
        raise SceneError(f"{PLACE} is no valid TOML ({str(error)[:120]})") from None
    terrain = values.get("terrain", {})
    named = [key for key in FILES if isinstance(terrain, dict) and key in terrain]
    if named:
        raise SceneError(
            f"{PLACE}'s terrain names a file by {named[0]}, and the page has only the scene; "
            "start with it: polypod studio --scene SCENE.toml"
        )
    _refuse_meshes(values)
    with tempfile.TemporaryDirectory(prefix="polypod-studio-") as folder:
        file = Path(folder) / "scene.toml"
        file.write_bytes(data)
        try:
            scene = read_scene(file)
        except SceneError as error:
            raise SceneError(str(error).replace(str(file), PLACE)) from None
    return _document(scene, values, before, rigs, None)


def read_document(
    path: Path, before: Document, rigs: GivenRigs
) -> tuple[Document, dict[str, Ground]]:
    """Return what a scene file on this computer asks for, and the terrain that it has of files.

    Raises:
        PolypodError: it is no scene, or has what the studio has not.
    """
    scene = read_scene(path)
    values = tomllib.loads(path.read_text(encoding="utf-8"))
    _refuse_meshes(values)
    if any(key in values.get("terrain", {}) for key in FILES):
        values["terrain"] = {"given": path.name}
        given = {path.name: scene.terrain}
    else:
        given = {}
    return _document(scene, values, before, rigs, path.parent), given


def _refuse_meshes(values: Mapping[str, Any]) -> None:
    obstacles = values.get("obstacle", [])
    for i, one in enumerate(obstacles if isinstance(obstacles, list) else []):
        if isinstance(one, dict) and one.get("shape") == "mesh":
            raise SettingError(
                f"obstacle {i + 1} is a mesh; the studio has box, cylinder, sphere and hull"
            )


def _document(
    scene: Scene,
    values: Mapping[str, Any],
    before: Document,
    rigs: GivenRigs,
    folder: Path | None,
) -> Document:
    """Return a scene's document; `folder`: where rigs that it names may lie, None: nowhere."""
    document = copy.deepcopy(before)
    if scene.creatures:
        document = _cast(scene.creatures, rigs, folder)
    written = list(values.get("obstacle", []))
    scattered = scene.obstacles[len(written) :]
    document["obstacle"] = [*written, *(_box(one) for one in scattered)]
    document["terrain"] = values.get("terrain")
    return judged(document)


def _cast(creatures: tuple[CreatureSpec, ...], rigs: GivenRigs, folder: Path | None) -> Document:
    first = creatures[0]
    document = default_document(_find(first.rig, rigs, folder))
    asked = {"leg": list(first.leg) or None, "spine": list(first.spine) or None}
    asked |= {key: getattr(first, key) for key in ("forward", "height", "body_height")}
    document["creature"] |= asked
    document["command"]["speed"] = first.speed
    start = first.position
    path = [list(point) for point in first.path]
    if start is None and path:
        start = (path[0][0], path[0][1])
    if path and start is not None and tuple(path[0]) == start:
        path = path[1:]
    document["path"] = path
    heading = first.heading
    if heading is None:
        x, z = start or (0.0, 0.0)
        heading = math.atan2(path[0][0] - x, path[0][1] - z) if path else 0.0
    document["command"]["heading"] = heading
    if first.gait is not None:
        document["gait"] = _disks(first.gait, document["creature"], rigs)
    counts = [(first.rig, first.count - 1), *((spec.rig, spec.count) for spec in creatures[1:])]
    document["crowd"] = [
        {"rig": _find(rig, rigs, folder), "count": count} for rig, count in counts if count > 0
    ]
    return document


def _find(name: str, rigs: GivenRigs, folder: Path | None) -> str:
    """Return what a document calls the rig that a scene names."""
    if folder is not None and (folder / name).is_file():
        return rigs.point_to(folder / name)
    found = rigs.named(Path(name).name)
    if found is None:
        raise SettingError(
            f"{PLACE} has the rig {shown(name)}, which is not in the studio: drop its file on the "
            "page first, then open the scene again"
        )
    return found


def _disks(gait: str, creature: Mapping[str, Any], rigs: GivenRigs) -> dict[str, Any]:
    if gait not in names():
        raise SettingError(f"{PLACE} has the gait {shown(gait)}; the studio has {choices(names())}")
    legs = load_rig(
        rigs.find(creature["rig"]),
        legs=creature["leg"],
        spine=creature["spine"],
        forward=creature["forward"],
        height=creature["height"],
    ).legs
    return disks_of(make_gait(gait, legs.side, legs.row))


def _box(obstacle: Obstacle) -> dict[str, Any]:
    """Return a scattered box as a scene writes it; its turn is about the vertical."""
    _, y, _, w = obstacle.rotation
    return {
        "name": obstacle.name,
        "shape": "box",
        "size": [float(v) for v in obstacle.size],
        "position": [float(v) for v in obstacle.position],
        "yaw": 2.0 * math.atan2(y, w),
        "forbidden": obstacle.forbidden,
    }


def scene_toml(document: Document, rigs: GivenRigs) -> str:
    """Return a document as a scene file; what a scene cannot say is left out."""
    parts = []
    terrain = document["terrain"]
    if terrain is not None and "given" in terrain:
        parts.append(f"# Its terrain is that of {_one_line(terrain['given'])}.\n")
    elif terrain is not None:
        parts.append(table("[terrain]", terrain))
    parts += [table("[[obstacle]]", one) for one in document["obstacle"]]
    creature, command, gait = document["creature"], document["command"], document["gait"]
    comments = []
    if gait is not None and gait["name"] not in names():
        comments.append("Its gait was drawn by hand; a scene has gaits by name or file.")
        gait = None
    path = document["path"]
    walk = {
        "position": [0.0, 0.0],
        "heading": command["heading"],
        "speed": command["speed"],
        "gait": None if gait is None else gait["name"],
        "path": [[0.0, 0.0], *path] if path else None,
    }
    asked = creature | {"rig": rigs.name(creature["rig"])}
    parts.append(table("[[creature]]", asked | walk, *comments))
    for kind in document["crowd"]:
        parts.append(table("[[creature]]", kind | {"rig": rigs.name(kind["rig"])}))
    return "\n".join(parts)


def creature_toml(creature: Mapping[str, Any], rigs: GivenRigs) -> str:
    """Return a document's creature as a creature file, to lie beside its rig."""
    top: dict[str, Any] = {"rig": rigs.name(creature["rig"])}
    file = Path(rigs.find(creature["rig"]))
    inner: dict[str, Any] = {}
    if file.suffix.lower() == ".toml":
        # It came from such a file, which says more than the document does.
        top = tomllib.loads(file.read_text(encoding="utf-8"))
        inner = {key: top.pop(key) for key in ("body", "foot", "limit") if key in top}
    top |= {key: creature[key] for key in CREATURE[1:] if creature[key] is not None}
    parts = [table("", top)]
    if "body" in inner:
        parts.append(table("[body]", inner["body"]))
    for kind in ("foot", "limit"):
        parts += [
            table(f"[{kind}.{key_text(name)}]", values)
            for name, values in inner.get(kind, {}).items()
        ]
    return "\n".join(parts)


def _one_line(text: str) -> str:
    return " ".join(text.split())
