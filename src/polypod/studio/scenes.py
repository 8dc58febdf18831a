"""Scene files and creature files as the studio's users have them: with rigs by their files' names.

`polypod.studio.saved` goes between documents and scene files; a document names an uploaded rig by
its content, a scene by its file.
"""

from __future__ import annotations

import copy
import tempfile
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from polypod.environment.scene_values import shown
from polypod.errors import PolypodError, SceneError, SettingError, choices
from polypod.gait.library import make_gait, names
from polypod.morphology.load import load_rig
from polypod.studio.asked import disks_of
from polypod.studio.document import CREATURE, Document
from polypod.studio.places import Ground
from polypod.studio.rigs_given import GivenRigs
from polypod.studio.saved import document_of_scene, scene_text
from polypod.studio.toml_text import table, tables_by_name

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
    _refuse_files(values)
    with tempfile.TemporaryDirectory(prefix="polypod-studio-") as folder:
        file = Path(folder) / "scene.toml"
        file.write_bytes(data)
        try:
            document, _ = document_of_scene(file, before)
        except PolypodError as error:
            raise type(error)(str(error).replace(str(file), PLACE)) from None
    return _cast(document, values, rigs, lambda name: None)


def read_document(
    path: Path, before: Document, rigs: GivenRigs
) -> tuple[Document, dict[str, Ground]]:
    """Return what a scene file on this computer asks for, and the terrain that it has of files.

    Raises:
        PolypodError: it is no scene, or has what the studio has not.
    """

    def beside(name: str) -> str | None:
        file = path.parent / name
        return rigs.point_to(file) if file.is_file() else None

    document, given = document_of_scene(path, before)
    values = tomllib.loads(path.read_text(encoding="utf-8"))
    return _cast(document, values, rigs, beside), given


def _refuse_files(values: Mapping[str, Any]) -> None:
    """Refuse what would be read from this computer's files: only a scene's own folder may say so.

    Raises:
        SceneError: a terrain or an obstacle names a file.
    """
    places = [("terrain", values.get("terrain"))]
    obstacles = values.get("obstacle")
    if isinstance(obstacles, list):
        places += [(f"[[obstacle]] number {i + 1}", one) for i, one in enumerate(obstacles)]
    for place, keys in places:
        found = [key for key in (*FILES, "file") if isinstance(keys, dict) and key in keys]
        if found:
            raise SceneError(
                f"{PLACE}: {place} names a file by {found[0]}, and the page has only the scene; "
                "open it from where it is: polypod studio SCENE.toml"
            )


def _cast(
    document: Document,
    values: Mapping[str, Any],
    rigs: GivenRigs,
    beside: Callable[[str], str | None],
) -> Document:
    """Return a scene's document with its rigs found, and with its first creature's gait."""
    if not values.get("creature"):
        return document
    for holder in (document["creature"], *document["crowd"]):
        name = holder["rig"]
        rig = beside(name) or rigs.named(Path(name).name)
        if rig is None:
            raise SettingError(
                f"{PLACE} has the rig {shown(name)}, which is not in the studio: drop its file on "
                "the page first, then open the scene again"
            )
        holder["rig"] = rig
    gait = values["creature"][0].get("gait")
    if gait is not None:
        document["gait"] = _disks(gait, document["creature"], rigs)
    return document


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


def scene_toml(document: Document, rigs: GivenRigs) -> str:
    """Return a document as a scene file; what a scene cannot say is left out.

    Raises:
        SettingError: its terrain is of files that another scene names.
    """
    named = copy.deepcopy(document)
    for holder in (named["creature"], *named["crowd"]):
        holder["rig"] = rigs.name(holder["rig"])
    return scene_text(named)


def creature_toml(creature: Mapping[str, Any], rigs: GivenRigs) -> str:
    """Return a document's creature as a creature file, to lie beside its rig."""
    top: dict[str, Any] = {"rig": rigs.name(creature["rig"])}
    file = Path(rigs.find(creature["rig"]))
    inner: dict[str, Any] = {}
    if file.suffix.lower() == ".toml":
        # It came from such a file, which says more than the document does.
        top = tomllib.loads(file.read_text(encoding="utf-8"))
        inner = {key: top.pop(key) for key in ("body", "foot", "limit") if key in top}
    said = {key: creature[key] for key in CREATURE[1:] if creature[key] is not None}
    if "limit" in said:
        inner["limit"] = said.pop("limit")
    top |= said
    parts = [table("", top)]
    if "body" in inner:
        parts.append(table("[body]", inner["body"]))
    for kind in ("foot", "limit"):
        parts += tables_by_name(kind, inner.get(kind, {}))
    return "\n".join(parts)
