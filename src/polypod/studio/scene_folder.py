"""A scene and the files that it names, in one folder: laid out, unpacked, judged, packed again.

A scene may name what lies in its own folder or below it, and nothing else of this computer.
"""

from __future__ import annotations

import io
import tomllib
import zipfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path, PurePosixPath
from typing import Any

from polypod.environment.scene_values import shown
from polypod.errors import PolypodError, SceneError, choices
from polypod.morphology.builtin import NAMES as BUILT_IN
from polypod.studio.mesh_limits import GROUNDS, MESHES, judge_file, tile_pattern

ZIP = b"PK\x03\x04"
MOST_FILES, MOST_BYTES = 512, 256 << 20  # of a zip, unpacked
LARGEST_SCENE = 1 << 20  # bytes
SCENE_KEYS = ("terrain", "obstacle", "scatter", "creature", "push")
PLACE = "the scene"
SCENE = "scene.toml"  # of a zip of ours


class MissingFilesError(SceneError):
    """A scene names files that are not there."""

    def __init__(self, names: list[str]) -> None:
        """Prepare; `names` are those of the files."""
        super().__init__(
            f"{PLACE} names {choices(names)}, which the studio has not: drop the scene on the page "
            "once more, together with what it names"
        )
        self.names = names


def parsed(data: bytes) -> dict[str, Any]:
    """Return what a scene's text says.

    Raises:
        SceneError: it is no TOML.
    """
    try:
        return tomllib.loads(data.decode())
    except (ValueError, RecursionError) as error:
        raise SceneError(f"{PLACE} is no valid TOML ({str(error)[:120]})") from None


def is_creature(data: bytes) -> bool:
    """Return whether this is a creature file, and no scene."""
    try:
        return "rig" in parsed(data)
    except SceneError:
        return False


def named_files(values: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield what the files of a scene are for, and their names; tiles by their pattern."""
    terrain = values.get("terrain")
    if isinstance(terrain, dict) and "generator" not in terrain:
        for key in ("heightmap", "tiles", "mesh", "water"):
            if isinstance(terrain.get(key), str):
                yield f"[terrain] {key}", terrain[key]
    for key, name in (("obstacle", "file"), ("creature", "rig")):
        entries = values.get(key)
        for i, one in enumerate(entries if isinstance(entries, list) else []):
            found = one.get(name) if isinstance(one, dict) else None
            if isinstance(found, str) and found not in BUILT_IN:
                yield f"[[{key}]] number {i + 1}", found


def confine(scene: Path, values: Mapping[str, Any]) -> None:
    """Refuse a scene that names what is not in its folder.

    Raises:
        SceneError: a name leads elsewhere, also by a link.
    """
    folder = scene.parent.resolve()
    for place, name in named_files(values):
        try:
            inside = (scene.parent / name).resolve().is_relative_to(folder)
        except (OSError, ValueError, RuntimeError):  # too long, with a null character, or a circle
            inside = False
        if not inside:
            raise SceneError(
                f"{scene}: {place} names {shown(name)}, which is not in the scene's folder; the "
                "studio reads nothing else: put it there"
            )


def lay_out(
    data: bytes, name: str, folder: Path, loose: Mapping[str, Path], known: Callable[[str], bool]
) -> Path:
    """Return a scene in a folder, with the files that it names and that wait for it.

    Args:
        data: the scene's text.
        name: of its file.
        folder: where it is to lie.
        loose: the files that wait, by name.
        known: tells which names need no file.

    Raises:
        SceneError: it is no scene; MissingFilesError: files are missing.
    """
    scene = folder / name
    values = parsed(data)
    scene.write_bytes(data)
    confine(scene, values)
    missing = []
    for _, wanted in named_files(values):
        last = PurePosixPath(wanted).name
        found = [last] if last in loose else []
        if "{" in last:
            found = [one for one in loose if tile_pattern(last).fullmatch(one)]
        if not found and not known(last):
            missing.append(last)
        for one in found:
            target = (scene.parent / wanted).parent / one
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(loose[one].read_bytes())
    if missing:
        raise MissingFilesError(list(dict.fromkeys(missing)))
    return scene


def unpack(data: bytes, folder: Path) -> Path:
    """Unpack a zip into a folder and return the scene in it.

    Raises:
        SceneError: it is broken or too large, has more or less than one scene, or what no scene
            names.
        RigError: a glTF in it is too large in some way.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            _unpack_files(archive, folder)
    except PolypodError:
        raise
    except Exception:  # what a broken zip raises is not written down anywhere
        raise SceneError("the zip is broken, or locked with a password") from None
    scenes = [file for file in folder.rglob("*.toml") if _is_scene(file)]
    if len(scenes) != 1:
        raise SceneError(f"the zip has {len(scenes)} scenes (.toml); it must have one")
    for file in folder.rglob("*"):
        if file.suffix.lower() in MESHES + GROUNDS:
            judge_file(file)
    return scenes[0]


def _unpack_files(archive: zipfile.ZipFile, folder: Path) -> None:
    files = [entry for entry in archive.infolist() if not entry.is_dir()]
    if len(files) > MOST_FILES:
        raise SceneError(f"the zip has {len(files)} files; it may have {MOST_FILES}")
    left = MOST_BYTES
    for entry in files:
        path = PurePosixPath(entry.filename)
        usual = all(part not in ("", "..") and "\\" not in part and ":" not in part
                    for part in path.parts)  # fmt: skip
        if path.is_absolute() or not usual or not path.parts:
            raise SceneError(f"the zip has a file {shown(entry.filename)}, which leads out of it")
        if path.suffix.lower() not in (".toml", *MESHES, *GROUNDS):
            continue  # a picture or a note beside it
        with archive.open(entry) as file:
            content = file.read(left + 1)  # whatever it says of its size
        left -= len(content)
        if left < 0:
            raise SceneError(f"the zip unpacks to more than {MOST_BYTES >> 20} MiB")
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)


def _is_scene(file: Path) -> bool:
    """Return whether a file is a scene, and no creature file."""
    try:
        values = tomllib.loads(file.read_bytes().decode())
    except (OSError, ValueError, RecursionError):
        return False
    return "rig" not in values and (not values or any(key in values for key in SCENE_KEYS))


def pack(scene: str, files: Mapping[str, bytes]) -> bytes:
    """Return a zip of a scene and the files beside it, by their names."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(SCENE, scene)
        for name, content in files.items():
            archive.writestr(name, content)
    return packed.getvalue()
