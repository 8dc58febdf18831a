"""The crowd beside the first creature: it stands in rows and strolls from place to place."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress

import numpy as np

from polypod.activity import ARRIVED, BLOCKED
from polypod.errors import SettingError
from polypod.herd import Herd
from polypod.jobs.cast import comfortable_speed
from polypod.morphology.types import Morphology
from polypod.report.arrays import FloatArray
from polypod.world import World

# Rows stand so many leg lengths apart, and a place that is not free is looked for so often.
APART = 3.2
TRIES = 6
# Goals lie within so many times the crowd's own square, and are given so often, s.
ROOM = 1.4
EVERY = 0.5


def stand_beside(world: World, first: Herd, kinds: Sequence[tuple[Morphology, int]]) -> list[Herd]:
    """Stand kinds of creatures in rows behind and beside the first.

    Raises:
        SettingError: a kind finds no place to stand.
    """
    herds = []
    behind = 3.0 * first.tables.leg_length + float(first.morphology.body.half_size[2])
    for morphology, count in kinds:
        wide = 2.0 * max(float(v) for v in morphology.body.half_size[[0, 2]])
        apart = APART * float(morphology.legs.length.mean()) + wide
        abreast = math.ceil(math.sqrt(count))
        index = np.arange(count)
        places = apart * np.stack(
            [index % abreast - 0.5 * (abreast - 1), -(index // abreast)], axis=1
        )
        herds.append(_stand(world, morphology, places, behind, apart))
        behind += apart * (1 + (count - 1) // abreast) + wide
    return herds


def _stand(
    world: World, morphology: Morphology, places: FloatArray, behind: float, apart: float
) -> Herd:
    """Stand creatures at places [C, 2], so far behind or a few rows more, until these are free.

    Raises:
        SettingError: none of the places tried is free.
    """

    def stand(attempt: int) -> Herd:
        back = places - [0.0, behind + attempt * apart]
        speed = comfortable_speed(morphology)
        return world.add(morphology, len(places), position=back, speed=speed)

    for attempt in range(TRIES - 1):
        with suppress(SettingError):
            return stand(attempt)
    return stand(TRIES - 1)


class Wanderers:
    """Gives each of a crowd another goal whenever it has arrived, seeded."""

    def __init__(self, herds: Sequence[Herd], first: Herd) -> None:
        self.herds = list(herds)
        self.random = np.random.default_rng(0)
        total = sum(herd.count for herd in self.herds)
        leg = max([herd.tables.leg_length for herd in self.herds], default=0.0)
        self.half = ROOM * 0.5 * APART * leg * max(math.sqrt(total), 3.0)
        self.centre = np.array([0.0, -self.half])
        self.due = 0.0
        self.begun = False

    def lead(self, time: float) -> None:
        """Give goals to those who need one, now and then; `time` is in seconds."""
        if time < self.due or not self.herds:
            return
        self.due = time + EVERY
        for herd in self.herds:
            for c in range(herd.count):
                idle = herd.state.activity[c] in (ARRIVED, BLOCKED)
                if not self.begun or idle:
                    goal = self.centre + self.random.uniform(-self.half, self.half, 2)
                    herd.command.set_path([goal.tolist()], c)
        self.begun = True
