"""Meshes for tests, written as files: what people use as obstacles, and what goes wrong in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Mesh = tuple[FloatArray, NDArray[np.int64]]


def write_obj(path: Path, mesh: Mesh) -> Path:
    corners, faces = mesh
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in corners.tolist()]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces.tolist()]
    path.write_text("\n".join(lines) + "\n")
    return path


def box(least: tuple[float, float, float], most: tuple[float, float, float]) -> Mesh:
    unit = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float64)
    corners = np.array(least) + unit * (np.array(most) - np.array(least))
    return corners, np.array(
        [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
         [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    )  # fmt: skip


def together(*meshes: Mesh) -> Mesh:
    starts = np.cumsum([0, *(len(corners) for corners, _ in meshes)])
    faces = [faces + start for (_, faces), start in zip(meshes, starts, strict=False)]
    return np.concatenate([corners for corners, _ in meshes]), np.concatenate(faces)


def prism(outline: list[tuple[float, float]], height: float) -> Mesh:
    """An outline in x and z, turning from +x toward -z, drawn up along y."""
    count = len(outline)
    corners = [(x, y, z) for y in (0.0, height) for x, z in outline]
    walls = []
    for i in range(count):
        j = (i + 1) % count
        walls += [[i, j, i + count], [j, j + count, i + count]]
    # A fan about a corner from which the whole outline is seen.
    lids = [[0, i + 1, i] for i in range(1, count - 1)]
    lids += [[count, count + i, count + i + 1] for i in range(1, count - 1)]
    return np.array(corners), np.array(walls + lids)


def ell() -> Mesh:
    """An L of 1 m, 0.4 m wide and 0.1 m high; the inner corner is first."""
    outline = [(0.4, 0.4), (0.4, 1.0), (0.0, 1.0), (0.0, 0.0), (1.0, 0.0), (1.0, 0.4)]
    return prism(outline[::-1][-1:] + outline[::-1][:-1], 0.1)


def ring(inner: float, outer: float, height: float, sides: int = 16) -> Mesh:
    angle = 2.0 * np.pi * np.arange(sides) / sides
    rims = [(outer, 0.0), (outer, height), (inner, height), (inner, 0.0)]
    corners = [[r * np.cos(a), y, r * np.sin(a)] for r, y in rims for a in angle]
    faces = []
    for k in range(4):
        for i in range(sides):
            a, b = k * sides + i, k * sides + (i + 1) % sides
            c, d = ((k + 1) % 4) * sides + i, ((k + 1) % 4) * sides + (i + 1) % sides
            faces += [[a, c, b], [b, c, d]]
    return np.array(corners), np.array(faces)


def table() -> Mesh:
    """A top of 0.8 x 0.5 m at 0.35 m on four legs, each a closed box that touches it."""
    legs = [box((x, 0.0, z), (x + 0.05, 0.3, z + 0.05)) for x in (0.0, 0.75) for z in (0.0, 0.45)]
    return together(box((0.0, 0.3, 0.0), (0.8, 0.35, 0.5)), *legs)
