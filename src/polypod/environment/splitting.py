"""A closed surface becomes convex solids: its pieces as they are, or split by the library coacd.

Each connected piece of the surface is a solid. A convex one is its own hull; a concave one is split
into parts whose hulls together are nearly it.
"""

from __future__ import annotations

import io
import os
import subprocess
import sys
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from polypod.environment.hulls import hull_triangles
from polypod.environment.obstacles import LARGEST, MOST_HULL_POINTS, SMALLEST
from polypod.environment.triangles import read_triangles
from polypod.environment.welding import WELD, close_holes, facing_out, open_edges, pieces, weld
from polypod.errors import SceneError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

MOST_PARTS = 256
MOST_FACES = 200_000  # of a concave piece: splitting more takes many minutes
FINEST, COARSEST = 0.01, 1.0
COARSER = 1.5  # where there are too many parts, so many times as much concavity is allowed
CONVEX = 1e-5  # of the extent: farther from a hull nothing of a convex surface lies
CORNER = 1e-4  # of the extent: a corner that stands out by less is left out
SPLIT_SECONDS = 600.0
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
        hulls = (
            [points] if is_convex(points, piece) else convex_parts(path, points, piece, split, left)
        )
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


def convex_parts(
    path: Path, points: FloatArray, faces: IntArray, split: Split, most: int
) -> list[FloatArray]:
    """Return the corners [N, 3] of at most `most` convex parts of a concave piece.

    The library runs in a process of its own: on surfaces that it cannot deal with it may end the
    process that it runs in.
    """
    if find_spec("coacd") is None:
        raise SceneError(
            f"{path}: the mesh is concave, and splitting it takes coacd: pip install coacd, or "
            "Polypod's extra meshes"
        )
    if len(faces) > MOST_FACES:
        raise SceneError(
            f"{path}: a concave piece has {len(faces)} faces; simplify it to {MOST_FACES} or fewer"
        )
    concavity = split.concavity
    while True:
        parts = _run_coacd(path, points, faces, concavity)
        if len(parts) <= most:
            return parts
        if concavity >= COARSEST:
            raise SceneError(
                f"{path}: the mesh takes {len(parts)} convex parts even at the coarsest concavity, "
                f"where most_parts leaves {most}; raise most_parts"
            )
        concavity = min(COARSER * concavity, COARSEST)


def _run_coacd(
    path: Path, points: FloatArray, faces: IntArray, concavity: float
) -> list[FloatArray]:
    given = io.BytesIO()
    np.savez(given, points=points, faces=faces.astype(np.int32), concavity=np.array(concavity))
    # Its threads wait asleep: awake they took ten times as long on a busy machine.
    surroundings = {**os.environ, "OMP_WAIT_POLICY": "passive"}
    # Without its folder before others on the path: it imports nothing of ours.
    command = [sys.executable, "-P", str(Path(__file__).with_name("split_alone.py"))]
    try:
        done = subprocess.run(
            command,
            input=given.getvalue(),
            capture_output=True,
            timeout=SPLIT_SECONDS,
            check=True,
            env=surroundings,
        )
        with np.load(io.BytesIO(done.stdout), allow_pickle=False) as made:
            parts = [np.asarray(made[name], np.float64) for name in sorted(made.files)]
    except (subprocess.SubprocessError, OSError, ValueError) as error:
        words = "took too long" if isinstance(error, subprocess.TimeoutExpired) else "failed"
        raise SceneError(
            f"{path}: splitting the mesh into convex parts {words}; simplify the mesh, or raise "
            "concavity"
        ) from None
    if not parts:
        raise SceneError(f"{path}: coacd found no solid in the mesh")
    return parts
