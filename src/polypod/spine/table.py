"""What the spine's four steps know of a creature, made once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polypod.morphology.girdles import Girdles
from polypod.morphology.spine import SpineTable
from polypod.morphology.types import FloatArray


class BendTable(NamedTuple):
    """The G girdles of a spine as nodes of a curve; body frame, m."""

    most_yaw: FloatArray  # [G] rad by which limits let a girdle turn against the body's axis


def make_bend_table(spine: SpineTable, girdles: Girdles) -> BendTable:
    """Return what is made from the spine's segments and its girdles."""
    return BendTable(most_yaw(spine, girdles))


def most_yaw(spine: SpineTable, girdles: Girdles) -> FloatArray:
    """Return [G] how far, rad, limits let each girdle turn against the body's axis.

    All of the bends between the hindmost and the foremost, divided by where they are along it.
    """
    count = len(girdles.place)
    most = np.zeros(count)
    if not len(spine.joint) or count < 2:
        return most
    first, last = int(spine.of_girdle[0]), int(spine.of_girdle[-1])
    span = float(girdles.place[-1] - girdles.place[0])
    whole = float(spine.limit[first + 1 : last + 1, 0].sum())
    return np.asarray(whole * np.abs(girdles.place) / span)
