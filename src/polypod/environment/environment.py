"""The place where creatures walk: a terrain and what stands or moves on it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from polypod.environment.build import build_table
from polypod.environment.motion import make_tracks, move_obstacles
from polypod.environment.obstacles import FASTEST_TURN, LARGEST, Obstacle
from polypod.environment.paging import Pager
from polypod.environment.table import EnvironmentTable, FloatArray, TiledTable
from polypod.environment.terrain import Terrain
from polypod.environment.tiled import TiledTerrain
from polypod.errors import SceneError
from polypod.reference import by_reference


class Environment:
    """A terrain with obstacles.

    `obstacles` are those given, in their order, then the solid parts of the terrain itself (the
    steps of generated stairs): a foot's support is an index into this list, or -1 for the ground.
    With `movable` any obstacle may be moved by `move`; otherwise only those move that say so.
    """

    def __init__(
        self,
        terrain: Terrain | TiledTerrain | None = None,
        obstacles: Sequence[Obstacle] = (),
        *,
        movable: bool = False,
    ) -> None:
        self.terrain = Terrain.flat() if terrain is None else terrain
        self.obstacles: tuple[Obstacle, ...] = (*obstacles, *self.terrain.parts)
        self.movable = movable and len(self.obstacles) > 0
        self._tracks = make_tracks(self.obstacles)
        self._kernel_tracks = by_reference(self._tracks)
        self._moved: dict[int, np.ndarray[Any, np.dtype[np.float64]]] = {}

    @cached_property
    def table(self) -> EnvironmentTable:
        """What kernels read, made when first asked for."""
        table = build_table(self.terrain, self.obstacles, self.movable)
        if self.changes:
            move_obstacles(by_reference(table), self._kernel_tracks, 0.0)
        if not isinstance(self.terrain, TiledTerrain):
            return table
        tiled = TiledTable(*table)
        tiled.ground = self.terrain
        return tiled

    @cached_property
    def kernel_table(self) -> EnvironmentTable:
        """The table by reference, as kernels take it."""
        return by_reference(EnvironmentTable(*self.table))

    @cached_property
    def pager(self) -> Pager | None:
        """What keeps the tiles of a tiled terrain; None for others."""
        return Pager(self.terrain, self.table) if isinstance(self.terrain, TiledTerrain) else None

    def load_ground(self, places: FloatArray, reach: FloatArray) -> None:
        """Have the ground within reach [N] of places [N, 2] (x, z) in memory, m.

        `World` does so for its creatures in each frame. Whoever asks kernels about a tiled terrain
        by itself must do it too; of others all is there always.

        Raises:
            SceneError: so much does not fit into the terrain's memory.
        """
        if self.pager is not None:
            self.pager.load(places, reach)

    @property
    def changes(self) -> bool:
        """Whether anything moves or may be moved."""
        return len(self._tracks.obstacle) > 0 or self.movable

    def move(
        self,
        index: int,
        position: ArrayLike,
        velocity: ArrayLike = (0.0, 0.0, 0.0),
        *,
        turned: float | None = None,
        turn_rate: float = 0.0,
    ) -> None:
        """Put an obstacle's position elsewhere, m; it is there from the next step on.

        Args:
            index: of the obstacle.
            position: where it is put, m.
            velocity: what creatures then expect of it, m/s.
            turned: how far it is turned about the vertical through its position against how it was
                made, rad from +Z toward +X; omitted: as it is now.
            turn_rate: what creatures then expect of its turn, rad/s.

        Raises:
            SceneError: no such obstacle, one that moves by itself, or numbers that cannot be used;
                the environment was not made `movable`.
        """
        if not self.movable:
            raise SceneError("nothing here can be moved: make the Environment with movable=True")
        if not 0 <= index < len(self.obstacles) or index in self._tracks.obstacle:
            raise SceneError(
                f"obstacle {index} cannot be moved; it must be one of the "
                f"{len(self.obstacles)} that are here, and not move by itself"
            )
        place, speed = np.asarray(position, np.float64), np.asarray(velocity, np.float64)
        for value in (place, speed):
            if value.shape != (3,) or not np.all(np.abs(value) <= LARGEST):
                raise SceneError(
                    f"an obstacle is moved to {position!r} at {velocity!r}; each must be three "
                    f"numbers within {LARGEST:g}"
                )
        before = self._moved[index][3] if index in self._moved else 0.0
        yaw = before if turned is None else turned
        if not (abs(yaw) <= LARGEST and abs(turn_rate) <= FASTEST_TURN):
            raise SceneError(
                f"an obstacle is turned by {turned!r} rad at {turn_rate!r} rad/s; these must be "
                f"numbers within {LARGEST:g} and {FASTEST_TURN:g}"
            )
        shift = place - np.array(self.obstacles[index].position)
        self._moved[index] = np.array([*shift, yaw])
        self.table.velocity[index] = speed
        self.table.yaw_rate[index] = turn_rate

    def advance(self, time: float) -> None:
        """Put everything that moves where it is at a time, seconds from the start."""
        if not self.changes:
            return
        table = self.table
        np.negative(table.shift, out=table.step)
        np.negative(table.yaw, out=table.yaw_step)
        for index, moved in self._moved.items():
            table.shift[index] = moved[:3]
            table.yaw[index] = moved[3]
        move_obstacles(self.kernel_table, self._kernel_tracks, time)
        table.step[:] += table.shift
        table.yaw_step[:] += table.yaw

    @property
    def rotations(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """The obstacles' present turns [O, 4], x, y, z, w."""
        made = np.array([o.rotation for o in self.obstacles], np.float64).reshape(-1, 4)
        half = 0.5 * self.table.yaw
        sine, cosine = np.sin(half), np.cos(half)
        x, y, z, w = made.T
        # The turn about the vertical comes after the one it was made with.
        spun = (cosine * x + sine * z, cosine * y + sine * w, cosine * z - sine * x,
                cosine * w - sine * y)  # fmt: skip
        return np.where((half == 0.0)[:, None], made, np.stack(spun, axis=1))

    def places(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """Return the present positions of all obstacles [O, 3], m."""
        return np.array(self.table.pivot + self.table.shift)
