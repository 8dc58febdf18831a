"""What the planner sees, for the page to draw: cells, candidates, paths, hulls."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polypod.body.hull import SAMPLES, SLICES
from polypod.environment.grown import (
    KIND_CORNER,
    KIND_EDGE,
    KIND_FORBIDDEN,
    KIND_GROUND,
    KIND_GROWN,
    KIND_INSIDE,
)
from polypod.environment.maps import LocalMap, fill_maps, make_local_map
from polypod.environment.table import surface
from polypod.herd import Herd
from polypod.reference import by_reference
from polypod.report.arrays import FloatArray
from polypod.report.ground import terrain_height
from polypod.studio.arrays import pack_arrays
from polypod.studio.frames import Focus
from polypod.studio.stage import Stage

CELLS = 64  # a side
CELL = 0.07  # leg lengths
ABOVE = 0.004  # leg lengths over the ground, so that they are seen
# P1 Figure 11, with how much they hide: ground is everywhere, what stands on it is looked for.
COLOURS = {
    KIND_GROUND: (242, 160, 192, 90),
    KIND_GROWN: (220, 74, 60, 190),
    KIND_EDGE: (84, 196, 100, 190),
    KIND_CORNER: (242, 217, 78, 190),
    KIND_INSIDE: (79, 124, 232, 190),
    KIND_FORBIDDEN: (32, 32, 32, 210),
}
PIECES = 6  # of a path between two of its knots


class Overlays:
    """Draws what the planner sees about the creature in focus; its own memory, nothing shared."""

    def __init__(self) -> None:
        self._window = make_local_map(CELLS)
        self._kernel_window: LocalMap = by_reference(self._window)

    def of(self, stage: Stage, focus: Focus, wished: frozenset[str]) -> Iterator[tuple[str, bytes]]:
        """Yield the name and the named arrays of each overlay that is wished for."""
        herd = stage.herds[focus.kind]
        makers = {
            "cells": self._cells,
            "candidates": candidates,
            "paths": paths,
            "hull": hull,
        }
        for name, make in makers.items():
            if name in wished:
                yield name, pack_arrays(name, make(stage, herd, focus.creature))

    def _cells(self, stage: Stage, herd: Herd, c: int) -> dict[str, NDArray[Any]]:
        """Return the map's cells about a creature: places [N, 3], side and colours."""
        state, tables = herd.state, herd.tables
        leg, legs = tables.leg_length, herd.morphology.legs
        x, z = float(state.position[c, 0]), float(state.position[c, 2])
        foot_x, foot_z = (float(v) for v in legs.foot_half_size.mean(axis=0)[:2])
        fill_maps(
            stage.world.kernel_environment, self._kernel_window, x, z, CELL * leg, CELLS,
            foot_x, foot_z, float(state.heading[c]), 0.0,
        )  # fmt: skip
        window = self._window
        column, row = np.meshgrid(np.arange(CELLS), np.arange(CELLS))
        place = np.stack(
            [
                window.place[0] + (column + 0.5) * CELL * leg,
                window.highest + ABOVE * leg,
                window.place[1] + (row + 0.5) * CELL * leg,
            ],
            axis=-1,
        )
        palette = np.array([COLOURS[k] for k in sorted(COLOURS)], np.uint8)
        kind = np.where(window.forbidden, KIND_FORBIDDEN, window.kind)
        return {
            "place": place.reshape(-1, 3).astype(np.float32),
            "size": np.full((CELLS * CELLS, 2), CELL * leg, np.float32),
            "colour": palette[kind.ravel()],
        }


def candidates(stage: Stage, herd: Herd, c: int) -> dict[str, NDArray[Any]]:
    """Return the places that were looked at for each foot that swings, or waits for a place.

    Where the first, direct swing was good enough its place is the only one. Their scores [N], best
    1, and the foot [N] that each is of.
    """
    herd.watch(c)
    places, scores, feet = [np.zeros((0, 3))], [np.zeros(0)], [np.zeros(0, np.int64)]
    for foot in np.flatnonzero(herd.state.swinging[c] | (herd.state.waiting[c] > 0.0)):
        place, score = herd.seen(int(foot))
        places.append(place)
        scores.append(score)
        feet.append(np.full(len(place), foot))
    return {
        "place": np.concatenate(places).astype(np.float32),
        "score": np.concatenate(scores).astype(np.float32),
        "foot": np.concatenate(feet).astype(np.uint16),
    }


def paths(stage: Stage, herd: Herd, c: int) -> dict[str, NDArray[Any]]:
    """Return the ways of the swinging feet, in space and on the ground below."""
    state = herd.state
    places: list[FloatArray] = []
    start, feet, plans = [0], [], []
    for foot in np.flatnonzero(state.swinging[c]):
        count = int(state.path.count[c, foot, 0])
        if count < 2:
            continue
        line = sampled(
            state.path.point[c, foot, :count],
            state.path.tangent[c, foot, :count],
            state.path.fraction[c, foot, :count],
        )
        below = line.copy()
        below[:, 1] = terrain_height(stage.world.environment.table, line[:, 0], line[:, 2])
        below[:, 1] += ABOVE * herd.tables.leg_length
        for plan, points in ((0, line), (1, below)):
            places.append(points)
            start.append(start[-1] + len(points))
            feet.append(int(foot))
            plans.append(plan)
    return {
        "place": np.concatenate([*places, np.zeros((0, 3))]).astype(np.float32),
        "start": np.array(start, np.uint32),
        "foot": np.array(feet, np.uint16),
        "plan": np.array(plans, np.uint8),
    }


def sampled(point: FloatArray, tangent: FloatArray, fraction: FloatArray) -> FloatArray:
    """Return points [M, 3] along a Hermite curve through knots [N, 3].

    Tangents are per unit of progress, which is `fraction` [N] at the knots.
    """
    u = np.linspace(0.0, 1.0, PIECES, endpoint=False)[:, None]
    pieces = []
    for i in range(len(point) - 1):
        span = fraction[i + 1] - fraction[i]
        pieces.append(
            (2 * u**3 - 3 * u**2 + 1) * point[i]
            + (u**3 - 2 * u**2 + u) * span * tangent[i]
            + (3 * u**2 - 2 * u**3) * point[i + 1]
            + (u**3 - u**2) * span * tangent[i + 1]
        )
    return np.concatenate([*pieces, point[-1:]])


def hull(stage: Stage, herd: Herd, c: int) -> dict[str, NDArray[Any]]:
    """Return the upper convex hulls of the slices under the body, a line each (P1 3.2, Fig 4b)."""
    body, state = herd.tables.body, herd.state
    sine, cosine = math.sin(state.heading[c]), math.cos(state.heading[c])
    forward = body.box_centre[2] + body.half_size[2] * np.linspace(-1.0, 1.0, SAMPLES)
    places, start = [], [0]
    for i in range(SLICES):
        left = body.box_centre[0] + body.half_size[0] * (2.0 * i / (SLICES - 1) - 1.0)
        x = state.position[c, 0] + forward * sine + left * cosine
        z = state.position[c, 2] + forward * cosine - left * sine
        height = surface_heights(stage, x, z)
        top = upper_hull(forward, height)
        places.append(np.stack([x[top], height[top], z[top]], axis=1))
        start.append(start[-1] + len(top))
    return {
        "place": np.concatenate(places).astype(np.float32),
        "start": np.array(start, np.uint32),
    }


def surface_heights(stage: Stage, x: FloatArray, z: FloatArray) -> FloatArray:
    """Return how high [N] the ground or what stands on it is at places x [N] and z [N], m."""
    environment = stage.world.kernel_environment
    return np.array(
        [surface(environment, float(a), float(b))[0] for a, b in zip(x, z, strict=True)]
    )


def upper_hull(along: FloatArray, height: FloatArray) -> list[int]:
    """Return which points [N], sorted along a slice, its upper convex hull is of."""
    top: list[int] = []
    for i in range(len(along)):
        while len(top) >= 2:
            a, b = top[-2], top[-1]
            turn = (along[b] - along[a]) * (height[i] - height[a])
            if (height[b] - height[a]) * (along[i] - along[a]) > turn:
                break
            top.pop()
        top.append(i)
    return top
