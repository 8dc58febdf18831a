"""Heights out of files of samples: .npy, grey pictures, bare numbers.

All of them are judged before they are read, so that a file that promises too much costs no memory.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from polypod.environment.obstacles import LARGEST
from polypod.errors import SceneError, choices

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

MOST_SAMPLES = 64_000_000  # 512 MB of heights
# Grey modes of pictures and their white.
PICTURES = {"1": 1.0, "L": 255.0, "I;16": 65535.0, "I;16B": 65535.0, "I": 65535.0}
# Numbers of a file without a header, and how NumPy calls them; without a word, the low byte first.
FORMATS = {
    "uint8": "u1",
    "uint16": "<u2",
    "uint16-big": ">u2",
    "float32": "<f4",
    "float32-big": ">f4",
}


class HeightField(NamedTuple):
    """What a file says of the ground, in metres: rows along +z, columns along +x."""

    heights: FloatArray  # [rows, columns]
    cell: float
    origin: tuple[float, float]  # x, z of sample [0, 0]
    unknown: BoolArray  # [rows, columns] the file says nothing here; the height is the lowest


def filled(
    heights: FloatArray, cell: float, origin: tuple[float, float], unknown: BoolArray
) -> HeightField:
    """Return a height field whose unknown samples lie at the lowest known height.

    At least one sample must be known; what unknown ones held is of no matter.
    """
    lowest = float(np.min(heights, where=~unknown, initial=np.inf))
    return HeightField(np.where(unknown, lowest, heights), cell, origin, unknown)


def read_npy(path: str | Path) -> NDArray[Any]:
    """Return an array of real numbers of a .npy file; raise SceneError."""
    try:
        # Mapped, so that a header that promises too much costs no memory.
        heights = np.load(path, mmap_mode="r", allow_pickle=False)
    except Exception as error:  # what a broken file raises is not written down anywhere
        raise SceneError(f"{path}: no .npy heightmap can be read ({error})") from None
    if not isinstance(heights, np.ndarray) or heights.dtype.kind not in "fiu":
        raise SceneError(f"{path}: a heightmap must be an array of real numbers")
    return heights


def read_grey(path: str | Path) -> FloatArray:
    """Return a grey picture's values [rows, columns] from 0 (black) to 1 (white)."""
    try:
        with Image.open(path) as picture:
            mode, pixels = picture.mode, picture.size[0] * picture.size[1]
            values = np.asarray(picture, dtype=np.float64) if mode in PICTURES else None
    except Exception as error:  # what a broken file raises is not written down anywhere
        raise SceneError(f"{path}: no picture can be read ({error})") from None
    if values is None or pixels > MOST_SAMPLES:
        raise SceneError(
            f"{path}: the picture has mode {mode} and {pixels} pixels; "
            f"it must be grey, of 8 or 16 bits, with at most {MOST_SAMPLES} pixels"
        )
    return values / PICTURES[mode]


def read_raw(
    path: str | Path,
    format: str,
    relief: float | None = None,
    rows: int | None = None,
    columns: int | None = None,
) -> FloatArray:
    """Return the heights in metres of a file that holds samples, row by row, and nothing else.

    Args:
        path: the file.
        format: what a sample is, one of `FORMATS`.
        relief: metres from 0 to the greatest whole number, which whole numbers need; of
            floats, metres of 1.0, and where omitted they are metres themselves.
        rows: of samples; where omitted, as many as there are, and a square without either.
        columns: samples of a row.

    Returns:
        Heights [rows, columns].

    Raises:
        SceneError: the file cannot be read, or its size is not that of such samples.
    """
    if format not in FORMATS:
        raise SceneError(f"{path}: format = {format!r} must be one of {choices(FORMATS)}")
    kind = np.dtype(FORMATS[format])
    if relief is None and kind.kind == "u":
        raise SceneError(f"{path}: {format} needs relief: the metres from 0 to {_white(kind):g}")
    relief = judged_relief(path, 1.0 if relief is None else relief)
    try:
        size = Path(path).stat().st_size
        shape = _raw_shape(path, format, size, rows, columns)
        values = np.fromfile(path, dtype=kind, count=shape[0] * shape[1])
    except (OSError, ValueError) as error:
        raise SceneError(f"{path}: no raw heightmap can be read ({error})") from None
    if len(values) != shape[0] * shape[1]:  # cut while it was read
        raise SceneError(f"{path}: no raw heightmap can be read (it ends too early)")
    with np.errstate(all="ignore"):  # what is no number is refused by the terrain
        return np.asarray(values.reshape(shape) * (relief / _white(kind)), dtype=np.float64)


def judged_relief(path: str | Path, relief: float) -> float:
    """Return a relief in metres; raise SceneError where it is none."""
    if not 0.0 <= relief <= LARGEST:
        raise SceneError(f"{path}: relief = {relief:g} must be metres from 0 to {LARGEST:g}")
    return relief


def _white(kind: np.dtype[Any]) -> float:
    return float(np.iinfo(kind).max) if kind.kind == "u" else 1.0


def _raw_shape(
    path: str | Path, format: str, size: int, rows: int | None, columns: int | None
) -> tuple[int, int]:
    """Return rows and columns of a file of `size` bytes; raise SceneError where none fit."""
    for name, number in (("rows", rows), ("columns", columns)):
        if number is not None and not 1 <= number <= MOST_SAMPLES:
            raise SceneError(f"{path}: {name} = {number} must be from 1 to {MOST_SAMPLES}")
    count, rest = divmod(size, np.dtype(FORMATS[format]).itemsize)
    if count > MOST_SAMPLES:
        raise SceneError(
            f"{path}: {count} samples of {format} are too many, at most {MOST_SAMPLES}"
        )
    held = f"{path}: {size} bytes are "
    if count == 0 or rest:
        raise SceneError(f"{held}no whole number of samples of {format}; choose another format")
    if rows is None and columns is None:
        rows = columns = math.isqrt(count)
        if rows * columns != count:
            raise SceneError(f"{held}{count} samples of {format}, no square: say rows or columns")
    rows = count // (columns or 1) if rows is None else rows
    columns = count // rows if columns is None and rows <= count else (columns or 1)
    if rows * columns != count:
        raise SceneError(f"{held}{count} samples of {format}, not {rows} rows of {columns}")
    return rows, columns
