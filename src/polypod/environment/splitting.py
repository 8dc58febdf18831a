"""A closed surface becomes convex solids: its pieces as they are, or split by the library coacd.

Each connected piece of the surface is a solid. A convex one is its own hull; a concave one is split
into parts whose hulls together are nearly it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from polypod.environment.convex_parts import COARSEST, FINEST, convex_parts
from polypod.environment.hulls import hull_triangles
from polypod.environment.obstacles import LARGEST, MOST_HULL_POINTS, SMALLEST
from polypod.environment.triangles import read_triangles
from polypod.environment.welding import WELD, close_holes, facing_out, open_edges, pieces, weld
from polypod.errors import SceneError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

MOST_PARTS = 256
CONVEX = 1e-5  # of the extent: farther from a hull nothing of a convex surface lies
CORNER = 1e-4  # of the extent: a corner that stands out by less is left out
AT_ONCE = 1 << 22  # heights of points over faces in one array


@dataclass(frozen=True, kw_only=True)
class Split:
    """How a mesh becomes convex parts.

    `concavity` is how deep a part may be hollow beneath its hull, in half extents of the mesh, from
    0.01 (fine) to 1 (coarse). Where that takes more than `most_parts` it is raised until it does
    not. Each part has at most `most_corners`, the farthest first. `close` puts lids on holes in the
    surface; without it a surface with holes is refused.
    """

    concavity: float = 0.05
    most_parts: int = 32
    most_corners: int = 64
    close: bool = False

    def __post_init__(self) -> None:
        """Judge the numbers; raise SceneError."""
        if not FINEST <= self.concavity <= COARSEST:
            raise SceneError(
                f"concavity = {self.concavity:g} must be from {FINEST:g} to {COARSEST:g}"
            )
        if not 1 <= self.most_parts <= MOST_PARTS:
            raise SceneError(f"most_parts = {self.most_parts} must be from 1 to {MOST_PARTS}")
        if not 4 <= self.most_corners <= MOST_HULL_POINTS:
            raise SceneError(
                f"most_corners = {self.most_corners} must be from 4 to {MOST_HULL_POINTS}"
            )


def mesh_parts(
    path: Path, size: tuple[float, float, float] | None, split: Split
) -> tuple[list[FloatArray], FloatArray]:
    """Return the corners [N, 3] of the convex parts of a mesh file's solid, and its extent [3].

    Args:
        path: an .obj, .glb or .gltf file.
        size: what its box is scaled to, m; None: the file's units are metres.
        split: how finely.

    Returns:
        Metres from the centre of the mesh's box. The same file gives the same parts.

    Raises:
        SceneError: it cannot be read, its surface is open or flat, has too many pieces or faces, or
            it is concave and coacd is missing or fails.
    """
    triangles = read_triangles(path)
    if not len(triangles):
        raise SceneError(f"{path}: the mesh has no triangles")
    least = triangles.reshape(-1, 3).min(axis=0)
    extent = triangles.reshape(-1, 3).max(axis=0) - least
    if not float(extent.min()) >= SMALLEST:
        raise SceneError(f"{path}: the mesh is flat: it bounds no solid")
    wanted = extent if size is None else np.array(size)
    if not float(wanted.max()) <= LARGEST:
        raise SceneError(f"{path}: the mesh is larger than {LARGEST:g} m")
    scaled = (triangles - least - 0.5 * extent) * (wanted / extent)
    corners, faces = weld(scaled)
    solids = [closed(path, corners, piece, split.close) for piece in pieces(faces)]
    if len(solids) > split.most_parts:
        raise SceneError(
            f"{path}: its surface has {len(solids)} separate pieces, and most_parts is "
            f"{split.most_parts}; join them in the file, or raise most_parts"
        )
    parts: list[FloatArray] = []
    for number, (points, piece) in enumerate(solids):
        left = split.most_parts - len(parts) - (len(solids) - number - 1)
        hulls = [points]
        if not is_convex(points, piece):
            hulls = convex_parts(path, points, piece, split.concavity, left)
        for hull in hulls:
            kept = np.unique(hull_triangles(hull, split.most_corners, CORNER))
            # What is as thin as a sheet of paper carries nothing.
            if len(kept):
                parts.append(hull[kept])
    if not parts:
        raise SceneError(f"{path}: the mesh is flat: it bounds no solid")
    return parts, wanted


def closed(
    path: Path, corners: FloatArray, faces: IntArray, close: bool
) -> tuple[FloatArray, IntArray]:
    """Return a piece's own corners [N, 3] and its faces [T, 3], with lids where it is open."""
    used, faces = np.unique(faces, return_inverse=True)
    points, faces = corners[used], faces.reshape(-1, 3)
    edges = open_edges(faces)
    if len(edges) and not close:
        x, y, z = points[edges[0]].mean(axis=0)
        raise SceneError(
            f"{path}: its surface is open: {len(edges)} edges have only one face, one of them "
            f"{x:.4g}, {y:.4g}, {z:.4g} m from the middle; close it in the file, or say "
            "close = true to have lids put on its holes"
        )
    if len(edges):
        points, faces = close_holes(points, faces, edges)
    return points, facing_out(points, faces)


def is_convex(points: FloatArray, faces: IntArray) -> bool:
    """Say whether every face of a closed surface has all of it on one side."""
    extent = float(np.ptp(points, axis=0).max())
    a, b, c = (points[faces[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    size = np.linalg.norm(normal, axis=1)
    real = size > (WELD * extent) ** 2
    normal, a = normal[real] / size[real, None], a[real]
    step = max(1, AT_ONCE // len(points))
    for start in range(0, len(normal), step):
        some = slice(start, start + step)
        height = normal[some] @ points.T - np.sum(normal[some] * a[some], axis=1)[:, None]
        one_side = np.minimum(height.max(axis=1), -height.min(axis=1))
        if not bool(np.all(one_side <= CONVEX * extent)):
            return False
    return True
