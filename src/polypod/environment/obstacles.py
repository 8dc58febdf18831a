"""Obstacles: convex solids that stand in the world, and how to scatter many of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from polypod.environment.convex import (
    FloatArray,
    circle_around,
    hull_planes,
    polygon_around,
    polygon_sides,
    rotation_matrix,
)
from polypod.errors import SceneError, choices

if TYPE_CHECKING:
    from polypod.environment.terrain import Terrain

SHAPES = ("box", "cylinder", "sphere", "hull")
MOST_HULL_POINTS = 48
LARGEST = 1e5  # m: of a coordinate or a size; beyond it positions lose the precision of a footprint
SMALLEST = 1e-6  # m
FASTEST = 100.0  # m/s


@dataclass(frozen=True)
class Obstacle:
    """One convex solid; world metres.

    `size` is along the solid's own axes before `rotation` (unit quaternion x, y, z, w): a cylinder
    stands along y with equal x and z, a sphere has three equal sizes. A hull is the convex hull of
    `points` [N, 3], given from `position` in the solid's own axes. Feet neither step on a
    `forbidden` obstacle nor pass over it.

    It stands still, or moves with a constant `velocity`, m/s, or with `speed`, m/s, to the points
    of its `path` in turn and from the last to where it began, again and again. It does not turn.
    """

    shape: str
    size: tuple[float, float, float]
    position: tuple[float, float, float]
    rotation: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)
    forbidden: bool = False
    name: str = ""
    points: tuple[tuple[float, float, float], ...] = ()
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    path: tuple[tuple[float, float, float], ...] = ()
    speed: float = 0.0

    @property
    def moves(self) -> bool:
        """Whether it moves by itself."""
        return any(self.velocity) or bool(self.path)

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
        if self.shape == "hull" and len(hull_planes(np.array(self.points))) < 4:
            raise SceneError(f"{title} is a hull of points that lie in one plane or on one line")

    def _judge_motion(self, title: str) -> None:
        if not all(abs(v) <= FASTEST for v in self.velocity) or not abs(self.speed) <= FASTEST:
            raise SceneError(
                f"{title} has the velocity {list(self.velocity)} and the speed {self.speed:g}; "
                f"each must be a number of m/s within {FASTEST:g}"
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
        return cls("box", _three(size), _three(position), from_yaw(yaw), forbidden, name)

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
        return cls("sphere", size, _three(position), forbidden=forbidden, name=name)

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
        return cls("cylinder", size, _three(position), (x, y, z, w), forbidden, name)

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
            _three(np.maximum(np.ptp(array, axis=0), SMALLEST)),
            _three(position),
            (x, y, z, w),
            forbidden,
            name,
            tuple(_three(point) for point in array),
        )

    def planes(self) -> FloatArray:
        """Return planes [P, 4] (outward normal, offset; world): of a cylinder, a prism around it.

        A sphere has none.
        """
        matrix = rotation_matrix(self.rotation)
        if self.shape == "sphere":
            return np.zeros((0, 4))
        if self.shape == "hull":
            local = hull_planes(np.array(self.points))
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


def _three(values: Sequence[float] | NDArray[np.float64]) -> tuple[float, float, float]:
    try:
        x, y, z = (float(value) for value in values)
    except (TypeError, ValueError):
        raise SceneError(f"a size or position must be three numbers, not {values!r}") from None
    return (x, y, z)


def scatter(
    terrain: Terrain,
    count: int,
    area: Sequence[float],
    size: Sequence[Sequence[float]],
    seed: int,
    forbidden_share: float = 0.0,
    name: str = "crate",
) -> tuple[Obstacle, ...]:
    """Return `count` boxes at random places and turns, each resting on the terrain.

    Args:
        terrain: what they stand on: a box goes down to the lowest ground under it.
        count: how many.
        area: x0, z0, x1, z1 in metres: where their centres lie.
        size: the least and the greatest size, each x, y, z in metres.
        seed: of the random numbers; the same seed gives the same boxes.
        forbidden_share: share of the boxes, in [0, 1], that are forbidden (rounded to a count).
        name: what comes before the number in each name.

    Raises:
        SceneError: a number is out of range, or the least is above the greatest.
    """
    x0, z0, x1, z1 = (float(value) for value in area)
    least, greatest = np.array(_three(size[0])), np.array(_three(size[1]))
    if count < 0 or not 0.0 <= forbidden_share <= 1.0:
        raise SceneError(
            f"scatter asks for {count} obstacles with a forbidden share of {forbidden_share:g}; "
            "the count must be at least 0 and the share from 0 to 1"
        )
    ordered = x0 <= x1 and z0 <= z1 and bool(np.all(least <= greatest))
    if not ordered or max(abs(x0), abs(x1), abs(z0), abs(z1)) > LARGEST or least.min() < SMALLEST:
        raise SceneError(
            "scatter needs area = [x0, z0, x1, z1] with x0 <= x1 and z0 <= z1, "
            f"and size = [least, greatest] in that order, each at least {SMALLEST:g}"
        )
    random = np.random.default_rng(seed)
    sizes = random.uniform(least, greatest, (count, 3))
    places = random.uniform((x0, z0), (x1, z1), (count, 2))
    yaws = random.uniform(0.0, 2.0 * math.pi, count)
    forbidden = random.permutation(count) < round(forbidden_share * count)
    made = []
    for i in range(count):
        here = (places[i, 0], 0.0, places[i, 1])
        box = Obstacle.box(sizes[i], here, yaws[i], bool(forbidden[i]), f"{name}-{i + 1}")
        height = terrain.lowest_in(box.footprint()) + 0.5 * sizes[i, 1]
        made.append(
            Obstacle.box(sizes[i], (here[0], height, here[2]), yaws[i], box.forbidden, box.name)
        )
    return tuple(made)
