"""Scene files and creature files as the studio's users have them: with rigs by their files' names.

`polypod.studio.saved` goes between documents and scene files; a document names an uploaded rig by
its content, a scene by its file.
"""

from __future__ import annotations

import shutil
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from polypod.environment.scene_values import shown
from polypod.errors import PolypodError, SceneError, SettingError, choices
from polypod.gait.library import make_gait, names
from polypod.morphology.builtin import NAMES as BUILT_IN
from polypod.morphology.creature import read_creature
from polypod.morphology.load import load_rig
from polypod.studio.asked import disks_of
from polypod.studio.document import CREATURE, Document
from polypod.studio.luggage import Luggage
from polypod.studio.rigs_given import GivenRigs, clean_name
from polypod.studio.saved import creature_text, document_of_scene, scene_text
from polypod.studio.scene_folder import (
    PLACE,
    ZIP,
    MissingFilesError,
    confine,
    is_creature,
    lay_out,
    pack,
    parsed,
    unpack,
)
from polypod.studio.toml_text import value_text
from polypod.studio.world_files import WorldFiles

# What of a command has a default of each creature's own.
OWN = ("speed", "step_height", "body_height", "period", "duty")


def document_of(
    data: bytes, name: str, before: Document, rigs: GivenRigs, files: WorldFiles
) -> Document:
    """Return what a scene asks for, as the page sends it.

    Args:
        data: a scene file, whose files wait in `files` or are rigs that were given; or a zip of one
            with them.
        name: of the file.
        before: the document whose creature walks there, if the scene has none of its own.
        rigs: where the rigs are that it names.
        files: of the world; meshes and the ground are known from then on.

    Raises:
        PolypodError: it is no scene, or names what cannot be used; MissingFilesError: what is not
            there.
    """
    folder = files.new_folder()
    document = None
    try:
        if data.startswith(ZIP):
            scene = unpack(data, folder)
        else:
            title = clean_name(name, ".toml")
            if is_creature(data):
                document = _with_creature(data, title, before, folder, rigs, files)
                return document
            scene = lay_out(data, title, folder, files.waiting.files, rigs.has)
            files.waiting.let_go()
        document = read_document(scene, before, rigs, files, own=True)
    except MissingFilesError:
        raise
    except PolypodError as error:
        files.waiting.let_go()
        told = str(error).replace(f"{folder}/", "").replace(str(folder), PLACE)
        raise type(error)(told) from None
    finally:
        if document is None or not _reads_on(document, rigs, folder):
            shutil.rmtree(folder, ignore_errors=True)
    return document


def _with_creature(
    data: bytes, title: str, before: Document, folder: Path, rigs: GivenRigs, files: WorldFiles
) -> Document:
    """Return a document in which the creature of a creature file walks; the world stays.

    Raises:
        PolypodError: it is none; MissingFilesError: its rig is not there.
    """
    rig = parsed(data)["rig"]
    wanted = f"[[creature]]\nrig = {value_text(rig)}\n" if isinstance(rig, str) else ""
    lay_out(wanted.encode(), "rig.toml", folder, files.waiting.files, rigs.has)
    known = rigs.named(Path(str(rig)).name)
    if known is not None and known not in BUILT_IN and not (folder / rig).is_file():
        (folder / rig).parent.mkdir(parents=True, exist_ok=True)
        (folder / rig).write_bytes(Path(rigs.find(known)).read_bytes())
    (folder / title).write_bytes(data)
    read_creature(folder / title)
    files.waiting.let_go()
    creature = {"rig": rigs.point_to(folder / title), **dict.fromkeys(CREATURE[1:])}
    command = {**before["command"], **dict.fromkeys(OWN)}
    return {**before, "creature": creature, "command": command, "gait": None, "spacing": []}


def read_document(
    path: Path, before: Document, rigs: GivenRigs, files: WorldFiles, own: bool = False
) -> Document:
    """Return what a scene file on this computer asks for.

    Args:
        path: of the file.
        before: the document whose creature walks there, if the scene has none of its own.
        rigs: where rigs are noted.
        files: of the world, where meshes and a ground are noted.
        own: the scene's folder is one of the studio's, and its files a stranger's.

    Raises:
        PolypodError: it is no scene, or names what cannot be used, or what is not in its folder.
    """
    try:
        values = parsed(path.read_bytes())
    except (OSError, SceneError):
        values = {}  # who reads the scene says so better
    confine(path, values)

    def beside(name: str) -> str | None:
        file = path.parent / name
        if not file.is_file():
            return None
        if own and file.suffix.lower() != ".toml":
            return rigs.take(file.read_bytes(), file.name)
        return rigs.point_to(file)

    document = document_of_scene(path, before, files, own)
    return _cast(document, values, rigs, beside)


def _reads_on(document: Document, rigs: GivenRigs, folder: Path) -> bool:
    """Return whether a document's ground or a creature file of it is read from a folder later."""
    holders = (document["creature"], *document["crowd"])
    files = [Path(rigs.find(holder["rig"])) for holder in holders]
    return "given" in (document["terrain"] or {}) or any(f.is_relative_to(folder) for f in files)


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


def scene_toml(document: Document, rigs: GivenRigs, files: WorldFiles) -> str:
    """Return a document as a scene file; what a scene cannot say is left out.

    Rigs, meshes and heights are called as in the zip of `scene_zip`: it lies beside them.

    Raises:
        SettingError: something that it names is not in the studio any more.
    """
    return scene_text(Luggage(document, rigs, files).named)


def scene_zip(document: Document, rigs: GivenRigs, files: WorldFiles) -> bytes:
    """Return a document as a zip of a scene file and all that it names.

    Raises:
        PolypodError: a file of it is not there any more, or they are too large together.
    """
    luggage = Luggage(document, rigs, files)
    return pack(scene_text(luggage.named), luggage.contents())


def creature_toml(creature: Mapping[str, Any], rigs: GivenRigs) -> str:
    """Return a document's creature as a creature file, to lie beside its rig."""
    values: dict[str, Any] = {"rig": rigs.name(creature["rig"])}
    file = Path(rigs.find(creature["rig"]))
    if file.suffix.lower() == ".toml":
        # It came from such a file, which says more than the document does.
        values = tomllib.loads(file.read_text(encoding="utf-8"))
    return creature_text(
        values | {key: creature[key] for key in CREATURE[1:] if creature[key] is not None}
    )
