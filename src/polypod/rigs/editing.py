"""Append-only editing of a glTF document: what was there stays, bytes and JSON alike.

Only these fields of the original change: `uri` of buffers and images that were outside files, the
first buffer's `byteLength`, what holds the nodes that are put under a new one, and `matrix` of
nodes that must move.
"""

from __future__ import annotations

import base64
import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polypod.errors import RigError
from polypod.rigs.container import BINARY_CHUNK, JSON_CHUNK, MAGIC, resolve_uri
from polypod.rigs.gltf import GltfDocument
from polypod.rigs.nodes import decompose

FLOAT = 5126
TYPE_NAMES = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
MEDIA_TYPES = {b"\x89PNG": "image/png", b"\xff\xd8\xff": "image/jpeg", b"RIFF": "image/webp"}


class GltfEditor:
    """A copy of a document's JSON to which nodes, accessors and animations are added."""

    def __init__(self, document: GltfDocument):
        """Copy the JSON and embed what lies in outside files.

        Raises:
            RigError: the JSON is nested so deeply that it cannot be written again.
        """
        self.document = document
        try:
            self.json: dict[str, Any] = json.loads(json.dumps(document.json, allow_nan=False))
        except RecursionError:
            raise document.root.error("is nested too deeply to be written again") from None
        self.binary = bytearray(self._embed_buffers())
        self._embed_images()

    def add_accessor(self, values: NDArray[np.float32], bounds: bool = False) -> int:
        """Append floats [F] or [F, n] to the buffer and return the index of their accessor."""
        self._align()
        start = len(self.binary)
        self.binary += np.ascontiguousarray(values, "<f4").tobytes()
        view = {"buffer": 0, "byteOffset": start, "byteLength": len(self.binary) - start}
        width = values.shape[1] if values.ndim == 2 else 1
        accessor: dict[str, Any] = {
            "bufferView": self._append("bufferViews", view),
            "componentType": FLOAT,
            "count": len(values),
            "type": TYPE_NAMES[width],
        }
        if bounds:
            flat = values.reshape(len(values), width)
            accessor["min"] = [float(value) for value in flat.min(axis=0)]
            accessor["max"] = [float(value) for value in flat.max(axis=0)]
        return self._append("accessors", accessor)

    def add_animation(self, animation: dict[str, Any]) -> int:
        """Append an animation and return its index; a name already taken gets a number."""
        taken = {found.get("name") for found in self.json.get("animations", [])}
        name, number = animation["name"], 2
        while animation["name"] in taken:
            animation["name"] = f"{name} {number}"
            number += 1
        return self._append("animations", animation)

    def add_root(self, name: str, children: list[int]) -> int:
        """Append a node above some roots, put it into their scenes and return its index."""
        index = self._append("nodes", {"name": name, "children": children})
        for scene in self.json.get("scenes", []):
            listed = scene.get("nodes", [])
            inside = [at for at, node in enumerate(listed) if node in children]
            if inside:
                kept = [node for node in listed if node not in children]
                scene["nodes"] = [*kept[: inside[0]], index, *kept[inside[0] :]]
        return index

    def parts_from_matrix(self, node: int) -> None:
        """Write a node's `matrix` as translation, rotation and scale, so that it can move."""
        fields = self.json["nodes"][node]
        matrix = fields.pop("matrix", None)
        if matrix is None:
            return
        columns = np.array(matrix, np.float64).reshape(1, 4, 4).transpose(0, 2, 1)
        parts = decompose(columns, np.ones(3))
        for key, values in zip(("translation", "rotation", "scale"), parts, strict=True):
            fields[key] = [float(value) for value in values[0]]

    def glb(self) -> bytes:
        """Return the edited document as the bytes of a GLB.

        Raises:
            RigError: it is longer than the 4 GiB that a GLB can hold.
        """
        if self.binary:
            self._align()
            self.json["buffers"][0]["byteLength"] = len(self.binary)
        text = json.dumps(self.json, separators=(",", ":"), allow_nan=False).encode()
        chunks = [(JSON_CHUNK, text + b" " * (-len(text) % 4))]
        if self.binary:
            chunks.append((BINARY_CHUNK, bytes(self.binary)))
        chunks += [
            (kind, content + b"\0" * (-len(content) % 4))
            for kind, content in self.document.other_chunks
        ]
        length = 12 + sum(8 + len(content) for _, content in chunks)
        if length >= 1 << 32:
            raise RigError(f"{self.document.name}: with its walk it is too long for a GLB (4 GiB)")
        parts = [MAGIC + struct.pack("<II", 2, length)]
        for kind, content in chunks:
            parts += [struct.pack("<II", len(content), kind), content]
        return b"".join(parts)

    def _append(self, key: str, item: dict[str, Any]) -> int:
        listed: list[dict[str, Any]] = self.json.setdefault(key, [])
        listed.append(item)
        return len(listed) - 1

    def _align(self) -> None:
        self.binary += b"\0" * (-len(self.binary) % 4)

    def _embed_buffers(self) -> bytes:
        """Make the first buffer the BIN chunk and the others data URIs; return the former."""
        buffers = self.json.setdefault("buffers", [])
        if not buffers:
            buffers.append({"byteLength": 0})
            return self.document.binary
        for buffer, content in zip(buffers[1:], self.document.buffers[1:], strict=True):
            if buffer["uri"][:5].lower() != "data:":
                buffer["uri"] = data_uri(bytes(content), "application/octet-stream")
        if "uri" not in buffers[0]:
            return self.document.binary
        del buffers[0]["uri"]
        # A BIN chunk that no buffer named is kept all the same, behind the first buffer.
        unused = self.document.binary if self.document.has_binary_chunk else b""
        return bytes(self.document.buffers[0]) + unused

    def _embed_images(self) -> None:
        """Make images in outside files data URIs; one that is missing stays as it was."""
        for place, image in zip(
            self.document.root.parts("images"), self.json.get("images", []), strict=True
        ):
            if place.has("uri") and place.text("uri")[:5].lower() != "data:":
                try:
                    content = resolve_uri(place, self.document.folder)
                except RigError:
                    continue
                image["uri"] = data_uri(content, media_type(content))


def data_uri(content: bytes, media: str) -> str:
    """Return bytes as a data URI (RFC 2397)."""
    return f"data:{media};base64,{base64.b64encode(content).decode()}"


def media_type(content: bytes) -> str:
    """Return an image's media type by its first bytes."""
    for start, media in MEDIA_TYPES.items():
        if content.startswith(start):
            return media
    return "application/octet-stream"
