"""What a saved scene takes along: the files of its rigs, meshes and ground, each under a name."""

from __future__ import annotations

import base64
import copy
import json
import posixpath
import tomllib
from pathlib import Path, PurePosixPath
from typing import Any

from polypod.errors import SettingError
from polypod.morphology.builtin import NAMES as BUILT_IN
from polypod.studio.document import Document
from polypod.studio.mesh_limits import tile_pattern
from polypod.studio.rigs_given import GivenRigs
from polypod.studio.saved import creature_text
from polypod.studio.scene_folder import MOST_BYTES, MOST_FILES, SCENE
from polypod.studio.world_files import WorldFiles


class Luggage:
    """The files of a document, and the document with their names in it.

    Attributes:
        named: the document, where rigs, meshes and a ground of files are called as in a scene.
    """

    def __init__(self, document: Document, rigs: GivenRigs, files: WorldFiles) -> None:
        """Give each file a name of its own.

        Raises:
            SettingError: something is not in the studio any more.
        """
        self.named = copy.deepcopy(document)
        self._taken: dict[str, Path] = {}
        self._texts: dict[str, str] = {}  # of creature files, whose rigs have other names here
        terrain = self.named["terrain"]
        if terrain is not None and "given" in terrain:
            ground = files.ground(terrain["given"])
            self.named["terrain"] = self._ground(dict(ground.values), ground.folder)
        for one in self.named["obstacle"]:
            if one["shape"] == "mesh":
                mesh = files.mesh(one["file"])
                one["file"] = self._name(mesh.file, mesh.name)
        for holder in (self.named["creature"], *self.named["crowd"]):
            rig = holder["rig"]
            if rig not in BUILT_IN:
                holder["rig"] = self._rig(Path(rigs.find(rig)), rigs.name(rig))

    def _name(self, file: Path, name: str) -> str:
        """Return the name of a file in the scene's folder, another where that is taken."""
        path = PurePosixPath(name)
        number = 1
        while self._taken.get(name, file) != file or name == SCENE:
            number += 1
            name = str(path.with_name(f"{path.stem}-{number}{path.suffix}"))
        self._taken[name] = file
        return name

    def _rig(self, file: Path, title: str) -> str:
        name = self._name(file, title)
        if file.suffix.lower() == ".toml" and name not in self._texts:
            values = tomllib.loads(file.read_text(encoding="utf-8"))
            if values["rig"] not in BUILT_IN:
                inner = file.parent / values["rig"]
                values["rig"] = self._name(inner, inner.name)
            self._texts[name] = creature_text(values)
        return name

    def _ground(self, values: dict[str, Any], folder: Path) -> dict[str, Any]:
        for key in ("heightmap", "tiles", "mesh", "water"):
            if key not in values:
                continue
            path = PurePosixPath(posixpath.normpath(values[key]))
            values[key] = str(path)
            if "{" not in path.name:
                self._name(folder / path, str(path))
                continue
            listed = tile_pattern(path.name)
            for file in sorted((folder / path).parent.iterdir()):
                if listed.fullmatch(file.name):
                    self._name(file, str(path.with_name(file.name)))
        return values

    def contents(self) -> dict[str, bytes]:
        """Return the files' bytes by their names.

        Raises:
            SettingError: one cannot be read any more, or they are too large together.
        """
        found = {}
        try:
            size = sum(file.stat().st_size for file in self._taken.values())
            if size > MOST_BYTES or len(self._taken) >= MOST_FILES:
                raise SettingError(
                    f"the world's files are {len(self._taken)} of {size >> 20} MiB, and a zip may "
                    f"have {MOST_FILES} of {MOST_BYTES >> 20} MiB"
                )
            for name, file in self._taken.items():
                if name in self._texts:
                    found[name] = self._texts[name].encode()
                else:
                    read = embedded if file.suffix.lower() == ".gltf" else Path.read_bytes
                    found[name] = read(file)
        except (OSError, ValueError, KeyError) as error:
            raise SettingError(f"a file of the world cannot be read any more ({error})") from None
        return found


def embedded(file: Path) -> bytes:
    """Return a .gltf with its buffers in it.

    Raises:
        OSError, ValueError, KeyError: it or a buffer cannot be read.
    """
    content = json.loads(file.read_bytes())
    for buffer in content.get("buffers", []):
        uri = buffer["uri"]
        if not uri.startswith("data:"):
            data = base64.b64encode((file.parent / uri).read_bytes()).decode()
            buffer["uri"] = f"data:application/octet-stream;base64,{data}"
    return json.dumps(content).encode()
