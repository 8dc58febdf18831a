"""What a gait asks of a creature, in numbers without size, and what animals do of it.

Lengths are in hip heights h or leg lengths L, times in units of the root of length over g, forces
in body weights: so a fly and a dinosaur are judged alike.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from polypod.gait.balance import Arcs, Margins, arcs_of, margins_of
from polypod.gait.build import Build
from polypod.gait.orbit import GRAVITY, Orbit, orbit_of, vault_of
from polypod.gait.pattern import FloatArray, Gait

# A centre so far outside of its feet still counts as over them, leg lengths.
OFF_BALANCE = 0.05
# A four-legged creature can always have three feet down from this duty on (McGhee & Frank 1968).
CRAWLING_DUTY = 0.75


class Limit(NamedTuple):
    """Up to `fair` animals do it in steady gaits; beyond `most` none does."""

    fair: float
    most: float
    words: str  # {value} and the limits in the creature's own units

    def excess(self, value: float) -> float:
        """Return by which factor a value is beyond what is fair, as a logarithm; 0 at the limit."""
        if self.most >= self.fair:
            return math.log(max(value, 1e-300) / self.fair)
        return math.log(self.fair / max(value, 1e-300))

    @property
    def most_excess(self) -> float:
        """The excess beyond which no animal does it."""
        return abs(math.log(self.most / self.fair))


LIMITS = {
    # A racehorse's fore leg at 17 m/s stands for .184 of the stride and bears 2.5 body weights,
    # 8.5 to 10 times what it bears in standing (Witte 2006, who finds duties of .2 at the top speed
    # of most runners); a cheetah's for .15.
    "leg_load": Limit(
        9.0,
        11.0,
        "{foot} stands for so short a time that it bears {value:.3g} times its load in standing; "
        "fast animals' legs bear up to {fair:.3g}, at most {most:.3g}",
    ),
    # Sprinters 3 to 4, kangaroos, which hop at duties down to .3, 5; pronking springboks, whose
    # four feet stand at once for a quarter of the time, 6.
    "body_peak": Limit(
        5.3,
        7.0,
        "the feet push the body with {value:.3g} g; runners and hoppers are pushed with up to "
        "{fair:.3g} g, leaping ones with {most:.3g} g",
    ),
    # Horses .3, sprinters .5, a fast kangaroo's .3 s are 1.2 sqrt(h/g); that is a rise by a fifth
    # of the hips' height. In the highest leaps of pronking antelopes it is over three quarters.
    "flight": Limit(
        1.3,
        2.5,
        "the body flies for {value:.2g} s at a time; animals of this size fly for up to "
        "{fair:.2g} s, in leaps {most:.2g} s",
    ),
    # The hips of running men sink by under .1, trunks of galloping dogs and horses by .1; hoppers'
    # by more.
    "stroke": Limit(
        0.25,
        0.5,
        "the body goes up and down by {value:.2g} m over a standing foot; legs of this size give "
        "way by up to {fair:.2g} m, at most {most:.2g} m",
    ),
    # Cheetah and ant .9, mites that cycle at 135 Hz .7 (Wu 2010; Rubin 2016).
    "period": Limit(
        0.7,
        0.45,
        "a cycle takes {value:.2g} s; legs of this length take {fair:.2g} s or more, never less "
        "than {most:.2g} s",
    ),
    # Horse and iguana .9, man 1.2; a slow insect's, whose waves have short swings, .4.
    "swing": Limit(
        0.35,
        0.2,
        "{foot} swings for {value:.2g} s; legs of this length swing for {fair:.2g} s or more, "
        "never less than {most:.2g} s",
    ),
    # An inverted pendulum's lean grows by a fifth in .6 sqrt(h/g), and more than doubles in 1.5.
    "unsupported": Limit(
        0.6,
        1.5,
        "for {value:.2g} s at a time {support}; a body of this size may be so for {fair:.2g} s, "
        "and topples within {most:.2g} s",
    ),
}


def feet_needed(gait: Gait) -> int:
    """Return how many feet a gait's kind asks to stand at any moment.

    Running gaits may fly. Walks keep a foot down, on four legs and more two; insects and their
    like, and all that walk on six legs and more, stand on three at least, and so do four-legged
    ones that walk as slowly as static support takes, from a duty of .75 on.
    """
    if gait.family == "run":
        return 0
    if gait.foot_count < 4:
        return 1
    return 3 if gait.foot_count >= 6 or gait.duty >= CRAWLING_DUTY else 2


@dataclass(frozen=True, eq=False)
class Demand:
    """A gait as a creature steps it at a speed, and what that asks of it.

    Figures are worked out when they are first asked for: most gaits that a search tries fail on
    the cheap ones.
    """

    gait: Gait
    period: float  # s
    speed: float  # m/s
    build: Build
    weight: FloatArray  # [K], sum 1

    @classmethod
    def of(cls, gait: Gait, build: Build, speed: float, weight: FloatArray) -> Demand:
        """Return what a gait asks at a speed, its duty and tempo as the creature would take."""
        stepped, period = build.steps(gait, speed)
        return cls(stepped, period, speed, build, weight)

    @cached_property
    def orbit(self) -> Orbit:
        """The body's vertical motion."""
        vault = vault_of(self.gait, self.build.upright)
        return orbit_of(self.gait, self.period, self.weight, vault)

    @cached_property
    def arcs(self) -> Arcs:
        """The cycle between events, and who stands."""
        return arcs_of(self.gait)

    @cached_property
    def margins(self) -> Margins:
        """How the feet support the body's centre."""
        plan = self.build.legs.sole_stance[:, [0, 2]]
        return margins_of(self.gait, self.arcs, plan, self.speed * self.period)

    @cached_property
    def flight(self) -> float:
        """The longest time at a stretch in which no foot stands, s."""
        return longest_stretch(self.arcs.length, self.arcs.feet_down == 0) * self.period

    @cached_property
    def unsupported(self) -> float:
        """The longest time at a stretch without the feet that the gait's kind needs, s.

        Where it needs three, they must have the body's centre between them too.
        """
        needed = feet_needed(self.gait)
        without = self.arcs.feet_down < needed
        if needed == 3:
            without = without | (self.margins.mean < -OFF_BALANCE * self.build.leg_length)
        return longest_stretch(self.arcs.length, without) * self.period

    def values(self) -> Iterator[tuple[str, float, float]]:
        """Yield what is limited: its name, its value and the unit of the value, cheap ones first.

        A value times its unit is in g, seconds or metres.
        """
        hip_time = math.sqrt(self.build.hip_height / GRAVITY)
        leg_time = math.sqrt(self.build.leg_length / GRAVITY)
        yield "leg_load", float(self.orbit.foot_peak.max()), 1.0
        yield "period", self.period / leg_time, leg_time
        yield "swing", float(self.gait.swing_extent.min()) * self.period / leg_time, leg_time
        yield "body_peak", self.orbit.strongest.value, 1.0
        yield "flight", self.flight / hip_time, hip_time
        hip = self.build.hip_height
        yield "stroke", float(self.orbit.stance_stroke().max()) / hip, hip
        yield "unsupported", self.unsupported / hip_time, hip_time

    def passes(self) -> bool:
        """Say whether animals do all of it in steady gaits."""
        return all(LIMITS[name].excess(value) <= 0.0 for name, value, _ in self.values())

    def total_excess(self) -> float:
        """Return how far it is from passing: 0 where it does."""
        return sum(max(LIMITS[name].excess(value), 0.0) for name, value, _ in self.values())


def longest_stretch(length: FloatArray, within: np.ndarray) -> float:
    """Return the longest run of arcs [A] of a circle that are `within`, as a sum of lengths."""
    if within.all():
        return float(length.sum())
    # Begin behind an arc that is not within, so that no run goes across the end.
    first = int(np.argmin(within))
    longest = run = 0.0
    for arc in np.roll(np.arange(len(length)), -first):
        run = run + float(length[arc]) if within[arc] else 0.0
        longest = max(longest, run)
    return longest
