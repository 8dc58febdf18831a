"""The surface of a mesh as the page draws it."""

from __future__ import annotations

import numpy as np

from polypod.report.arrays import FloatArray
from polypod.studio.arrays import pack_arrays

# Edges between faces that turn by more than this are sharp.
CREASE = np.cos(np.radians(35.0))
WELD = 1e-6  # of the extent: corners nearer to each other are one


def pack_mesh(triangles: FloatArray) -> bytes:
    """Return triangles [T, 3 corners, x y z] as named arrays, their box of size 1 about 0.

    Each corner has a normal of its own: the mean of the faces about it, or the face's where that
    is another way.
    """
    points = triangles.reshape(-1, 3)
    least, most = points.min(axis=0), points.max(axis=0)
    extent = np.maximum(most - least, 1e-12)
    steps = np.round((points - least) / (WELD * float(extent.max()))).astype(np.int64)
    _, corner = np.unique(steps, axis=0, return_inverse=True)
    corner = corner.reshape(-1)
    face = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    mean = np.zeros((int(corner.max(initial=-1)) + 1, 3))
    for axis in range(3):
        mean[:, axis] = np.bincount(corner, np.repeat(face[:, axis], 3), len(mean))
    own = np.repeat(_unit(face), 3, axis=0)
    smooth = _unit(mean)[corner]
    normal = np.where(np.sum(own * smooth, axis=1, keepdims=True) < CREASE, own, smooth)
    place = (points - 0.5 * (least + most)) / extent
    # Normals of the box of size 1, as its places are.
    normal = _unit(normal * extent)
    return pack_arrays(
        "mesh",
        {"place": place.astype(np.float32), "normal": normal.astype(np.float32)},
        size=[float(v) for v in extent],
    )


def _unit(vectors: FloatArray) -> FloatArray:
    size = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.where(size > 0.0, vectors / np.where(size > 0.0, size, 1.0), [0.0, 1.0, 0.0])
