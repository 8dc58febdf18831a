"""The environment as kernels read it, and exact questions about it.

These queries use the true shapes and not the maps' cells, so that planners and audits agree on what
is inside and what is not. Everything is 2.5-dimensional where it concerns standing: what stands
highest over a point of the plan is the surface there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

GROUND = -1  # the support of a foot that stands on the terrain

BOX = 0  # also every convex hull: described by its planes
SPHERE = 1
CYLINDER = 2


class EnvironmentTable(NamedTuple):
    """Terrain and O obstacles in world metres; P planes and V corners are padded to the most.

    A vertical line meets only the obstacles listed in its bucket: bucket [r, c] of the plan holds
    `bucket_item[bucket_start[r * C + c] : bucket_start[r * C + c + 1]]`, in rising order.
    """

    heights: FloatArray  # [rows, columns] m; rows run along +z, columns along +x
    terrain_place: FloatArray  # [3] x and z of sample [0, 0], metres between samples
    terrain_range: FloatArray  # [2] m: the lowest and the highest sample
    water: BoolArray  # [rows, columns] no foot may stand here; [0, 0] where there is no water
    kind: IntArray  # [O] BOX, SPHERE or CYLINDER
    position: FloatArray  # [O, 3] centre
    rotation: FloatArray  # [O, 4] x, y, z, w
    half_size: FloatArray  # [O, 3]
    forbidden: BoolArray  # [O]
    planes: FloatArray  # [O, P, 4] outward normal n and offset d: inside where n . p <= d
    plane_count: IntArray  # [O] of a cylinder: a prism around it; of a sphere: 0
    footprint: FloatArray  # [O, V, 2] x, z: convex corners in plan, circumscribed for round shapes
    footprint_side: FloatArray  # [O, V, 3] outward normal x, z and offset of the side from corner v
    footprint_count: IntArray  # [O]
    bounds: FloatArray  # [O, 6] least x, y, z, then greatest x, y, z
    bucket_place: FloatArray  # [3] x and z of the corner of bucket [0, 0], side of a bucket, m
    bucket_shape: IntArray  # [2] rows (along z), columns (along x)
    bucket_start: IntArray  # [rows * columns + 1]
    bucket_item: IntArray  # [items] obstacle indices
    bucket_range: IntArray  # [O, 4] first row, first column, last row, last column (inclusive)
