"""The crowd beside the first creature: it stands in rows and strolls from place to place."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from polypod.activity import ARRIVED, BLOCKED
from polypod.errors import SettingError
from polypod.herd import Herd
from polypod.jobs.cast import comfortable_speed
from polypod.morphology.types import Morphology
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
        leg = float(morphology.legs.length.mean())
        wide = 2.0 * max(float(v) for v in morphology.body.half_size[[0, 2]])
        apart = APART * leg + wide
        side = math.ceil(math.sqrt(count))
        index = np.arange(count)
        rows = np.stack([index % side - 0.5 * (side - 1), -(index // side)], axis=1) * apart
        herd = None
        for attempt in range(TRIES):
            places = rows - [0.0, behind + attempt * apart]
            try:
                herd = world.add(
                    morphology, count, position=places, speed=comfortable_speed(morphology)
                )
                break
            except SettingError:
                if attempt == TRIES - 1:
                    raise
        if herd is not None:
            herds.append(herd)
            behind += apart * (1 + (count - 1) // side) + wide
    return herds


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
