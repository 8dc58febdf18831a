"""A glTF 2.0 document: GLB or .gltf in, judged at the door, then read as arrays.

Nothing is thrown away: the JSON and the bytes stay as they were, so that the writer can add to them
(`polypod.rigs.export`). Node and joint transforms are 4x4 matrices that act on columns.
"""

from __future__ import annotations

import os
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polypod.errors import RigError
from polypod.rigs import container
from polypod.rigs.accessors import AccessorReader
from polypod.rigs.colours import ColourReader, Paint, image_bytes
from polypod.rigs.fields import Place
from polypod.rigs.meshes import MeshPart, Skin, place_geometry, read_geometry, read_skins
from polypod.rigs.nodes import FloatArray, IntArray, local_matrix, read_parents, world_matrices

__all__ = ["GltfDocument", "MeshPart", "Skin"]

# Every list that the writer may add to or walk through.
LISTS = (
    "accessors",
    "animations",
    "buffers",
    "bufferViews",
    "images",
    "materials",
    "meshes",
    "nodes",
    "scenes",
    "skins",
    "textures",
)


class GltfDocument:
    """A glTF file: `json` and `binary` as they are in it, and arrays read from them.

    Attributes:
        name: the file's name, for messages.
        json: the parsed JSON, untouched; nobody may change it.
        binary: the bytes of the GLB's BIN chunk, or of the first buffer; empty where there is none.
        other_chunks: type and content of the GLB's chunks that are neither JSON nor BIN.
        buffers: the bytes of every buffer, wherever they were.
        folder: where outside files are looked for, None where there are none.
        has_binary_chunk: whether it came as a GLB with a BIN chunk.
    """

    def __init__(self, parts: container.Container, name: str, folder: Path | None):
        """Judge the parts of a file; `read` and `from_bytes` are the usual ways in.

        Raises:
            RigError: anything in it that cannot be a rig.
        """
        self.name = name
        self.folder = folder
        self.json: dict[str, Any] = parts.json
        self.has_binary_chunk = parts.binary is not None
        self.other_chunks = parts.other_chunks
        self.root = Place(name, "", parts.json)
        self.buffers = container.load_buffers(self.root, parts.binary, folder)
        first = bytes(self.buffers[0]) if self.buffers else b""
        self.binary: bytes = first if parts.binary is None else parts.binary
        self._reader = AccessorReader(self.root, self.buffers)
        self._judge()

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> GltfDocument:
        """Read a .glb or .gltf file; outside buffers and images lie beside it.

        Raises:
            RigError: there is no such file, or it is no sound glTF.
        """
        source = Path(path)
        try:
            data = source.read_bytes()
        except OSError as fault:
            raise RigError(f"{source}: cannot be read: {fault.strerror}") from None
        except ValueError as fault:  # a name with a null character in it
            raise RigError(f"{str(source)!r}: cannot be read: {fault}") from None
        return cls.from_bytes(data, source.name, source.parent)

    @classmethod
    def from_bytes(cls, data: bytes, name: str, folder: Path | None = None) -> GltfDocument:
        """Read GLB or .gltf bytes; without a folder, outside files are refused.

        Raises:
            RigError: the bytes are no sound glTF.
        """
        return cls(container.split(data, name), name, folder)

    def accessor(self, index: int) -> NDArray[Any]:
        """Return [count], [count, n] or, for matrices, [count, n, n]; float64 or int64.

        Raises:
            RigError: there is no such accessor, or it does not fit into its buffer.
        """
        count = len(self._reader.accessors)
        if not 0 <= index < count:
            raise self.root.error(f"has no number {index}: there are {count}", "accessors")
        return self._reader.read(index)

    def node_parents(self) -> IntArray:
        """Return [N] the parent of each node, -1 for roots."""
        return self._parents.copy()

    def node_local_matrices(self) -> FloatArray:
        """Return [N, 4, 4] each node's own matrix."""
        return self._local.copy()

    def node_world_matrices(self) -> FloatArray:
        """Return [N, 4, 4] each node's matrix in the file's world space, as its nodes pose it."""
        return self._world.copy()

    def node_names(self) -> tuple[str, ...]:
        """Return [N] names, empty where the file has none."""
        return tuple(place.text("name") for place in self._nodes)

    def skins(self) -> tuple[Skin, ...]:
        """Return all skins."""
        return self._skins

    def mesh_parts(self) -> tuple[MeshPart, ...]:
        """Return one part for each primitive of triangles of each node that shows it."""
        return self._mesh_parts

    @cached_property
    def _nodes(self) -> list[Place]:
        return self.root.parts("nodes")

    @cached_property
    def _mesh_parts(self) -> tuple[MeshPart, ...]:
        colours = ColourReader(self.root, self._reader, self.folder)
        found: dict[int, tuple[FloatArray, Paint | None]] = {}
        parts = []
        for node, skin, part in self._shown:
            if id(part) not in found:
                found[id(part)] = (colours.vertex_colour(part), colours.paint(part))
            colour, paint = found[id(part)]
            width = part.joints.shape[1] if skin >= 0 else 0
            parts.append(
                MeshPart(
                    node=node,
                    skin=skin,
                    positions=part.positions,
                    normals=part.normals,
                    triangles=part.triangles,
                    joints=part.joints[:, :width],
                    weights=part.weights[:, :width],
                    colour=colour.mean(axis=0) if len(colour) else np.ones(3),
                    vertex_colour=colour,
                    paint=paint,
                )
            )
        return tuple(parts)

    def image(self, index: int) -> bytes:
        """Return the bytes of an image, in whatever format it is.

        Raises:
            RigError: there is no such image, or it lies in a file that is not there.
        """
        places = self.root.parts("images")
        if not 0 <= index < len(places):
            raise self.root.error(f"has no number {index}: there are {len(places)}", "images")
        return image_bytes(places[index], self._reader, self.folder)

    def _judge(self) -> None:
        """Read all that a rig needs, once, so that what is wrong is said here."""
        for key in LISTS:
            self.root.parts(key)
        self._parents = read_parents(self._nodes)
        count = len(self._nodes)
        self._local = np.array([local_matrix(place) for place in self._nodes]).reshape(count, 4, 4)
        self._world = world_matrices(self._local, self._parents)
        if not np.isfinite(self._world).all():
            worst = int(np.flatnonzero(~np.isfinite(self._world).all(axis=(1, 2)))[0])
            raise self._nodes[worst].error("has an absurdly large transform")
        self.node_names()
        for index in range(len(self._reader.accessors)):
            self._reader.check(index)
        self._skins = read_skins(self.root, self._reader)
        geometry = read_geometry(self.root, self._reader)
        self._shown = place_geometry(self.root, geometry, self._skins)
        for scene in self.root.parts("scenes"):
            scene.indices("nodes", count)
        self.root.reference("scene", len(self.root.parts("scenes")))
