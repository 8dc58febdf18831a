"""Takes a glTF file apart into its JSON, its buffers and its chunks (glTF 2.0, section 4.4)."""

from __future__ import annotations

import base64
import binascii
import json
import math
import struct
import urllib.parse
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from polypod.errors import RigError
from polypod.rigs.fields import Place, shown

MAGIC = b"glTF"
JSON_CHUNK = 0x4E4F534A
BINARY_CHUNK = 0x004E4942
UNREADABLE = (
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
)


@dataclass(frozen=True)
class Container:
    """The parts of a file, none of them interpreted."""

    json: dict[str, Any]
    binary: bytes | None  # the BIN chunk, None where there is none
    other_chunks: tuple[tuple[int, bytes], ...]  # type and content of chunks we do not know


def split(data: bytes, name: str) -> Container:
    """Take GLB or .gltf bytes apart.

    Raises:
        RigError: neither of the two, truncated, wrong lengths, or bad JSON.
    """
    if data[:4] == MAGIC:
        return _split_glb(data, name)
    start = data[:64].lstrip(b"\xef\xbb\xbf \t\r\n")
    if not start.startswith(b"{"):
        raise RigError(f"{name}: is not a glTF file (.glb or .gltf)")
    return Container(_parse_json(data, name), None, ())


def _split_glb(data: bytes, name: str) -> Container:
    if len(data) < 20:
        raise RigError(f"{name}: is truncated: a GLB has at least 20 bytes, this {len(data)}")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise RigError(f"{name}: is GLB version {version}, but only version 2 can be read")
    if length != len(data):
        fault = "is truncated" if length > len(data) else "has a wrong length"
        raise RigError(f"{name}: {fault}: its header says {length} bytes, it has {len(data)}")
    chunks: list[tuple[int, bytes]] = []
    at = 12
    while at < length:
        size, kind = struct.unpack_from("<II", data, at) if at + 8 <= length else (length, 0)
        if at + 8 + size > length:
            raise RigError(f"{name}: the chunk at byte {at} is longer than the file")
        chunks.append((kind, data[at + 8 : at + 8 + size]))
        at += 8 + size
    if chunks[0][0] != JSON_CHUNK:
        raise RigError(f"{name}: the first chunk is not JSON")
    binaries = [content for kind, content in chunks[1:] if kind == BINARY_CHUNK]
    others = tuple(chunk for chunk in chunks[1:] if chunk[0] != BINARY_CHUNK)
    if len(binaries) > 1:
        raise RigError(f"{name}: has {len(binaries)} BIN chunks, but may have one")
    binary = binaries[0] if binaries else None
    return Container(_parse_json(chunks[0][1], name), binary, others)


def _parse_json(text: bytes, name: str) -> dict[str, Any]:
    def refuse(constant: str) -> NoReturn:
        raise ValueError(f"{constant} is not allowed")

    def number(digits: str) -> float:
        value = float(digits)
        return value if math.isfinite(value) else refuse(digits)

    try:
        parsed = json.loads(text.decode("utf-8-sig"), parse_constant=refuse, parse_float=number)
    except (ValueError, RecursionError) as fault:
        raise RigError(f"{name}: its JSON cannot be parsed: {str(fault)[:120]}") from None
    if not isinstance(parsed, dict):
        raise RigError(f"{name}: its JSON must be an object")
    check_header(Place(name, "", parsed))
    return parsed


def check_header(root: Place) -> None:
    """Refuse other versions and extensions without which the geometry cannot be read.

    Raises:
        RigError: no or another version, or a required extension that is not readable.
    """
    version = root.part("asset").text("version")
    if not version.startswith("2."):
        raise root.error(f"must be a version 2, not {shown(version)}", "asset.version")
    for extension in root.texts("extensionsRequired"):
        if extension in UNREADABLE:
            raise root.error(
                f"names {extension}, which Polypod cannot read: save the file without compression",
                "extensionsRequired",
            )


def load_buffers(
    root: Place, binary: bytes | None, folder: Path | None
) -> tuple[bytes | memoryview, ...]:
    """Return the content of each buffer, at least as long as its byteLength.

    Raises:
        RigError: a buffer is too short, its file is missing or outside the rig's folder.
    """
    buffers = []
    for index, place in enumerate(root.parts("buffers")):
        length = place.integer("byteLength")
        if place.has("uri"):
            content = resolve_uri(place, folder)[:length]
        elif index == 0 and binary is not None:
            content = binary
        else:
            raise place.error("has no uri and there is no BIN chunk for it")
        if len(content) < length:
            raise place.error(f"says {length} bytes, but only {len(content)} are there")
        buffers.append(content)
    return tuple(buffers)


def resolve_uri(place: Place, folder: Path | None) -> bytes:
    """Return the bytes behind a `uri`: a data URI, or a file below the rig's own folder.

    Raises:
        RigError: bad base64, another scheme, a missing file, or one outside of the folder.
    """
    uri = place.text("uri")
    if uri[:5].lower() == "data:":
        return _decode_data_uri(place, uri)
    path = outside_file(place, uri, folder)
    try:
        return path.read_bytes()
    except OSError as fault:
        raise place.error(
            f"names {shown(uri)}, which cannot be read: {fault.strerror}", "uri"
        ) from None


def _decode_data_uri(place: Place, uri: str) -> bytes:
    header, comma, body = uri.partition(",")
    if not comma:
        raise place.error("is a data URI without a comma", "uri")
    if not header.lower().endswith(";base64"):
        return urllib.parse.unquote_to_bytes(body)
    try:
        return base64.b64decode(urllib.parse.unquote_to_bytes(body), validate=True)
    except binascii.Error:
        raise place.error("is a data URI with bad base64", "uri") from None


def outside_file(place: Place, uri: str, folder: Path | None) -> Path:
    """Return the path of an outside file, which must be in the rig's folder or below it.

    Raises:
        RigError: another scheme, no such file, or one outside of the folder.
    """
    if folder is None:
        raise place.error(
            f"names the outside file {shown(uri)}, but there is no folder to look in", "uri"
        )
    relative = urllib.parse.unquote(uri)
    if "\0" in relative or "://" in relative:
        raise place.error(f"names {shown(uri)}, but only files beside the rig can be read", "uri")
    try:
        path = (folder / relative).resolve()
        inside = path.is_relative_to(folder.resolve())
        present = inside and path.is_file()
    except (OSError, ValueError):  # such as a name that is too long
        inside, present = True, False
    if not inside:
        raise place.error(f"names {shown(uri)}, which lies outside of the rig's folder", "uri")
    if not present:
        raise place.error(f"names {shown(uri)}, which is not in {folder}", "uri")
    return path
