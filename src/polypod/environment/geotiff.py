"""Elevations out of a GeoTIFF: one band in metres or feet, with square pixels of a stated size.

Numbers of tags and keys are those of the GeoTIFF standard (OGC 19-008r4) and of GDAL.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polypod.environment.heightmaps import (
    MOST_SAMPLES,
    BoolArray,
    FloatArray,
    HeightField,
    filled,
)
from polypod.environment.obstacles import LARGEST, SMALLEST
from polypod.errors import SceneError

PIXEL_SCALE, TRANSFORMATION, KEY_DIRECTORY = 33550, 34264, 34735
GDAL_METADATA, GDAL_NO_DATA = 42112, 42113
TAGS = (PIXEL_SCALE, TRANSFORMATION, KEY_DIRECTORY, GDAL_METADATA, GDAL_NO_DATA)

MODEL_TYPE, GEODETIC, PROJECTED, PLAN_UNIT, HEIGHT_UNIT = 1024, 2048, 3072, 3076, 4099
PLAN_MODEL, USER_MODEL = 1, 32767
# Metres of a unit: the metre, the international foot and the foot of the United States' surveys.
UNITS = {9001: 1.0, 9002: 0.3048, 9003: 1200.0 / 3937.0}
SQUARE = 1e-6  # how much the sides of a pixel may differ, as a share


def read_geotiff(path: str | Path) -> HeightField:
    """Return the elevations of a GeoTIFF.

    The first image counts: its first row, the north, has the least z, and columns lead east along
    +x. Sample [0, 0] is the origin, wherever on Earth it lies. Feet become metres. Samples that
    hold the file's no-data value are unknown.

    Args:
        path: the file.

    Returns:
        Heights and cell in metres.

    Raises:
        SceneError: tifffile is missing; the file cannot be read; its pixels are not square, of no
            stated size or measured in degrees; or it has more than one band or no elevation.
    """
    tifffile = _tifffile(path)
    try:
        with tifffile.TiffFile(path) as file:
            page = file.pages[0]
            tags = {code: page.tags.valueof(code) for code in TAGS}
            _judge_image(path, page)
            cell, unit = _judge_place(path, tags)
            values = page.asarray()
    except SceneError:
        raise
    except Exception as error:  # what a broken file raises is not written down anywhere
        reason = " ".join(str(error).split())
        raise SceneError(f"{path}: no GeoTIFF can be read ({reason})") from None
    unknown = _unknown(path, values, tags[GDAL_NO_DATA])
    if bool(unknown.all()):
        raise SceneError(f"{path}: every sample is marked as no data; there is no ground")
    heights: FloatArray = np.where(unknown, 0.0, values) * unit
    return filled(heights, cell, (0.0, 0.0), unknown)


def _tifffile(path: str | Path) -> ModuleType:
    try:
        import tifffile
    except ImportError:
        raise SceneError(
            f"{path}: to read GeoTIFF, Polypod needs tifffile: pip install tifffile"
        ) from None
    # It remarks on broken files in its log: here they are refused, and one sentence is enough.
    logging.getLogger("tifffile").addHandler(logging.NullHandler())
    module: ModuleType = tifffile
    return module


def _judge_image(path: str | Path, page: Any) -> None:
    """Refuse what is no single band of numbers, before its pixels are read."""
    pixels = int(page.imagelength) * int(page.imagewidth)
    tile = math.prod(int(side) for side in page.chunks)
    if max(pixels, tile) > MOST_SAMPLES:
        raise SceneError(
            f"{path}: {page.imagelength} x {page.imagewidth} pixels in tiles of {tile} are too "
            f"many; the most is {MOST_SAMPLES}"
        )
    if page.samplesperpixel != 1 or page.ndim != 2 or page.dtype is None:
        raise SceneError(
            f"{path}: the image has {page.samplesperpixel} bands; it must be one band of elevations"
        )
    if page.dtype.kind not in "fiu" or pixels == 0:
        raise SceneError(f"{path}: a heightmap must be an array of real numbers")


def _judge_place(path: str | Path, tags: Mapping[int, Any]) -> tuple[float, float]:
    """Return the metres between samples and the metres of a unit of elevation."""
    scale, keys = tags[PIXEL_SCALE], _keys(tags[KEY_DIRECTORY])
    model = keys.get(MODEL_TYPE, PLAN_MODEL if GEODETIC not in keys or PROJECTED in keys else 2)
    if model not in (PLAN_MODEL, USER_MODEL):
        raise SceneError(
            f"{path}: its pixels are measured in degrees, which no walk can use: project it to a "
            "plan in metres, such as UTM (gdalwarp -t_srs)"
        )
    if scale is None:
        turned = tags[TRANSFORMATION] is not None
        said = (
            "places its pixels by a matrix" if turned else "does not say how large its pixels are"
        )
        raise SceneError(
            f"{path}: the file {said}; it must have a ModelPixelScale, with north up (gdalwarp)"
        )
    across, down = float(scale[0]), float(scale[1])
    cell = across * _metres(path, keys, PLAN_UNIT, "plan")
    if not SMALLEST <= cell <= LARGEST:
        raise SceneError(
            f"{path}: its pixels are {cell:g} m wide; it must be from {SMALLEST:g} to {LARGEST:g}"
        )
    if not abs(across - down) <= SQUARE * across:
        raise SceneError(
            f"{path}: its pixels are {across:g} by {down:g}; they must be squares (gdalwarp -tr)"
        )
    metadata = tags[GDAL_METADATA]
    if metadata is not None and ('role="scale"' in str(metadata) or 'role="off' in str(metadata)):
        raise SceneError(
            f"{path}: its elevations are packed with a scale or an offset; unpack them "
            "(gdal_translate -unscale)"
        )
    return cell, _metres(path, keys, HEIGHT_UNIT, "elevation")


def _keys(directory: Any) -> dict[int, int]:
    """Return the geo keys whose value stands in the directory itself: whole numbers."""
    numbers = [] if directory is None else [int(number) for number in directory]
    entries = [numbers[at : at + 4] for at in range(4, len(numbers) - 3, 4)]
    return {key: value for key, place, _, value in entries if place == 0}


def _metres(path: str | Path, keys: Mapping[int, int], key: int, what: str) -> float:
    unit = keys.get(key, 9001)
    if unit not in UNITS:
        raise SceneError(
            f"{path}: its unit of {what} is EPSG {unit}; it must be the metre (9001) or the foot "
            "(9002, 9003)"
        )
    return UNITS[unit]


def _unknown(path: str | Path, values: NDArray[Any], no_data: Any) -> BoolArray:
    """Return the samples that hold the no-data value: text, or a number, or None."""
    if no_data is None:
        return np.zeros(values.shape, dtype=np.bool_)
    try:
        value = float(str(no_data).strip("\0 "))
    except ValueError:
        raise SceneError(f"{path}: its no-data value {no_data!r:.40} is no number") from None
    if math.isnan(value):
        return np.asarray(np.isnan(values))
    with np.errstate(all="ignore"):
        if values.dtype.kind == "f":
            value = float(values.dtype.type(value))  # as the samples themselves were rounded
        if LARGEST < abs(value) < math.inf:
            # Nobody writes all digits of -3.4028234663852886e+38.
            return np.asarray(np.abs(values.astype(np.float64) / value - 1.0) < 1e-5)
        return np.asarray(values == value)
