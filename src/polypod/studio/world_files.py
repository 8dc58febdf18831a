"""Files that the world is made of: meshes that stand about, and grounds of heights or of meshes.

A document names a mesh by its content (`upload:` and the SHA-256), a ground by a name of its own;
scenes name both by their files. Files from a page lie in a folder of the studio's, which is deleted
at its end; those of a scene on this computer stay where they are.
"""

from __future__ import annotations

import hashlib
import json
import shutil
import tempfile
import threading
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from polypod.environment.obstacles import Obstacle, three_numbers
from polypod.environment.scene import SPLIT, read_obstacle
from polypod.environment.terrain import Terrain
from polypod.environment.tiled import TiledTerrain
from polypod.environment.triangles import read_triangles
from polypod.errors import PolypodError, SceneError, SettingError, choices
from polypod.studio.mesh_limits import MESHES, judge_file
from polypod.studio.mesh_surface import pack_mesh
from polypod.studio.rigs_given import UPLOAD, clean_name
from polypod.studio.waiting_files import WaitingFiles

MOST_MESHES, MOST_GROUNDS = 64, 4
Ground = Terrain | TiledTerrain


class Mesh(NamedTuple):
    """A mesh that may stand about."""

    file: Path
    name: str  # as its owner calls it
    own: bool  # it lies in the studio's folder


class GivenGround(NamedTuple):
    """A ground that is made of files."""

    ground: Ground
    values: Mapping[str, Any]  # a scene's [terrain]
    folder: Path  # from which its files are found
    own: bool


class WorldFiles:
    """The files of the world. Its methods may be called from any thread."""

    def __init__(self) -> None:
        self._meshes: dict[str, Mesh] = {}  # the one used last is the last
        self._solids: dict[tuple[str, str], Obstacle] = {}
        self._surfaces: dict[str, bytes] = {}
        self._grounds: dict[str, GivenGround] = {}
        self.waiting = WaitingFiles(self.new_folder)
        self._in_use: frozenset[str] = frozenset()
        self._folder: Path | None = None  # made when something has to lie in it
        self._lock = threading.RLock()

    def close(self) -> None:
        """Delete all files that were taken in."""
        with self._lock:
            if self._folder is not None:
                shutil.rmtree(self._folder, ignore_errors=True)
            self._folder = None

    def new_folder(self) -> Path:
        """Return a new folder of the studio's own."""
        with self._lock:
            if self._folder is None:
                self._folder = Path(tempfile.mkdtemp(prefix="polypod-studio-"))
            return Path(tempfile.mkdtemp(prefix="scene-", dir=self._folder))

    def use(self, names: Iterable[str]) -> None:
        """Say which meshes and grounds the document has: they stay."""
        with self._lock:
            self._in_use = frozenset(names)

    # Meshes.

    def take(self, data: bytes, name: str) -> dict[str, Any]:
        """Take a mesh in that is to stand about, and return what was found.

        A surface with holes gets lids on them.

        Args:
            data: an OBJ, a GLB or a .gltf that holds everything.
            name: of its owner's file.

        Returns:
            `file`, what a document calls it, `name`, `size` [3] m, `parts`, and with `close` true
            where lids were put on.

        Raises:
            PolypodError: it is no mesh, bounds no solid, or is too large; it is not kept.
        """
        suffix = Path(name).suffix.lower()
        if suffix not in MESHES:
            raise SceneError(f"{name[:80]} is no mesh; the studio reads {choices(MESHES)}")
        title = clean_name(name, suffix)
        folder = self.new_folder()
        file = folder / title
        file.write_bytes(data)
        try:
            judge_file(file)
            mesh = self._note(hashlib.sha256(data).hexdigest(), file, title, own=True)
            split: dict[str, Any] = {}
            try:
                solid = self.split(mesh, split)
            except PolypodError:
                split = {"close": True}
                solid = self.split(mesh, split)
        except PolypodError as error:
            self._drop(file)
            shutil.rmtree(folder, ignore_errors=True)
            raise type(error)(str(error).replace(str(file), title)) from None
        size, parts = list(solid.size), len(solid.parts)
        return {"file": mesh, "name": title, "size": size, "parts": parts, **split}

    def point_to(self, file: Path, name: str, own: bool) -> str:
        """Return what a document calls a mesh of a scene.

        Args:
            file: the mesh.
            name: how the scene calls it.
            own: the scene's folder is to go.

        Raises:
            SceneError: it cannot be read.
        """
        try:
            data = file.read_bytes()
        except OSError as error:
            raise SceneError(f"{file}: no mesh can be read ({error.strerror or error})") from None
        if own:
            kept = self.new_folder() / file.name
            kept.write_bytes(data)
            file = kept
        return self._note(hashlib.sha256(data).hexdigest(), file, name, own)

    def know(self, mesh: str, split: Mapping[str, Any], solid: Obstacle) -> None:
        """Take over how a mesh was split when its scene was read."""
        with self._lock:
            self._solids.setdefault((mesh, _key(split)), solid)

    def split(self, mesh: str, split: Mapping[str, Any]) -> Obstacle:
        """Split a mesh into convex parts, which may take a while; it is known from then on.

        Raises:
            SceneError: the file cannot be read, or bounds no solid.
        """
        file = self._mesh(mesh).file
        values = {"shape": "mesh", "file": file.name, "position": [0.0, 0.0, 0.0], **split}
        solid = read_obstacle(file.parent / "scene.toml", file.name, values)
        self.know(mesh, split, solid)
        return solid

    def solid(self, mesh: str, split: Mapping[str, Any]) -> Obstacle:
        """Return a mesh as it was split, at the size at which it was.

        Raises:
            SettingError: there is no such mesh, or it was not split so.
        """
        name = self._mesh(mesh).name
        with self._lock:
            found = self._solids.get((mesh, _key(split)))
        if found is None:
            raise SettingError(
                f"{name} is not split so finely here; say it in a scene file, and open that"
            )
        return found

    def surface(self, mesh: str) -> bytes:
        """Return the triangles of a mesh as named arrays, its box of size 1.

        Raises:
            PolypodError: there is no such mesh.
        """
        with self._lock:
            if mesh not in self._surfaces:
                self._surfaces[mesh] = pack_mesh(read_triangles(self._mesh(mesh).file))
            return self._surfaces[mesh]

    def mesh(self, mesh: str) -> Mesh:
        """Return a mesh's file and name.

        Raises:
            SettingError: there is no such mesh.
        """
        return self._mesh(mesh)

    @property
    def mesh_names(self) -> dict[str, str]:
        """What people call each mesh."""
        with self._lock:
            return {mesh: one.name for mesh, one in self._meshes.items()}

    def _mesh(self, mesh: str) -> Mesh:
        with self._lock:
            found = self._meshes.pop(mesh, None)
            if found is None:
                known = choices(one.name for one in self._meshes.values()) or "none"
                raise SettingError(
                    f"that mesh is not in the studio now, drop its file on the page; it has {known}"
                )
            self._meshes[mesh] = found
            return found

    def _note(self, digest: str, file: Path, name: str, own: bool) -> str:
        mesh = UPLOAD + digest
        with self._lock:
            before = self._meshes.pop(mesh, None)
            if before is None:
                self._make_room()
            elif before.own:
                shutil.rmtree(before.file.parent, ignore_errors=True)
            self._meshes[mesh] = Mesh(file, name, own)
        return mesh

    def _make_room(self) -> None:
        if len(self._meshes) < MOST_MESHES:
            return
        free = [mesh for mesh in self._meshes if mesh not in self._in_use]
        if not free:
            raise SettingError(f"{MOST_MESHES} meshes are in use; the studio takes no more")
        self._forget(free[0])

    def _forget(self, mesh: str) -> None:
        gone = self._meshes.pop(mesh, None)
        if gone is not None and gone.own:
            shutil.rmtree(gone.file.parent, ignore_errors=True)
        self._surfaces.pop(mesh, None)
        for key in [key for key in self._solids if key[0] == mesh]:
            del self._solids[key]

    def _drop(self, file: Path) -> None:
        """Forget a mesh that turned out to be none."""
        with self._lock:
            for mesh in [mesh for mesh, one in self._meshes.items() if one.file == file]:
                self._forget(mesh)

    # Grounds.

    def keep_ground(self, name: str, given: GivenGround) -> str:
        """Keep the ground of a scene, and return its name in documents: a free one."""
        with self._lock:
            title, number = name, 1
            while title in self._grounds:
                number += 1
                title = f"{name}-{number}"
            free = [one for one in self._grounds if one not in self._in_use]
            if len(self._grounds) >= MOST_GROUNDS and free:
                gone = self._grounds.pop(free[0])
                if gone.own:
                    shutil.rmtree(gone.folder, ignore_errors=True)
            self._grounds[title] = given
            return title

    def ground(self, name: str) -> GivenGround:
        """Return a ground by its name.

        Raises:
            SettingError: there is none of that name.
        """
        with self._lock:
            if name not in self._grounds:
                known = choices(self._grounds) if self._grounds else "none was opened"
                raise SettingError(f"there is no terrain of a scene {name!r}; {known}")
            return self._grounds[name]

    @property
    def ground_names(self) -> list[str]:
        """The grounds that may be chosen."""
        with self._lock:
            return list(self._grounds)


def _key(split: Mapping[str, Any]) -> str:
    return json.dumps({key: split[key] for key in SPLIT if key in split}, sort_keys=True)


def mesh_obstacle(still: Obstacle, solid: Obstacle) -> Obstacle:
    """Return a split mesh that stands, and moves, as a box does, scaled to fill it."""
    scale = np.array(still.size) / np.array(solid.size)
    parts = tuple(
        tuple(three_numbers(point) for point in np.array(part) * scale) for part in solid.parts
    )
    return replace(still, shape="mesh", parts=parts)
