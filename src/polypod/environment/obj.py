"""Triangles out of a Wavefront OBJ file: vertices and faces, and nothing else of it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from polypod.errors import SceneError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

MOST_BYTES = 1 << 30


class ObjReader:
    """Reads one file line by line: vertices first and last, faces turned into triangles."""

    def __init__(self, path: Path):
        self.path = path
        self.vertices: list[tuple[float, float, float]] = []
        self.triangles: list[tuple[int, int, int]] = []
        self.lines: list[int] = []  # of each triangle, for messages

    def read(self) -> FloatArray:
        """Return triangles [T, 3 corners, x y z] in the file's units.

        Faces of more than three corners are taken for convex.

        Raises:
            SceneError: the file cannot be read, a vertex is no three numbers, or a face names a
                vertex that is not there.
        """
        for number, line in _lines(self.path):
            words = line.split()
            if words[:1] == ["v"]:
                self._read_vertex(number, words[1:])
            elif words[:1] == ["f"]:
                self._read_face(number, words[1:])
        if not self.triangles:
            raise SceneError(f"{self.path}: the mesh has no face (a line of f and vertex numbers)")
        triangles = np.array(self.triangles, dtype=np.int64)
        beyond = np.flatnonzero(np.any(triangles >= len(self.vertices), axis=1))
        if len(beyond):
            self._fail(
                self.lines[int(beyond[0])],
                f"the face names vertex {int(triangles[beyond[0]].max()) + 1}, but there are "
                f"{len(self.vertices)}",
            )
        return np.array(self.vertices, dtype=np.float64)[triangles]

    def _fail(self, line: int, text: str) -> NoReturn:
        raise SceneError(f"{self.path}: line {line}: {text}")

    def _read_vertex(self, line: int, words: list[str]) -> None:
        try:
            # What follows is a weight or a colour.
            x, y, z = (float(word) for word in words[:3])
        except ValueError:
            self._fail(line, "a vertex must be three numbers, as in v 0.0 1.0 2.0")
        self.vertices.append((x, y, z))

    def _read_face(self, line: int, words: list[str]) -> None:
        try:
            # A corner is a vertex, then its texture and normal: 3, 3/1, 3//2 or 3/1/2.
            named = [int(word.split("/", 1)[0]) for word in words]
        except ValueError:
            self._fail(line, "a face must be whole numbers of vertices, as in f 1 2 3")
        if len(named) < 3:
            self._fail(line, f"a face must have at least 3 vertices, not {len(named)}")
        # Numbers count from 1, or from -1 back from the vertex read last.
        count = len(self.vertices)
        corners = [index - 1 if index > 0 else count + index for index in named]
        if 0 in named or min(corners) < 0 or max(named) > MOST_BYTES:
            worst = next(i for i, c in zip(named, corners, strict=True) if self._absurd(i, c))
            self._fail(line, f"the face names vertex {worst}, but there are {count} so far")
        for second, third in pairwise(corners[1:]):
            self.triangles.append((corners[0], second, third))
            self.lines.append(line)

    @staticmethod
    def _absurd(index: int, corner: int) -> bool:
        return index == 0 or corner < 0 or index > MOST_BYTES


def _lines(path: Path) -> Iterator[tuple[int, str]]:
    """Yield each line's number and text, with a backslash at its end joining it to the next."""
    try:
        if path.stat().st_size > MOST_BYTES:
            raise SceneError(f"{path}: the mesh is too large; the most is {MOST_BYTES} bytes")
        # Names in a file may be in any encoding; they do not matter here.
        text = path.read_bytes().decode("utf-8", "replace")
    except (OSError, ValueError) as error:
        raise SceneError(f"{path}: no mesh can be read ({error})") from None
    joined = ""
    for number, line in enumerate(text.split("\n"), 1):
        line = line.split("#", 1)[0].rstrip()
        if line.endswith("\\"):
            joined += line[:-1] + " "
            continue
        yield number, joined + line
        joined = ""
