"""The pictures that cover a skin, as the page is sent them: as they are in the file.

The browser decodes them, which has more practice with strangers' pictures than anything here; all
that is read of them is their kind and size.
"""

from __future__ import annotations

import io
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from polypod.errors import RigError
from polypod.report.skin import Flesh
from polypod.rigs.colours import FORMATS, LARGEST_IMAGE
from polypod.rigs.gltf import GltfDocument

Bytes = NDArray[np.uint8]


def cover(
    document: GltfDocument, surfaces: list[Flesh]
) -> tuple[dict[str, NDArray[Any]], list[dict[str, Any]]]:
    """Return what covers the surfaces of a skin that has all of them as one mesh.

    Returns:
        arrays: `uv` f4 [V, 2] where vertices are on their pictures, `tint` [V, 3] what colours of
            pictures are times, sRGB, and `picture0`... u1, the bytes of each; none where there
            are no pictures.
        parts: which triangles have which picture, as the head of the message says it.
    """
    numbers: dict[int, int] = {}  # of images of the file, among those that are sent
    pictures: list[Bytes] = []
    for surface in surfaces:
        if surface.paint is None or surface.paint.image in numbers:
            continue
        content = _picture(document, surface.paint.image)
        numbers[surface.paint.image] = -1 if content is None else len(pictures)
        if content is not None:
            pictures.append(content)
    if not pictures:
        return {}, []
    places, tints = [], []
    parts: list[dict[str, Any]] = []
    first = 0
    for surface in surfaces:
        paint, count = surface.paint, 3 * len(surface.triangles)
        part: dict[str, Any] = {"first": first, "count": count, "picture": None}
        if paint is None or numbers[paint.image] < 0:
            places.append(np.zeros((len(surface.place), 2)))
            tints.append(surface.colour)
        else:
            places.append(paint.places)
            tints.append(paint.tint)
            part |= {"picture": numbers[paint.image], "wrap": paint.wrap, "cutoff": paint.cutoff}
        parts.append(part)
        first += count
    arrays: dict[str, NDArray[Any]] = {f"picture{i}": one for i, one in enumerate(pictures)}
    arrays["uv"] = np.concatenate(places).astype(np.float32)
    arrays["tint"] = np.concatenate(tints)
    return arrays, parts


def _picture(document: GltfDocument, image: int) -> Bytes | None:
    """Return the bytes of an image, None where it is of no kind that we know, or too large."""
    try:
        data = document.image(image)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with Image.open(io.BytesIO(data), formats=FORMATS) as picture:
                fits = picture.width * picture.height <= LARGEST_IMAGE
    except RigError:
        return None
    except Exception:  # broken pictures raise anything in Pillow, and a colour is worth no stop
        return None
    return np.frombuffer(data, np.uint8) if fits else None
