"""Ground given by heights at the points of a square lattice, bilinear between them."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


class Lattice(ABC):
    """What every terrain is: columns run along +x, rows along +z.

    `origin` is x, z of sample [0, 0], `cell` the metres between samples. Beyond its edges, if it
    has any, it goes on for ever, level across them.
    """

    cell: float
    origin: tuple[float, float]

    @property
    @abstractmethod
    def edge(self) -> tuple[int, int, int, int]:
        """First row, first column, last row and last column."""

    @property
    @abstractmethod
    def wet(self) -> bool:
        """Whether there is water anywhere."""

    @abstractmethod
    def samples_at(self, row: IntArray, column: IntArray) -> FloatArray:
        """Return the heights [N] of samples [N], m."""

    @abstractmethod
    def wet_at(self, row: IntArray, column: IntArray) -> BoolArray:
        """Return which samples [N] are water."""

    def height_at(self, x: float, z: float) -> float:
        """Return the ground's height in metres, without the terrain's parts."""
        return float(self.heights_at(np.array([[x, z]]))[0])

    def heights_at(self, points: FloatArray) -> FloatArray:
        """Return the ground's heights [N] at plan points [N, 2] (x, z)."""
        first_row, first_column, last_row, last_column = self.edge
        u = np.clip((points[:, 0] - self.origin[0]) / self.cell, first_column, last_column)
        v = np.clip((points[:, 1] - self.origin[1]) / self.cell, first_row, last_row)
        i, j = np.floor(v).astype(np.int64), np.floor(u).astype(np.int64)
        below, right = np.minimum(i + 1, last_row), np.minimum(j + 1, last_column)
        u, v = u - j, v - i
        first = self.samples_at(i, j) * (1 - u) + self.samples_at(i, right) * u
        second = self.samples_at(below, j) * (1 - u) + self.samples_at(below, right) * u
        return np.asarray(first * (1 - v) + second * v)

    def lowest_in(self, corners: FloatArray) -> float:
        """Return the lowest ground in a convex polygon [V, 2] (x, z), turning from +x toward +z.

        Between samples the ground is straight along x and along z, so it is lowest at a sample or
        on the outline; a straight line meets it in parabolas between the sample lines.
        """
        ends = np.roll(corners, -1, axis=0)
        lowest = min(self._lowest_along(a, b) for a, b in zip(corners, ends, strict=True))
        first_row, first_column, last_row, last_column = self.edge
        first = np.ceil((corners.min(axis=0) - self.origin) / self.cell)
        first = np.maximum(first, (first_column, first_row))
        last = np.floor((corners.max(axis=0) - self.origin) / self.cell)
        last = np.minimum(last, (last_column, last_row))
        axes = np.arange(first[0], last[0] + 1), np.arange(first[1], last[1] + 1)
        samples = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2).astype(np.int64)
        place = samples * self.cell + self.origin
        along = ends - corners
        left = (place[:, None, 1] - corners[:, 1]) * along[:, 0]
        left -= (place[:, None, 0] - corners[:, 0]) * along[:, 1]
        within = samples[np.all(left >= 0.0, axis=1)]
        found = self.samples_at(within[:, 1], within[:, 0])
        return min(lowest, float(np.min(found, initial=np.inf)))

    def _lowest_along(self, start: FloatArray, end: FloatArray) -> float:
        """Return the lowest ground on a straight line in plan."""
        times: list[NDArray[Any]] = [np.array([0.0, 1.0])]
        first_row, first_column, last_row, last_column = self.edge
        edges = ((first_column, last_column), (first_row, last_row))
        for axis, (least, most) in enumerate(edges):
            one, other = sorted((start[axis], end[axis]))
            if other > one:
                first = math.ceil(max((one - self.origin[axis]) / self.cell, least))
                last = math.floor(min((other - self.origin[axis]) / self.cell, most))
                lines = np.arange(first, last + 1) * self.cell + self.origin[axis]
                times.append((lines - start[axis]) / (end[axis] - start[axis]))
        knots = np.unique(np.clip(np.concatenate(times), 0.0, 1.0))
        middles = 0.5 * (knots[:-1] + knots[1:])
        at_knots = self.heights_at(start + knots[:, None] * (end - start))
        at_middles = self.heights_at(start + middles[:, None] * (end - start))
        # height(s) = c + b s + a s^2 for s from 0 to 1 in each stretch.
        a = 2.0 * (at_knots[:-1] + at_knots[1:] - 2.0 * at_middles)
        b = at_knots[1:] - at_knots[:-1] - a
        valley = (a > 0.0) & (b < 0.0) & (-b < 2.0 * a)
        bottom = at_knots[:-1][valley] - b[valley] ** 2 / (4.0 * a[valley])
        return float(np.min(np.concatenate([at_knots, at_middles, bottom])))
