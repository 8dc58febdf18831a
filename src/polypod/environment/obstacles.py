"""Obstacles: solids that stand or move in the world, convex or of convex parts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from polypod.environment.convex import (
    FloatArray,
    circle_around,
    polygon_around,
    polygon_sides,
    rotation_matrix,
)
from polypod.environment.hulls import hull_planes
from polypod.errors import SceneError, choices

if TYPE_CHECKING:
    from polypod.environment.splitting import Split

SHAPES = ("box", "cylinder", "sphere", "hull", "mesh")
MOST_HULL_POINTS = 128
LARGEST = 1e5  # m: of a coordinate or a size; beyond it positions lose the precision of a footprint
SMALLEST = 1e-6  # m
FASTEST = 100.0  # m/s
FASTEST_TURN = 100.0  # rad/s

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Obstacle:
    """One solid; world metres.

    `size` is along the solid's own axes before `rotation` (unit quaternion x, y, z, w): a cylinder
    stands along y with equal x and z, a sphere has three equal sizes. A hull is the convex hull of
    `points` [N, 3], given from `position` in the solid's own axes. A mesh is of `parts`, each the
    points of a convex hull, and is one thing to whoever stands on it or moves it; `mesh` makes it
    of a file. Feet neither step on a `forbidden` obstacle nor pass over it.

    It stands still, or moves with a constant `velocity`, m/s, or with `speed`, m/s, to the points
    of its `path` in turn and from the last to where it began, again and again. Meanwhile it turns
    about the vertical through its position by `turn_rate`, rad/s from +Z toward +X.
    """

    shape: str
    size: Point
    position: Point
    rotation: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)
    forbidden: bool = False
    name: str = ""
    points: tuple[Point, ...] = ()
    velocity: Point = (0.0, 0.0, 0.0)
    path: tuple[Point, ...] = ()
    speed: float = 0.0
    turn_rate: float = 0.0
    parts: tuple[tuple[Point, ...], ...] = ()

    @property
    def moves(self) -> bool:
        """Whether it moves by itself."""
        return any(self.velocity) or bool(self.path) or self.turn_rate != 0.0

    def __post_init__(self) -> None:
        """Judge the numbers; raise SceneError."""
        title = f"obstacle {self.name!r}" if self.name else "an obstacle"
        if self.shape not in SHAPES:
            raise SceneError(
                f"{title} has the shape {self.shape!r}; the shapes are {choices(SHAPES)}"
            )
        if not all(SMALLEST <= s <= LARGEST for s in self.size):
            raise SceneError(
                f"{title} has the size {list(self.size)}; "
                f"each must be a number of metres from {SMALLEST:g} to {LARGEST:g}"
            )
        if not all(abs(p) <= LARGEST for p in self.position):
            raise SceneError(
                f"{title} has the position {list(self.position)}; "
                f"each coordinate must be a number of metres within {LARGEST:g} of the origin"
            )
        length = math.sqrt(sum(q * q for q in self.rotation))
        if not abs(length - 1.0) < 1e-3:
            raise SceneError(
                f"{title} has the rotation {list(self.rotation)}; "
                "it must be a quaternion x, y, z, w of length 1"
            )
        object.__setattr__(self, "rotation", tuple(q / length for q in self.rotation))
        x, y, z = self.size
        if self.shape == "cylinder" and x != z:
            raise SceneError(
                f"{title} is a cylinder with size x {x:g} and z {z:g}: make them equal"
            )
        if self.shape == "sphere" and not x == y == z:
            raise SceneError(
                f"{title} is a sphere with size {list(self.size)}: make the three equal"
            )
        self._judge_motion(title)
        if self.shape == "hull" and len(self._hull_planes) < 4:
            raise SceneError(f"{title} is a hull of points that lie in one plane or on one line")
        if (self.shape == "mesh") != bool(self.parts):
            raise SceneError(f"{title}: a mesh has parts, and nothing else has; see Obstacle.mesh")
        self.solids()  # each judges itself

    def _judge_motion(self, title: str) -> None:
        if not all(abs(v) <= FASTEST for v in self.velocity) or not abs(self.speed) <= FASTEST:
            raise SceneError(
                f"{title} has the velocity {list(self.velocity)} and the speed {self.speed:g}; "
                f"each must be a number of m/s within {FASTEST:g}"
            )
        if not abs(self.turn_rate) <= FASTEST_TURN:
            raise SceneError(
                f"{title} has the turn_rate {self.turn_rate:g}; "
                f"it must be a number of rad/s within {FASTEST_TURN:g}"
            )
        if self.path and (any(self.velocity) or not self.speed > 0.0):
            raise SceneError(
                f"{title} has a path: give it a speed above 0 with it, and no velocity"
            )
        if self.speed and not self.path:
            raise SceneError(f"{title} has a speed without a path; give it a path or a velocity")
        if not all(abs(p) <= LARGEST for point in self.path for p in point):
            raise SceneError(f"{title} has a path that is not within {LARGEST:g} m of the origin")

    @classmethod
    def box(
        cls,
        size: Sequence[float],
        position: Sequence[float],
        yaw: float = 0.0,
        forbidden: bool = False,
        name: str = "",
    ) -> Obstacle:
        """Return a box, turned by `yaw` radians about +Y from +Z toward +X."""
        return cls(
            "box", three_numbers(size), three_numbers(position), from_yaw(yaw), forbidden, name
        )

    @classmethod
    def sphere(
        cls,
        diameter: float,
        position: Sequence[float],
        forbidden: bool = False,
        name: str = "",
    ) -> Obstacle:
        """Return a ball of `diameter` metres."""
        size = (diameter, diameter, diameter)
        return cls("sphere", size, three_numbers(position), forbidden=forbidden, name=name)

    @classmethod
    def cylinder(
        cls,
        diameter: float,
        height: float,
        position: Sequence[float],
        rotation: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
        forbidden: bool = False,
        name: str = "",
    ) -> Obstacle:
        """Return a cylinder along its own y."""
        x, y, z, w = (float(q) for q in rotation)
        size = (diameter, height, diameter)
        return cls("cylinder", size, three_numbers(position), (x, y, z, w), forbidden, name)

    @classmethod
    def hull(
        cls,
        points: Sequence[Sequence[float]] | FloatArray,
        position: Sequence[float],
        rotation: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
        forbidden: bool = False,
        name: str = "",
    ) -> Obstacle:
        """Return the convex hull of `points` [N, 3]; raise SceneError for too few or too many."""
        array = np.asarray(points, dtype=np.float64)
        title = f"hull {name!r}" if name else "a hull"
        if array.ndim != 2 or array.shape[1] != 3 or not 4 <= len(array) <= MOST_HULL_POINTS:
            raise SceneError(f"{title} needs 4 to {MOST_HULL_POINTS} points of three numbers each")
        if not np.all(np.isfinite(array)) or np.max(np.abs(array)) > LARGEST:
            raise SceneError(f"{title} has a point that is not within {LARGEST:g} m")
        x, y, z, w = (float(q) for q in rotation)
        return cls(
            "hull",
            _extent(array),
            three_numbers(position),
            (x, y, z, w),
            forbidden,
            name,
            tuple(three_numbers(point) for point in array),
        )

    @classmethod
    def mesh(
        cls,
        path: str | Path,
        position: Sequence[float],
        rotation: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
        forbidden: bool = False,
        name: str = "",
        *,
        size: Sequence[float] | None = None,
        split: Split | None = None,
    ) -> Obstacle:
        """Return the solid that an .obj, .glb or .gltf file's surface bounds, as convex parts.

        Args:
            path: the file, y up.
            position: of the centre of the mesh's box.
            rotation: unit quaternion x, y, z, w.
            forbidden: whether feet must keep off it.
            name: of the obstacle.
            size: what the mesh's box is scaled to; omitted: the file's units are metres.
            split: how finely it is split into parts.

        Raises:
            SceneError: the file cannot be read or has an open surface, or splitting it takes the
                library coacd and that is not installed.
        """
        from polypod.environment.splitting import Split, mesh_parts

        wanted = None if size is None else three_numbers(size)
        parts, extent = mesh_parts(Path(path), wanted, split or Split())
        x, y, z, w = (float(q) for q in rotation)
        return cls(
            "mesh",
            three_numbers(extent),
            three_numbers(position),
            (x, y, z, w),
            forbidden,
            name,
            parts=tuple(tuple(three_numbers(point) for point in part) for part in parts),
        )

    def solids(self) -> tuple[Obstacle, ...]:
        """Return the convex solids of which it is: itself, or a hull for each part of a mesh."""
        if self.shape != "mesh":
            return (self,)
        return tuple(
            replace(self, shape="hull", size=_extent(np.array(part)), points=part, parts=())
            for part in self.parts
        )

    @cached_property
    def _hull_planes(self) -> FloatArray:
        return hull_planes(np.array(self.points))

    def planes(self) -> FloatArray:
        """Return planes [P, 4] (outward normal, offset; world): of a cylinder, a prism around it.

        A sphere has none.
        """
        matrix = rotation_matrix(self.rotation)
        if self.shape == "sphere":
            return np.zeros((0, 4))
        if self.shape == "hull":
            local = self._hull_planes
        else:
            half = 0.5 * np.array(self.size)
            caps = np.array([[0.0, 1.0, 0.0, half[1]], [0.0, -1.0, 0.0, half[1]]])
            if self.shape == "box":
                side = polygon_sides(half[[0, 2]] * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]))
            else:
                side = polygon_sides(circle_around(half[0]))
            upright = np.column_stack([side[:, 0], np.zeros(len(side)), side[:, 1], side[:, 2]])
            local = np.concatenate([upright, caps])
        normal = local[:, :3] @ matrix.T
        normal[np.abs(normal) < 1e-15] = 0.0
        return np.column_stack([normal, local[:, 3] + normal @ np.array(self.position)])

    def corners(self) -> FloatArray:
        """Return points [N, 3] in the world whose hull is the solid, or encloses a round one."""
        half = 0.5 * np.array(self.size)
        if self.shape == "hull":
            local = np.array(self.points)
        elif self.shape == "box":
            local = half * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        else:
            ring = circle_around(half[0])
            level = np.repeat([half[1], -half[1]], len(ring))
            local = np.column_stack([np.tile(ring[:, 0], 2), level, np.tile(ring[:, 1], 2)])
        return np.asarray(local @ rotation_matrix(self.rotation).T + np.array(self.position))

    def footprint(self) -> FloatArray:
        """Return the convex outline [V, 2] (x, z) in plan; around a round one."""
        return polygon_around(self.corners()[:, [0, 2]])


def from_yaw(yaw: float) -> tuple[float, float, float, float]:
    """Return the turn about +Y from +Z toward +X as a quaternion x, y, z, w."""
    return (0.0, math.sin(0.5 * yaw), 0.0, math.cos(0.5 * yaw))


def _extent(points: FloatArray) -> Point:
    return three_numbers(np.maximum(np.ptp(points, axis=0), SMALLEST))


def three_numbers(values: Sequence[float] | NDArray[np.float64]) -> Point:
    """Return a size or a position; raise SceneError."""
    try:
        x, y, z = (float(value) for value in values)
    except (TypeError, ValueError):
        raise SceneError(f"a size or position must be three numbers, not {values!r}") from None
    return (x, y, z)
