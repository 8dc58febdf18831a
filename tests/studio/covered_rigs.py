"""Creatures with a picture over them, made of the built-in ones."""

from __future__ import annotations

import io
import json
import struct

import numpy as np
from PIL import Image

from polypod.morphology.builtin import build
from rigs.sample_rigs import SampleFile

MAGENTA = (230, 20, 230)


def framed_png(side: int = 32) -> bytes:
    """Return a magenta picture with a white frame."""
    picture = Image.new("RGB", (side, side), (255, 255, 255))
    picture.paste(MAGENTA, (2, 2, side - 2, side - 2))
    content = io.BytesIO()
    picture.save(content, "PNG")
    return content.getvalue()


def covered(creature: str, picture: bytes) -> bytes:
    """Return a built-in creature with a picture on all of it, as a GLB.

    All its vertices are on corners of the picture, which goes on and on: what they see of it is
    its frame, and what lies between them is its inside.
    """
    glb = build(creature).glb
    size = struct.unpack_from("<I", glb, 12)[0]
    sample = SampleFile()
    sample.json = json.loads(glb[20 : 20 + size])
    sample.binary = glb[28 + size :]
    for mesh in sample.json["meshes"]:
        for primitive in mesh["primitives"]:
            attributes = primitive["attributes"]
            count = sample.json["accessors"][attributes["POSITION"]]["count"]
            number = np.arange(count)
            attributes.pop("COLOR_0", None)
            attributes["TEXCOORD_0"] = sample.accessor(np.stack([number % 3, number % 2], axis=1))
            primitive["material"] = 0
    seen = {"baseColorTexture": {"index": 0}, "metallicFactor": 0.0}
    sample.json["materials"] = [{"pbrMetallicRoughness": seen}]
    sample.json["textures"] = [{"source": 0}]
    sample.json["images"] = [{"bufferView": sample.view(picture), "mimeType": "image/png"}]
    return sample.glb()
