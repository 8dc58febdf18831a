"""The true geometry of a scene, asked about many points at once.

An audit must not share the planner's mistakes: this is written from the shapes themselves and uses
none of the kernels that walks are planned with. A test holds the two against each other.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from polypod.environment.shapes import CYLINDER, SPHERE
from polypod.environment.table import EnvironmentTable, TiledTable
from polypod.report.arrays import FloatArray, conjugate_all, multiply_all, rotate_all
from polypod.report.record import Recording

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]


class Ground:
    """Terrain and obstacles as a walker meets them; world metres.

    Where obstacles moved, each place is asked about with its frame [N], a row of the recording or
    between two; without one they are where the table says.
    """

    def __init__(self, environment: EnvironmentTable, recording: Recording | None = None) -> None:
        """Read the table, and from a recording where its obstacles were, and how turned."""
        self.environment = environment
        self.place: FloatArray | None = None  # [F, O, 3] m
        self.yaw = np.zeros((0, 0))  # [F, O] rad, against how each was made
        self.movers = frozenset(int(environment.owner[i]) for i in environment.movers)
        if recording is not None and self.movers:
            self.place = recording.obstacle_position
            _, first = np.unique(environment.owner, return_index=True)
            made = environment.rotation[first[: self.place.shape[1]]]
            spin = multiply_all(recording.obstacle_rotation, conjugate_all(made))
            # They turn about the vertical only.
            yaw = 2.0 * np.arctan2(spin[..., 1], spin[..., 3])
            self.yaw = np.unwrap(yaw, axis=0)
        self.forbidden_solids = [int(i) for i in np.flatnonzero(environment.forbidden)]
        self.forbidden = frozenset(int(environment.owner[i]) for i in self.forbidden_solids)

    def own_points(self, index: int, points: FloatArray, frame: ArrayLike | None) -> FloatArray:
        """Return points [N, 3] as they lay to the table's rows of a solid in their frames [N]."""
        owner = int(self.environment.owner[index])
        if self.place is None or frame is None or owner not in self.movers:
            return points
        moment = np.asarray(frame, dtype=np.float64)
        row = np.minimum(moment.astype(np.int64), max(len(self.place) - 2, 0))
        after = np.minimum(row + 1, len(self.place) - 1)
        share = moment - row
        place = self.place[row, owner] * (1.0 - share)[:, None]
        place = place + self.place[after, owner] * share[:, None]
        yaw = self.yaw[row, owner] * (1.0 - share) + self.yaw[after, owner] * share
        x, y, z = (points - place).T
        sine, cosine = np.sin(yaw), np.cos(yaw)
        turned = np.stack([x * cosine - z * sine, y, x * sine + z * cosine], axis=1)
        own: FloatArray = self.environment.pivot[owner] + turned
        return own

    def surface(self, x: FloatArray, z: FloatArray, frame: ArrayLike | None = None) -> FloatArray:
        """Return the height [N] of what stands highest over each place of the plan, m."""
        table = self.environment
        highest = terrain_height(table, x, z)
        flat = np.stack([x, np.zeros(len(x)), z], axis=1)
        for index in range(len(table.kind)):
            least, most = table.bounds[index, :3], table.bounds[index, 3:]
            own_x, own_y, own_z = self.own_points(index, flat, frame).T
            near = np.flatnonzero(
                (own_x >= least[0]) & (own_x <= most[0]) & (own_z >= least[2]) & (own_z <= most[2])
            )
            if near.size:
                top = self._top(index, own_x[near], own_z[near]) - own_y[near]
                highest[near] = np.maximum(highest[near], top)
        return highest

    def penetration(self, points: FloatArray, frame: ArrayLike | None = None) -> FloatArray:
        """Return how deep [N] each point [N, 3] is inside the terrain or an obstacle, m.

        In the terrain depth is counted straight up, in an obstacle to its nearest face. 0: outside.
        """
        table = self.environment
        deepest = np.maximum(terrain_height(table, points[:, 0], points[:, 2]) - points[:, 1], 0.0)
        for index in range(len(table.kind)):
            bounds = table.bounds[index]
            own = self.own_points(index, points, frame)
            near = np.flatnonzero(((own >= bounds[:3]) & (own <= bounds[3:])).all(axis=1))
            if near.size:
                deepest[near] = np.maximum(deepest[near], self._depth(index, own[near]))
        return deepest

    def over_forbidden(self, points: FloatArray, frame: ArrayLike | None = None) -> BoolArray:
        """Return which points [N, 3] lie over the plan outline of a forbidden obstacle."""
        table = self.environment
        over = np.zeros(len(points), np.bool_)
        for index in self.forbidden_solids:
            side = table.footprint_side[index, : table.footprint_count[index]]
            own = self.own_points(index, points, frame)
            beyond = own[:, [0, 2]] @ side[:, :2].T - side[:, 2]
            over |= (beyond < 0.0).all(axis=1)
        return over

    def _depth(self, index: int, points: FloatArray) -> FloatArray:
        """Return how deep points [N, 3] are inside one solid; 0 outside."""
        table = self.environment
        offset = points - table.position[index]
        if table.kind[index] == SPHERE:
            gap = table.half_size[index, 0] - np.linalg.norm(offset, axis=1)
        elif table.kind[index] == CYLINDER:
            local = rotate_all(conjugate_all(table.rotation[index]), offset)
            round_gap = table.half_size[index, 0] - np.hypot(local[:, 0], local[:, 2])
            gap = np.minimum(round_gap, table.half_size[index, 1] - np.abs(local[:, 1]))
        else:
            planes = table.planes[index, : table.plane_count[index]]
            gap = (planes[:, 3] - points @ planes[:, :3].T).min(axis=1)
        depth: FloatArray = np.maximum(gap, 0.0)
        return depth

    def _top(self, index: int, x: FloatArray, z: FloatArray) -> FloatArray:
        """Return where vertical lines leave one solid, minus infinity where they miss it."""
        table = self.environment
        if table.kind[index] == SPHERE:
            centre, radius = table.position[index], table.half_size[index, 0]
            square = radius**2 - (x - centre[0]) ** 2 - (z - centre[2]) ** 2
            top = centre[1] + np.sqrt(np.maximum(square, 0.0))
            return np.where(square >= 0.0, top, -np.inf)
        if table.kind[index] == CYLINDER:
            return self._cylinder_top(index, x, z)
        planes = table.planes[index, : table.plane_count[index]]
        room = planes[:, 3] - np.stack([x, z], axis=1) @ planes[:, [0, 2]].T
        return _leave(room, np.broadcast_to(planes[:, 1], room.shape))

    def _cylinder_top(self, index: int, x: FloatArray, z: FloatArray) -> FloatArray:
        """Return where vertical lines leave an upright, leaning or lying cylinder."""
        table = self.environment
        inverse = conjugate_all(table.rotation[index])
        radius, half = table.half_size[index, 0], table.half_size[index, 1]
        start = np.stack([x, np.full(len(x), table.position[index, 1]), z], axis=1)
        origin = rotate_all(inverse, start - table.position[index])
        way = rotate_all(inverse, np.array([0.0, 1.0, 0.0]))
        # Within the round side: a t^2 + 2 b t + c <= 0 along origin + t way.
        a = way[0] ** 2 + way[2] ** 2
        b = origin[:, 0] * way[0] + origin[:, 2] * way[2]
        c = origin[:, 0] ** 2 + origin[:, 2] ** 2 - radius**2
        if a < 1e-18:
            enter, leave = np.where(c <= 0.0, -np.inf, np.inf), np.where(c <= 0.0, np.inf, -np.inf)
        else:
            square = b**2 - a * c
            root = np.sqrt(np.maximum(square, 0.0))
            enter = np.where(square >= 0.0, (-b - root) / a, np.inf)
            leave = np.where(square >= 0.0, (-b + root) / a, -np.inf)
        caps = np.stack([half - origin[:, 1], half + origin[:, 1]], axis=1)
        slope = np.broadcast_to(np.array([way[1], -way[1]]), caps.shape)
        low, high, hit = _interval(caps, slope)
        low, high = np.maximum(low, enter), np.minimum(high, leave)
        return np.where(hit & (low <= high), table.position[index, 1] + high, -np.inf)


def terrain_height(environment: EnvironmentTable, x: FloatArray, z: FloatArray) -> FloatArray:
    """Return the terrain's height [N] over places of the plan: bilinear, level beyond its edges."""
    x0, z0, cell = environment.terrain_place
    u = np.clip((x - x0) / cell, environment.first_column, environment.last_column)
    v = np.clip((z - z0) / cell, environment.first_row, environment.last_row)
    column = np.minimum(np.floor(u).astype(np.int64), environment.last_column - 1)
    row = np.minimum(np.floor(v).astype(np.int64), environment.last_row - 1)
    u, v = u - column, v - row
    near = _samples(environment, row, column) * (1.0 - u)
    near += _samples(environment, row, column + 1) * u
    far = _samples(environment, row + 1, column) * (1.0 - u)
    far += _samples(environment, row + 1, column + 1) * u
    height: FloatArray = near * (1.0 - v) + far * v
    return height


def _samples(environment: EnvironmentTable, row: IntArray, column: IntArray) -> FloatArray:
    """Return the terrain's heights [N] at samples: a tiled one's pages hold only some of them."""
    if isinstance(environment, TiledTable):
        return environment.ground.samples_at(row, column)
    heights: FloatArray = environment.heights[row, column]
    return heights


def _interval(room: FloatArray, slope: FloatArray) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Return the least and greatest t [N] with slope t <= room [N, P] for all P, and if any."""
    with np.errstate(divide="ignore", invalid="ignore"):
        limit: Any = room / slope
    rising, falling = slope > 1e-12, slope < -1e-12
    high = np.where(rising, limit, np.inf).min(axis=1)
    low = np.where(falling, limit, -np.inf).max(axis=1)
    hit = (rising | falling | (room >= 0.0)).all(axis=1) & (low <= high)
    return low, high, hit


def _leave(room: FloatArray, slope: FloatArray) -> FloatArray:
    """Return the greatest height [N] with slope y <= room [N, P] for all P, or -infinity."""
    _, high, hit = _interval(room, slope)
    return np.where(hit, high, -np.inf)
