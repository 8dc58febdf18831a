"""The place where creatures walk: a terrain and what stands on it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from polypod.environment.build import build_table
from polypod.environment.obstacles import Obstacle
from polypod.environment.table import EnvironmentTable
from polypod.environment.terrain import Terrain


class Environment:
    """A terrain with obstacles; static.

    `obstacles` are those given, in their order, then the solid parts of the terrain itself (the
    steps of generated stairs): a foot's support is an index into this list, or -1 for the ground.
    """

    def __init__(self, terrain: Terrain | None = None, obstacles: Sequence[Obstacle] = ()) -> None:
        self.terrain = Terrain.flat() if terrain is None else terrain
        self.obstacles: tuple[Obstacle, ...] = (*obstacles, *self.terrain.parts)

    @cached_property
    def table(self) -> EnvironmentTable:
        """What kernels read, made when first asked for."""
        return build_table(self.terrain, self.obstacles)
