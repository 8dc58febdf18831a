"""Girdles: which legs hang together on the trunk."""

from __future__ import annotations

import numpy as np
import pytest

from polypod.morphology.describe import describe
from polypod.morphology.girdles import find_girdles
from polypod.morphology.load import load_rig
from polypod.morphology.types import LegTable


@pytest.mark.parametrize(
    ("rig", "count"),
    [("biped", 1), ("wolf", 2), ("lizard", 2), ("centaur", 3), ("pentapod", 1), ("ant", 1),
     ("crab", 1), ("spider", 1), ("centipede", 20)],
)  # fmt: skip
def test_girdles_of_the_built_in_creatures(rig: str, count: int) -> None:
    morphology = load_rig(rig)
    girdles = find_girdles(morphology.legs)
    assert len(girdles.place) == count
    assert np.all(np.diff(girdles.place) > 0.0)
    assert girdles.weight == pytest.approx(1.0 / count)
    # Legs are numbered from the back.
    assert np.all(np.diff(girdles.of_leg) >= 0)
    assert ("girdles: one" in describe(morphology)) == (count == 1)


def rows_at(*places: float) -> LegTable:
    """Return pairs of a wolf's legs with their hips at places along z, leg lengths."""
    legs = load_rig("wolf").legs
    rows = np.repeat(np.arange(len(places)), 2)
    point = np.zeros((len(rows), 2, 3))
    point[:, 0, 2] = np.repeat(places, 2) * legs.length[0]
    return legs._replace(
        row=rows, point_rest=point, length=np.full(len(rows), legs.length[0]),
        weight=np.arange(1.0, len(rows) + 1) / np.arange(1.0, len(rows) + 1).sum(),
    )  # fmt: skip


def test_a_centaur_has_three_and_close_rows_share_one() -> None:
    centaur = find_girdles(rows_at(-1.0, 0.0, 0.8))
    assert centaur.of_leg.tolist() == [0, 0, 1, 1, 2, 2]
    assert centaur.weight == pytest.approx(np.array([3, 7, 11]) / 21)
    pairs = find_girdles(rows_at(-1.0, -0.9, 0.8, 0.9))
    assert pairs.of_leg.tolist() == [0] * 4 + [1] * 4
    assert pairs.place[1] - pairs.place[0] == pytest.approx(1.8 * load_rig("wolf").legs.length[0])
    # Rows are taken by where they are, whatever their order.
    assert find_girdles(rows_at(0.8, 0.0, -1.0)).of_leg.tolist() == [2, 2, 1, 1, 0, 0]
