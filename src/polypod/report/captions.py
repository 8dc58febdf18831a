"""Words and scale bars on pictures."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from polypod.report.arrays import FloatArray
from polypod.report.raster import ByteImage

INK = np.array([0.16, 0.17, 0.20])
SIZE, STRONG_SIZE = 15, 18
HALO = (247, 248, 249)


@cache
def _font(size: int) -> Any:
    return ImageFont.load_default(size)


@dataclass(frozen=True)
class Caption:
    """A word at a place in pixels; `anchor` as Pillow names it ("la": left, ascender)."""

    text: str
    left: float
    top: float
    anchor: str = "la"
    strong: bool = False
    colour: FloatArray = field(default_factory=lambda: INK)

    def font(self) -> Any:
        """Return Pillow's font for this caption."""
        return _font(STRONG_SIZE if self.strong else SIZE)

    def width(self) -> float:
        """Return how wide the text is, pixels."""
        return float(self.font().getlength(self.text))


def draw_captions(image: ByteImage, captions: list[Caption]) -> None:
    """Write captions into a picture [height, width, 3], in place."""
    canvas = Image.fromarray(image)
    pen = ImageDraw.Draw(canvas)
    for caption in captions:
        red, green, blue = (round(255.0 * float(part)) for part in caption.colour)
        pen.text(
            (caption.left, caption.top),
            caption.text,
            fill=(red, green, blue),
            font=caption.font(),
            anchor=caption.anchor,
            stroke_width=2,
            stroke_fill=HALO,
        )
    image[:] = np.asarray(canvas)


def scale_bar(image: ByteImage, pixels_per_metre: float) -> None:
    """Draw a bar of a round length at the lower right, in place."""
    height, width = image.shape[:2]
    metres = round_length(min(0.30 * width, 220.0) / pixels_per_metre)
    long = round(metres * pixels_per_metre)
    right, bottom = width - 10, height - 9
    if long < 2 or right - long < 0 or bottom < 6:
        return
    ink = np.round(255.0 * INK).astype(np.uint8)
    image[bottom - 2 : bottom + 1, right - long : right] = ink
    image[bottom - 6 : bottom + 1, [right - long, right - 1]] = ink
    middle = right - 0.5 * long
    draw_captions(image, [Caption(length_text(metres), middle, bottom - 7, anchor="ms")])


def round_length(metres: float) -> float:
    """Return the largest of 1, 2, 5 times a power of ten that is at most `metres`."""
    power = 10.0 ** math.floor(math.log10(metres))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= metres * (1.0 + 1e-9))


def length_text(metres: float) -> str:
    """Return a length in the unit that reads best."""
    if metres >= 1.0:
        return f"{metres:g} m"
    return f"{100.0 * metres:g} cm" if metres >= 0.01 else f"{1000.0 * metres:g} mm"
