"""Colours of vertices: material, vertex colours and texture, as a screen shows them (sRGB).

Colours are for looking at a creature and never stop a walk: what cannot be read is left out.
"""

from __future__ import annotations

import io
import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from polypod.errors import RigError
from polypod.rigs.accessors import AccessorReader
from polypod.rigs.container import resolve_uri
from polypod.rigs.fields import Place
from polypod.rigs.meshes import Geometry

FloatArray = NDArray[np.float64]

LARGEST_IMAGE = 1 << 26  # pixels; more is taken for an attack, not for a texture
# What glTF may hold. Pillow would hand others, such as PostScript, to programs on this computer.
FORMATS = ("PNG", "JPEG", "WEBP")


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
        texture = material.part("pbrMetallicRoughness").part("baseColorTexture")
        old = material.part("extensions").part("KHR_materials_pbrSpecularGlossiness")
        if old.has("diffuseTexture"):
            texture = old.part("diffuseTexture")
        key = f"TEXCOORD_{texture.integer('texCoord', 0)}"
        attributes = geometry.place.part("attributes")
        textures = self.root.parts("textures")
        index = texture.reference("index", len(textures))
        if index < 0 or not attributes.has(key):
            return np.ones(3)
        pixels = self._image(textures[index].reference("source", len(self.root.parts("images"))))
        places = self.reader.read(attributes.integer(key, below=len(self.reader.accessors)))
        if pixels is None or places.shape != (len(geometry.positions), 2):
            return np.ones(3)
        if places.dtype != np.float64 or not np.isfinite(places).all():
            return np.ones(3)
        height, width = pixels.shape[:2]
        # The usual wrapping: textures repeat.
        column = np.minimum((np.mod(places[:, 0], 1.0) * width).astype(np.int64), width - 1)
        row = np.minimum((np.mod(places[:, 1], 1.0) * height).astype(np.int64), height - 1)
        return linear_from_srgb(pixels[row, column] / 255.0)

    def _image(self, index: int) -> FloatArray | None:
        if index < 0:
            return None
        if index not in self._images:
            self._images[index] = self._decode(self.root.parts("images")[index])
        return self._images[index]

    def _decode(self, place: Place) -> FloatArray | None:
        """Return [height, width, 3] in 0..255, or None where Pillow cannot read the image."""
        view = place.reference("bufferView", len(self.reader.views))
        data = resolve_uri(place, self.folder) if view < 0 else self.reader.view_bytes(view)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                image = Image.open(io.BytesIO(data), formats=FORMATS)
                if image.width * image.height > LARGEST_IMAGE:
                    return None
                return np.asarray(image.convert("RGB"))
        except Exception:  # broken images raise anything in Pillow, and a colour is worth no stop
            return None


def srgb_from_linear(linear: FloatArray) -> FloatArray:
    """Return colours as screens show them from linear ones, clipped to [0, 1] (IEC 61966-2-1)."""
    clipped = np.clip(linear, 0.0, 1.0)
    curved = 1.055 * np.power(clipped, 1.0 / 2.4) - 0.055
    return np.where(clipped <= 0.0031308, 12.92 * clipped, curved)


def linear_from_srgb(srgb: FloatArray) -> FloatArray:
    """Return linear colours from those of an image file (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, np.power((srgb + 0.055) / 1.055, 2.4))
