"""The gait manager alone: a creature whose feet always find a place and land when their disk says.

It assembles the kernels as a controller does and watches what the feet do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from polypod.gait.needle import lift_phase, next_foot_to_lift, turn_needle
from polypod.gait.pattern import Gait, wrapped
from polypod.gait.transition import adopt_disks, align_cycle, approach_disks

WINDOW = 0.5


def paired(count: int) -> tuple[list[int], list[int]]:
    """Return sides and rows of `count` legs in pairs from the back, an odd one in front."""
    side = [1 if k % 2 == 0 else -1 for k in range(count)]
    if count % 2:
        side[-1] = 0
    return side, [k // 2 for k in range(count)]


@dataclass
class Seen:
    """What was seen of a walk, in cycles."""

    fewest_down: int
    arrived_after: float  # when all feet went by the new gait's disks; NaN: never
    longest_stance: float
    shortest_stance: np.ndarray  # [K]
    shortest_swing: np.ndarray  # [K]


class Walker:
    """A creature with K feet under a needle."""

    def __init__(self, gait: Gait, needle: float = 0.0) -> None:
        self.needle = float(needle)
        self.start, self.extent = gait.swing_start.copy(), gait.swing_extent.copy()
        self.goal_start, self.goal_extent = self.start.copy(), self.extent.copy()
        inside = wrapped(needle - self.start)
        self.in_swing = inside < self.extent
        # Feet that swing already began on time; the others landed on time.
        self.lifted = self.start.copy()
        self.stood = np.where(self.in_swing, 0.0, inside - self.extent)
        self.held = np.zeros(gait.foot_count, bool)
        self.minimum = gait.minimum_feet_down
        self.cycles_left = 0.0
        self.destination = gait

    def change_to(self, gait: Gait, cycles: float, align: bool = False) -> None:
        self.destination, self.cycles_left = gait, cycles
        self.minimum = min(self.minimum, gait.minimum_feet_down)
        if align:
            self.needle = align_cycle(
                self.needle, self.start, self.goal_start, self.lifted,
                gait.swing_start.copy(), gait.swing_extent.copy(),
            )  # fmt: skip

    def step(self, turn: float) -> tuple[list[int], list[int], int]:
        """Turn the needle; return feet that landed, feet that lifted, how many go by old disks."""
        self.needle = turn_needle(self.needle, turn, 1.0).needle
        self.cycles_left = approach_disks(
            self.goal_start, self.goal_extent, self.destination.swing_start.copy(),
            self.destination.swing_extent.copy(), turn, self.cycles_left,
        )  # fmt: skip
        inside = wrapped(self.needle - self.start)
        landed = np.flatnonzero(self.in_swing & (inside >= self.extent))
        self.in_swing[landed] = False
        self.stood += turn
        self.stood[landed] = inside[landed] - self.extent[landed]
        others = adopt_disks(
            self.start, self.extent, self.goal_start, self.goal_extent, self.in_swing
        )
        lifted: list[int] = []
        while True:
            k = next_foot_to_lift(
                self.needle, self.start, self.extent, self.in_swing, self.stood, self.held,
                self.minimum, WINDOW,
            )  # fmt: skip
            if k < 0:
                return list(landed), lifted, others
            self.in_swing[k] = True
            self.lifted[k] = lift_phase(self.needle, turn, self.start[k])
            lifted.append(k)

    def walk(self, cycles: float, turn: float) -> Seen:
        feet = self.start.size
        stance, swing = np.full(feet, np.inf), np.full(feet, np.inf)
        fewest, arrived, longest = feet, np.nan, 0.0
        for i in range(round(cycles / turn)):
            _, lifted, others = self.step(turn)
            for k in lifted:
                stance[k] = min(stance[k], self.stood[k])
                span = wrapped(self.start[k] + self.extent[k] - self.lifted[k])
                swing[k] = min(swing[k], float(span))
            longest = max(longest, float(self.stood[~self.in_swing].max(initial=0.0)))
            fewest = min(fewest, int(np.count_nonzero(~self.in_swing)))
            if others == 0 and self.cycles_left == 0.0 and np.isnan(arrived):
                arrived = (i + 1) * turn
        return Seen(fewest, arrived, longest, stance, swing)
