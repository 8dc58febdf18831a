"""Girdles: the parts of a trunk that carry legs, P2's pelvis nodes without the head (P2 4, 5).

A wolf has two, a centaur three, a centipede one for each pair of legs. Legs that radiate from one
place, as a spider's do, hang on a single girdle.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polypod.morphology.types import FloatArray, IntArray, LegTable

# A trunk whose hips lie within so many leg lengths is one girdle: spider .2, ant .3, pentapod .5,
# against wolf .8, lizard 1.8.
ONE_GIRDLE = 0.65
# In a longer one, rows of legs within so many leg lengths share a girdle; a centipede's are .37
# apart.
SHARED = 0.25


class Girdles(NamedTuple):
    """The G girdles of a morphology, from the back to the front, as kernels read them."""

    of_leg: IntArray  # [K] the girdle that carries the leg
    place: FloatArray  # [G] m, body frame, along z: the mean of its hips
    weight: FloatArray  # [G] share of the body's weight that its legs carry, sums to 1


def find_girdles(legs: LegTable) -> Girdles:
    """Return the girdles of a creature: its rows of legs, those that hang together as one."""
    hip_z = legs.point_rest[:, 0, 2]
    rows = np.unique(legs.row)
    row_z = np.array([hip_z[legs.row == row].mean() for row in rows])
    order = np.argsort(row_z, kind="stable")
    rows, row_z = rows[order], row_z[order]
    length = float(legs.length.mean())
    of_leg = np.zeros(len(legs.row), np.int64)
    if row_z[-1] - row_z[0] > ONE_GIRDLE * length:
        girdle, first = 0, row_z[0]
        for row, z in zip(rows, row_z, strict=True):
            if z - first > SHARED * length:
                girdle, first = girdle + 1, z
            of_leg[legs.row == row] = girdle
    count = int(of_leg.max()) + 1
    weight = np.array([legs.weight[of_leg == g].sum() for g in range(count)])
    place = np.array([hip_z[of_leg == g].mean() for g in range(count)])
    return Girdles(of_leg, place, weight)
