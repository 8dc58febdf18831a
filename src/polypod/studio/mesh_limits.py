"""What reading a stranger's mesh or ground would take, estimated before it is read.

What is refused here could be read, but no crate and no meadow is like it.
"""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from polypod.environment.heightmaps import read_npy
from polypod.environment.tile_files import NUMBER
from polypod.errors import SceneError, choices
from polypod.studio.rig_limits import judge_upload

LARGEST_FILE = 64 << 20  # bytes
MESHES = (".obj", ".glb", ".gltf")
GROUNDS = (".npy", ".png", ".raw", ".tif", ".tiff")
# Of an OBJ: lines of vertices and faces, and words of them all; a face of so many corners takes
# seconds where it is concave.
MOST_LINES = 400_000
MOST_WORDS = 6_000_000
MOST_CORNERS = 256
MOST_SAMPLES = 16_000_000  # of ground: 128 MB of heights
LINE = re.compile(rb"(?m)^[ \t]*[vf][ \t]")
LONG_FACE = re.compile(rb"(?m)^[ \t]*f(?:[ \t]+[^\s#]+){%d}" % (MOST_CORNERS + 1))


def judge_file(file: Path) -> None:
    """Refuse a file that would take too much to read.

    Args:
        file: a mesh or a ground's heights, in a folder of the studio's.

    Raises:
        SceneError: it is of no kind that scenes name, or too large in some way.
        RigError: the same of a glTF.
    """
    suffix = file.suffix.lower()
    if suffix not in MESHES + GROUNDS:
        raise SceneError(f"{file.name}: scenes name files of {choices(MESHES + GROUNDS)}")
    size = file.stat().st_size
    if size > LARGEST_FILE:
        raise SceneError(f"{file.name}: a file may have {LARGEST_FILE >> 20} MiB, this has more")
    if suffix == ".obj":
        _judge_obj(file)
    elif suffix in MESHES:
        judge_upload(file.read_bytes(), file.name, "mesh")
    else:
        _judge_samples(file, suffix, size)


def _judge_obj(file: Path) -> None:
    data = file.read_bytes()
    words = sum(data.count(space) for space in (b" ", b"\t", b"\n"))
    lines = sum(1 for _ in LINE.finditer(data)) if words <= MOST_WORDS else 0
    for what, count, most in (
        ("words", words, MOST_WORDS),
        ("vertices and faces", lines, MOST_LINES),
    ):
        if count > most:
            raise SceneError(
                f"{file.name}: has {count} {what}; the studio takes meshes with at most {most}"
            )
    if LONG_FACE.search(data):
        raise SceneError(
            f"{file.name}: has a face of more than {MOST_CORNERS} corners; cut it into smaller ones"
        )


def _judge_samples(file: Path, suffix: str, size: int) -> None:
    """Look at how many samples a file says that it has."""
    samples = size
    if suffix == ".npy":
        samples = int(np.prod(read_npy(file).shape, dtype=np.float64))
    elif suffix == ".png":
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                with Image.open(file, formats=("PNG",)) as picture:
                    samples = picture.width * picture.height
        except Image.DecompressionBombError:
            samples = MOST_SAMPLES + 1
        except Exception as error:  # broken pictures raise anything in Pillow
            raise SceneError(f"{file.name}: no picture can be read ({error})") from None
    elif suffix in (".tif", ".tiff"):
        samples = _tiff_samples(file)
    if samples > MOST_SAMPLES:
        raise SceneError(
            f"{file.name}: has more samples than the {MOST_SAMPLES} that the studio takes from a "
            "page; open its scene from where it is: polypod studio SCENE.toml"
        )


def _tiff_samples(file: Path) -> int:
    """Return the pixels of a TIFF's first picture; 0 where it is none, which is refused later."""
    try:
        import tifffile

        with tifffile.TiffFile(file) as found:
            page: Any = found.pages[0]
            return max(int(page.imagelength) * int(page.imagewidth), int(np.prod(page.chunks)))
    except Exception:  # without the library, or broken: who reads it says so
        return 0


def tile_pattern(name: str) -> re.Pattern[str]:
    """Return what names of tiles look like, of a pattern with {column} and {row} in it."""
    word = re.escape(name)
    for key in ("column", "row"):
        word = word.replace(re.escape(f"{{{key}}}"), NUMBER.format(key), 1)
    return re.compile(word)
