"""Triangles out of a Wavefront OBJ file: vertices and faces, and nothing else of it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from polypod.environment.polygons import triangulate
from polypod.errors import SceneError

FloatArray = NDArray[np.float64]

MOST_BYTES = 1 << 28  # read into some times as much memory
MOST_CORNERS = 4096  # of a face


class ObjReader:
    """Reads one file line by line: first all vertices and faces, then the faces' triangles."""

    def __init__(self, path: Path):
        """Prepare to read a file; `read` reads it."""
        self.path = path
        self._vertices: list[tuple[float, float, float]] = []
        # By their number of corners: each face's vertices, from 0, and its line.
        self._faces: dict[int, list[list[int]]] = {}
        self._lines: dict[int, list[int]] = {}

    def read(self) -> FloatArray:
        """Return triangles [T, 3 corners, x y z] in the file's units.

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
        if not self._faces:
            raise SceneError(f"{self.path}: the mesh has no face (a line of f and vertex numbers)")
        vertices = np.array(self._vertices, dtype=np.float64).reshape(-1, 3)
        found = []
        for corner_count, listed in self._faces.items():
            faces = np.array(listed, dtype=np.int64)
            beyond = np.flatnonzero(np.any(faces >= len(vertices), axis=1))
            if len(beyond):
                self._fail(
                    self._lines[corner_count][int(beyond[0])],
                    f"the face names vertex {int(faces[beyond[0]].max()) + 1}, but there are "
                    f"{len(vertices)}",
                )
            corners = vertices[faces]
            with np.errstate(all="ignore"):  # who asked for it refuses what is no number
                triangles = triangulate(corners).reshape(len(faces), -1, 1)
            found.append(np.take_along_axis(corners, triangles, axis=1).reshape(-1, 3, 3))
        return np.concatenate(found)

    def _fail(self, line: int, text: str) -> NoReturn:
        raise SceneError(f"{self.path}: line {line}: {text}")

    def _read_vertex(self, line: int, words: list[str]) -> None:
        try:
            # What follows is a weight or a colour.
            x, y, z = (float(word) for word in words[:3])
        except ValueError:
            self._fail(line, "a vertex must be three numbers, as in v 0.0 1.0 2.0")
        self._vertices.append((x, y, z))

    def _read_face(self, line: int, words: list[str]) -> None:
        try:
            # A corner is a vertex, then its texture and normal: 3, 3/1, 3//2 or 3/1/2.
            named = [int(word.split("/", 1)[0]) for word in words]
        except ValueError:
            self._fail(line, "a face must be whole numbers of vertices, as in f 1 2 3")
        if not 3 <= len(named) <= MOST_CORNERS:
            self._fail(line, f"a face must have 3 to {MOST_CORNERS} vertices, not {len(named)}")
        # Numbers count from 1, or from -1 back from the vertex read last.
        count = len(self._vertices)
        for index in named:
            if index == 0 or not -count <= index <= MOST_BYTES:
                self._fail(line, f"the face names vertex {index}, but there are {count} so far")
        corners = [index - 1 if index > 0 else count + index for index in named]
        self._faces.setdefault(len(named), []).append(corners)
        self._lines.setdefault(len(named), []).append(line)


def _lines(path: Path) -> Iterator[tuple[int, str]]:
    """Yield each line's number and text, with a backslash at its end joining it to the next."""
    joined = ""
    try:
        if path.stat().st_size > MOST_BYTES:
            raise SceneError(f"{path}: the mesh is too large; the most is {MOST_BYTES} bytes")
        # Names in a file may be in any encoding; they do not matter here.
        with path.open(encoding="utf-8", errors="replace") as lines:
            for number, line in enumerate(lines, 1):
                words = line.split("#", 1)[0].rstrip()
                if words.endswith("\\"):
                    joined += words[:-1] + " "
                    continue
                yield number, joined + words
                joined = ""
    except (OSError, ValueError) as error:
        raise SceneError(f"{path}: no mesh can be read ({error})") from None
