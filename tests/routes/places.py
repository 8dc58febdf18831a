"""Places to find a way through, in leg lengths of the creature, and ways found in them."""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from polypod.config import Settings
from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.environment.terrain import Terrain
from polypod.herd import Herd
from polypod.morphology.load import load_rig
from polypod.routes.way import keep_ways


class Way(NamedTuple):
    """A way in leg lengths: from the start over corners to its end."""

    points: np.ndarray  # [P, 2] x, z
    ends: bool  # it ends before the goal
    leg: float  # m

    @property
    def length(self) -> float:
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())

    def crossing(self, z: float) -> float:
        """Return the x at which the way first crosses a z."""
        for (x0, z0), (x1, z1) in zip(self.points[:-1], self.points[1:], strict=True):
            if (z0 - z) * (z1 - z) <= 0.0 and z0 != z1:
                return float(x0 + (x1 - x0) * (z - z0) / (z1 - z0))
        raise AssertionError(f"the way does not cross z = {z}: {self.points}")


@cache
def herd_of(rig: str) -> Herd:
    """Return a herd of one for looking, not for walking."""
    return Herd(load_rig(rig), 1, Settings())


def leg_of(rig: str) -> float:
    return herd_of(rig).tables.leg_length


def box(leg, x0, z0, x1, z1, height=2.0, forbidden=False):
    """Return a box on the ground between two corners in plan, leg lengths."""
    size = (abs(x1 - x0) * leg, height * leg, abs(z1 - z0) * leg)
    centre = (0.5 * (x0 + x1) * leg, 0.5 * height * leg, 0.5 * (z0 + z1) * leg)
    return Obstacle("box", size, centre, forbidden=forbidden)


def find(
    place: Environment, goal, start=(0.0, 0.0), rig="spider", level=0.0, herd: Herd | None = None
) -> Way:
    """Return the way from a start to a goal, leg lengths, from ground of height `level`, m."""
    herd = herd or herd_of(rig)
    leg = herd.tables.leg_length
    state = herd.state
    state.position[0] = (start[0] * leg, level + herd.tables.body.height, start[1] * leg)
    state.plane_height[0] = level
    state.waypoint[0] = 0
    state.route.waypoint[0] = -1
    herd.command.set_path([(goal[0] * leg, goal[1] * leg)], 0)
    keep_ways(
        0, 1, 1.0 / 30.0, herd.kernel_state, herd.kernel_command, herd.kernel_tables,
        herd.kernel_settings, place.kernel_table, herd.kernel_plan, herd.scratch(0),
    )  # fmt: skip
    corners = state.route.corner_place[0, : state.route.corner_count[0]] / leg
    ends = bool(state.route.ends[0])
    points = [np.array([start]), corners] + ([] if ends else [np.array([goal])])
    return Way(np.concatenate(points), ends, leg)


def trap(leg: float, forbidden: bool) -> Environment:
    """Return a dead end: three walls open toward the start; the goal is behind it, at (0, 7)."""
    walls = ((-2, 4, 2, 4.3), (-2.2, 1.2, -1.9, 4.3), (1.9, 1.2, 2.2, 4.3))
    return Environment(obstacles=[box(leg, *wall, forbidden=forbidden) for wall in walls])


def maze(leg: float, forbidden: bool) -> Environment:
    """Return three walls across a walled strip, open on one side in turn; it begins at z = 0."""
    walls = (
        (-5.5, 2.4, 2.5, 2.7),
        (-2.5, 4.4, 5.5, 4.7),
        (-5.5, 6.4, 2.5, 6.7),
        (-5.8, -3, -5.5, 8),
        (5.5, -3, 5.8, 8),
        (-5.8, -3.3, 5.8, -3),
    )
    return Environment(obstacles=[box(leg, *wall, forbidden=forbidden) for wall in walls])


def river(leg: float, dry: float, wet: bool) -> Environment:
    """Return a winding river across the way, or a chasm, with a ford at x = 4 (leg lengths)."""
    samples, cell = 240, 0.1 * leg
    at = (np.arange(samples) - samples / 2) * cell
    x, z = np.meshgrid(at, at + 4.0 * leg)
    bed = np.abs(z / leg - 4.0 - 0.8 * np.sin(x / leg / 1.5)) < 1.0
    bed &= np.abs(x / leg - 4.0) > 0.5 * dry
    heights = np.zeros(bed.shape) if wet else np.where(bed, -2.0 * leg, 0.0)
    origin = (float(at[0]), float(at[0] + 4.0 * leg))
    return Environment(Terrain(heights, cell, origin, bed if wet else None))


def trench(leg: float, width: float, bridge: bool) -> Environment:
    """Return banks a leg high with a trench between them at z = 3, and maybe a bridge at x = 4."""
    banks = [box(leg, -7, -6, 7, 3, 1.0), box(leg, -7, 3 + width, 7, 12, 1.0)]
    if bridge:
        banks.append(box(leg, 3.3, 3, 4.7, 3 + width, 1.0))
    return Environment(obstacles=banks)


def distance_to_box(points: np.ndarray, obstacle: Obstacle, leg: float) -> np.ndarray:
    """Return the distance in plan of points [N, 2] to a box along the axes; leg lengths."""
    centre = np.array(obstacle.position)[[0, 2]] / leg
    half = 0.5 * np.array(obstacle.size)[[0, 2]] / leg
    return np.linalg.norm(np.maximum(np.abs(points - centre) - half, 0.0), axis=1)


def samples(way: Way, spacing: float = 0.02) -> np.ndarray:
    """Return points [N, 2] along a way."""
    parts = []
    for a, b in zip(way.points[:-1], way.points[1:], strict=True):
        steps = max(2, math.ceil(float(np.linalg.norm(b - a)) / spacing))
        parts.append(a + (b - a) * np.linspace(0.0, 1.0, steps)[:, None])
    return np.concatenate(parts) if parts else way.points
