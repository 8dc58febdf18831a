"""Named arrays as bytes: skins, ground and overlays for the page (docs/studio-protocol.md)."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

KIND = 2
TYPES = {"f4": np.float32, "u4": np.uint32, "u2": np.uint16, "u1": np.uint8}
ALIGNED = 4


def pack_arrays(name: str, arrays: Mapping[str, NDArray[Any]], **more: object) -> bytes:
    """Return arrays as one message.

    Args:
        name: what they are.
        arrays: of the types float32, uint32, uint16 and uint8.
        more: what else the head is to say, as JSON takes it.
    """
    listed, pieces = [], []
    for key, array in arrays.items():
        kind = next(kind for kind, dtype in TYPES.items() if array.dtype == dtype)
        content = np.ascontiguousarray(array, dtype=np.dtype(TYPES[kind]).newbyteorder("<"))
        listed.append({"name": key, "type": kind, "shape": list(array.shape)})
        pieces.append(_padded(content.tobytes(), b"\0"))
    head = _padded(json.dumps({"name": name, "arrays": listed, **more}).encode(), b" ")
    return b"".join([struct.pack("<II", KIND, len(head)), head, *pieces])


def _padded(content: bytes, filler: bytes) -> bytes:
    return content + filler * (-len(content) % ALIGNED)
