"""How the legs are arranged around the body: left and right, rows, partners."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# A leg nearer to the middle plane than this part of the legs' span is neither left nor right.
MIDDLE = 0.04


class Layout(NamedTuple):
    """Sides, rows and partners of K legs; see `LegTable`."""

    side: IntArray  # [K] +1 left, -1 right, 0 middle
    row: IntArray  # [K] 0 hindmost
    partner: IntArray  # [K] the leg across the body, -1 for none


def arrange(hip: FloatArray, sole: FloatArray) -> Layout:
    """Arrange legs by their hips and soles in plan.

    Args:
        hip: [K, 3] facing +Z, any origin.
        sole: [K, 3] the same frame.
    """
    place = 0.5 * (hip + sole)
    low, high = place[:, 0].min(), place[:, 0].max()
    across = place[:, 0] - 0.5 * (low + high)
    # A single pair or row has no span to compare with; its depth serves.
    span = max(high - low, 0.05 * float(np.ptp(place[:, 2])), 1e-300)
    side = np.where(np.abs(across) < MIDDLE * span, 0, np.sign(across)).astype(np.int64)
    if high - low <= 1e-9 * max(float(np.abs(place).max()), 1e-300):
        side[:] = 0
    partner = _partners(place, side)
    return Layout(side, _rows(place, side, partner), partner)


def _partners(place: FloatArray, side: IntArray) -> IntArray:
    """Pair left and right legs from back to front, leaving out the worst where one has more."""
    partner = np.full(len(side), -1, np.int64)
    left = sorted(np.flatnonzero(side > 0).tolist(), key=lambda k: float(place[k, 2]))
    right = sorted(np.flatnonzero(side < 0).tolist(), key=lambda k: float(place[k, 2]))
    while len(left) != len(right):
        more, fewer = (left, right) if len(left) > len(right) else (right, left)
        cost = [
            sum(abs(place[a, 2] - place[b, 2]) for a, b in _zip(more[:i] + more[i + 1 :], fewer))
            for i in range(len(more))
        ]
        more.pop(int(np.argmin(cost)))
    for a, b in zip(left, right, strict=True):
        partner[a], partner[b] = b, a
    return partner


def _zip(a: list[int], b: list[int]) -> list[tuple[int, int]]:
    return list(zip(a, b, strict=False))


def _rows(place: FloatArray, side: IntArray, partner: IntArray) -> IntArray:
    """Number the pairs and the single legs from back to front."""
    groups = [
        (k, int(partner[k])) if partner[k] >= 0 else (k,)
        for k in range(len(side))
        if partner[k] < 0 or k < partner[k]
    ]
    groups.sort(key=lambda group: float(np.mean(place[list(group), 2])))
    row = np.zeros(len(side), np.int64)
    for number, group in enumerate(groups):
        row[list(group)] = number
    return row


def back_to_front(layout: Layout) -> list[int]:
    """Return the legs from back to front, left before right within a row."""
    count = len(layout.side)
    return sorted(range(count), key=lambda k: (int(layout.row[k]), -int(layout.side[k])))
