"""Colours of surfaces: material, vertex colours and texture, as a screen shows them (sRGB).

Colours are for looking at a creature and never stop a walk: what cannot be read is left out.
"""

from __future__ import annotations

import io
import math
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from polypod.errors import RigError
from polypod.rigs.accessors import AccessorReader
from polypod.rigs.container import resolve_uri
from polypod.rigs.fields import Place, finite
from polypod.rigs.meshes import Geometry

FloatArray = NDArray[np.float64]

LARGEST_IMAGE = 1 << 26  # pixels; more is taken for an attack, not for a texture
# What glTF may hold. Pillow would hand others, such as PostScript, to programs on this computer.
FORMATS = ("PNG", "JPEG", "WEBP")
# How a texture goes on beyond its edges, by the numbers of the format.
WRAPS = {10497: "repeat", 33071: "clamp", 33648: "mirror"}
USUAL_CUTOFF = 0.5


@dataclass(frozen=True, eq=False)
class Paint:
    """The picture that covers a surface of V vertices: its colours, times the tint."""

    image: int  # place in the file's list of images
    places: FloatArray  # [V, 2] of vertices on it, from its left upper corner, 1: all of it
    tint: FloatArray  # [V, 3] sRGB
    wrap: tuple[str, str]  # across and down: "repeat", "clamp" or "mirror"
    cutoff: float  # what is less opaque than this is not there; 0: all is there


class ColourReader:
    """Finds colours of primitives; each texture is decoded once."""

    def __init__(self, root: Place, reader: AccessorReader, folder: Path | None):
        self.root = root
        self.reader = reader
        self.folder = folder
        self._images: dict[int, FloatArray | None] = {}

    def vertex_colour(self, geometry: Geometry) -> FloatArray:
        """Return [V, 3] in [0, 1], sRGB."""
        linear = np.ones((len(geometry.positions), 3))
        try:
            linear = linear * self._vertex_factor(geometry)
            material = self._material(geometry.place)
            linear = linear * self._material_factor(material)
            linear = linear * self._texture_factor(geometry, material)
        except RigError:
            pass
        return srgb_from_linear(linear)

    def paint(self, geometry: Geometry) -> Paint | None:
        """Return what picture a primitive is covered with, None where there is none."""
        try:
            material = self._material(geometry.place)
            info = self._texture_info(material)
            textures = self.root.parts("textures")
            index = info.reference("index", len(textures))
            places = None if index < 0 else self._places(geometry, info)
            if places is None:
                return None
            image = _source(textures[index], len(self.root.parts("images")))
            if image < 0:
                return None
            tint = self._vertex_factor(geometry) * self._material_factor(material)
            tint = np.broadcast_to(tint, (len(places), 3))
            wrap = self._wrap(textures[index])
            return Paint(image, places, srgb_from_linear(tint), wrap, _cutoff(material))
        except RigError:
            return None

    def _vertex_factor(self, geometry: Geometry) -> FloatArray:
        attributes = geometry.place.part("attributes")
        if not attributes.has("COLOR_0"):
            return np.ones(3)
        values = self.reader.read(attributes.integer("COLOR_0", below=len(self.reader.accessors)))
        usable = values.ndim == 2 and len(values) == len(geometry.positions)
        if not usable or values.dtype != np.float64 or not np.isfinite(values).all():
            return np.ones(3)
        return values[:, :3]

    def _material(self, primitive: Place) -> Place:
        materials = self.root.parts("materials")
        index = primitive.reference("material", len(materials))
        return materials[index] if index >= 0 else Place(primitive.file, "", {})

    @staticmethod
    def _material_factor(material: Place) -> FloatArray:
        old = material.part("extensions").part("KHR_materials_pbrSpecularGlossiness")
        if old.has("diffuseFactor"):
            return np.array(old.numbers("diffuseFactor", (1.0, 1.0, 1.0, 1.0))[:3])
        metallic = material.part("pbrMetallicRoughness")
        return np.array(metallic.numbers("baseColorFactor", (1.0, 1.0, 1.0, 1.0))[:3])

    def _texture_factor(self, geometry: Geometry, material: Place) -> FloatArray:
        """Return [V, 3] the texture's linear colour at each vertex, or ones."""
        info = self._texture_info(material)
        textures = self.root.parts("textures")
        index = info.reference("index", len(textures))
        places = None if index < 0 else self._places(geometry, info)
        if places is None:
            return np.ones(3)
        pixels = self._image(_source(textures[index], len(self.root.parts("images"))))
        if pixels is None:
            return np.ones(3)
        height, width = pixels.shape[:2]
        # The usual wrapping: textures repeat.
        column = np.minimum((np.mod(places[:, 0], 1.0) * width).astype(np.int64), width - 1)
        row = np.minimum((np.mod(places[:, 1], 1.0) * height).astype(np.int64), height - 1)
        return linear_from_srgb(pixels[row, column] / 255.0)

    @staticmethod
    def _texture_info(material: Place) -> Place:
        old = material.part("extensions").part("KHR_materials_pbrSpecularGlossiness")
        if old.has("diffuseTexture"):
            return old.part("diffuseTexture")
        return material.part("pbrMetallicRoughness").part("baseColorTexture")

    def _places(self, geometry: Geometry, info: Place) -> FloatArray | None:
        """Return [V, 2] where vertices are on their picture, or None where that is not said."""
        moved = info.part("extensions").part("KHR_texture_transform")
        key = f"TEXCOORD_{moved.integer('texCoord', info.integer('texCoord', 0))}"
        attributes = geometry.place.part("attributes")
        if not attributes.has(key):
            return None
        places = self.reader.read(attributes.integer(key, below=len(self.reader.accessors)))
        if places.shape != (len(geometry.positions), 2) or places.dtype != np.float64:
            return None
        if not np.isfinite(places).all():
            return None
        turn = finite(moved.value.get("rotation", 0.0)) or 0.0
        cosine, sine = math.cos(turn), math.sin(turn)
        places = places * moved.numbers("scale", (1.0, 1.0))
        # Counter-clockwise as one sees it: the second axis goes down.
        places = places @ np.array([[cosine, -sine], [sine, cosine]])
        return places + moved.numbers("offset", (0.0, 0.0))

    def _wrap(self, texture: Place) -> tuple[str, str]:
        samplers = self.root.parts("samplers")
        index = texture.reference("sampler", len(samplers))
        if index < 0:
            return "repeat", "repeat"
        across, down = (samplers[index].integer(key, 10497) for key in ("wrapS", "wrapT"))
        return WRAPS.get(across, "repeat"), WRAPS.get(down, "repeat")

    def _image(self, index: int) -> FloatArray | None:
        if index < 0:
            return None
        if index not in self._images:
            self._images[index] = self._decode(self.root.parts("images")[index])
        return self._images[index]

    def _decode(self, place: Place) -> FloatArray | None:
        """Return [height, width, 3] in 0..255, or None where Pillow cannot read the image."""
        data = image_bytes(place, self.reader, self.folder)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                image = Image.open(io.BytesIO(data), formats=FORMATS)
                if image.width * image.height > LARGEST_IMAGE:
                    return None
                return np.asarray(image.convert("RGB"))
        except Exception:  # broken images raise anything in Pillow, and a colour is worth no stop
            return None


def image_bytes(place: Place, reader: AccessorReader, folder: Path | None) -> bytes:
    """Return the bytes of an image of the file, wherever they are.

    Raises:
        RigError: they are in a file that is not there, or reach beyond their buffer.
    """
    view = place.reference("bufferView", len(reader.views))
    return resolve_uri(place, folder) if view < 0 else bytes(reader.view_bytes(view))


def _source(texture: Place, images: int) -> int:
    """Return the image of a texture, -1 where there is none: WebP has a place of its own."""
    newer = texture.part("extensions").part("EXT_texture_webp")
    return (newer if newer.has("source") else texture).reference("source", images)


def _cutoff(material: Place) -> float:
    """Return below which opacity a material is not there; half, where it would shine through."""
    mode = material.text("alphaMode", "OPAQUE")
    if mode == "MASK":
        cutoff = finite(material.value.get("alphaCutoff", USUAL_CUTOFF))
        return USUAL_CUTOFF if cutoff is None else min(max(cutoff, 0.0), 1.0)
    return USUAL_CUTOFF if mode == "BLEND" else 0.0


def srgb_from_linear(linear: FloatArray) -> FloatArray:
    """Return colours as screens show them from linear ones, clipped to [0, 1] (IEC 61966-2-1)."""
    clipped = np.clip(linear, 0.0, 1.0)
    curved = 1.055 * np.power(clipped, 1.0 / 2.4) - 0.055
    return np.where(clipped <= 0.0031308, 12.92 * clipped, curved)


def linear_from_srgb(srgb: FloatArray) -> FloatArray:
    """Return linear colours from those of an image file (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, np.power((srgb + 0.055) / 1.055, 2.4))
