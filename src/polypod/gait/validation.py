"""Whether a gait is plausible before it is walked: forces, flight, balance (P2 4).

P2: the forces that its pseudo-physics calculates "are used to validate the plausibility of the gait
pattern designed by the user", as with a bad one they are "too large and not natural". Here they are
those of the closed-form orbit (`orbit.py`), and what is too large is what no animal does
(`limits.py`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from polypod.gait.build import Build
from polypod.gait.limits import LIMITS, Demand, feet_needed
from polypod.gait.mending import Change, nearest_change
from polypod.gait.orbit import Orbit, normal_weight
from polypod.gait.pattern import Gait
from polypod.gait.tempo import froude_number
from polypod.morphology.types import Morphology

PLAUSIBLE, HARD, IMPLAUSIBLE = VERDICTS = ("plausible", "hard", "implausible")


@dataclass(frozen=True, eq=False)
class GaitCheck:
    """A gait's figures on a creature at a speed, and what to think of them.

    Attributes:
        gait: the gait as it is stepped at that speed: its duty there.
        creature: what it was judged for.
        speed: m/s.
        froude: v^2 / (g h), h the hips' height.
        period: s, a cycle.
        orbit: the body's vertical motion, to be asked at any phase.
        foot_peak: [K] g, the most with which each foot pushes its own particle. As an animal feels
            it: so many times the load that the foot bears in standing.
        foot_share: [K] body weights that each foot bears then: `foot_peak` times its weight.
        body_peak: g, the most with which all feet together push the body.
        body_least: g, the least; never below 0, and 0 in flight.
        flight: s, the longest time in which no foot stands.
        flight_share: share of the cycle in which no foot stands.
        excursion: m, how far the body goes up and down.
        excursion_hips: the same in hip heights.
        stroke_hips: hip heights by which the body goes up and down over a standing foot, the most.
        margin_least: leg lengths from the body's centre in plan to the edge of the polygon of the
            standing feet, the least while any foot stands; negative outside.
        margin_mean: the mean while any foot stands.
        feet_needed: how many feet the gait's kind asks to stand (`limits.feet_needed`).
        short_share: share of the cycle in which fewer stand.
        unsupported: s, the longest time without those feet, or with the centre outside of three.
        verdict: "plausible", "hard" (only the best animals do it) or "implausible" (none does).
        reasons: a sentence for each figure that is not plausible, the worst first.
        change: the nearest change that makes the gait plausible; None where it is plausible, or
            where none was found.
    """

    gait: Gait
    creature: str
    speed: float
    froude: float
    period: float
    orbit: Orbit
    foot_peak: tuple[float, ...]
    foot_share: tuple[float, ...]
    body_peak: float
    body_least: float
    flight: float
    flight_share: float
    excursion: float
    excursion_hips: float
    stroke_hips: float
    margin_least: float
    margin_mean: float
    feet_needed: int
    short_share: float
    unsupported: float
    verdict: str
    reasons: tuple[str, ...]
    change: Change | None

    @property
    def sentence(self) -> str:
        """The verdict in a sentence: peak force, main reason, what would mend it."""
        words = (
            f"gait '{self.gait.name}' at {self.speed:.3g} m/s is {self.verdict}, with "
            f"{self.body_peak:.3g} g at the peak"
        )
        if self.reasons:
            words += f": {self.reasons[0]}"
        return words if self.change is None else f"{words}; plausible with {self.change.text}"


def check_gait(
    gait: Gait,
    creature: Morphology | Build | None = None,
    *,
    speed: float | None = None,
    weight: ArrayLike | None = None,
) -> GaitCheck:
    """Judge a gait by the motion that it implies, before anything walks.

    Args:
        gait: its duty follows the speed within its range, as in a walk; a period of its own counts.
        creature: who walks it; None: a plain body on as many legs, sprawling for arthropods' gaits
            and upright for others, hips half a metre high.
        speed: m/s; None: the comfortable one.
        weight: [K] how much each foot counts in the body's motion; None: all alike.

    Raises:
        GaitError: the gait is for other feet.
        SettingError: a number that cannot be used.
    """
    if creature is None:
        build = Build.plain(gait.foot_count, gait.family != "arthropod")
    else:
        build = creature if isinstance(creature, Build) else Build.of(creature)
    return mended(judge_gait(gait, build, speed=speed, weight=weight), gait, build)


def judge_gait(
    gait: Gait, build: Build, *, speed: float | None = None, weight: ArrayLike | None = None
) -> GaitCheck:
    """Judge a gait as `check_gait` does, at once: without the search for what would mend it.

    Raises:
        GaitError: the gait is for other feet.
        SettingError: a number that cannot be used.
    """
    pace = build.comfortable_speed if speed is None else float(speed)
    demand = Demand.of(gait, build, pace, normal_weight(weight, gait.foot_count))
    verdict, reasons = _verdict(demand)
    orbit, arcs, margins = demand.orbit, demand.arcs, demand.margins
    needed = feet_needed(demand.gait)
    stands = arcs.feet_down > 0
    mean = np.average(margins.mean[stands], weights=arcs.length[stands])
    return GaitCheck(
        gait=demand.gait,
        creature=build.name,
        speed=pace,
        froude=float(froude_number(pace, build.hip_height)),
        period=demand.period,
        orbit=orbit,
        foot_peak=tuple(orbit.foot_peak.tolist()),
        foot_share=tuple((orbit.foot_peak * orbit.weight).tolist()),
        body_peak=orbit.strongest.value,
        body_least=orbit.weakest.value,
        flight=demand.flight,
        flight_share=demand.gait.flight_share,
        excursion=orbit.excursion,
        excursion_hips=orbit.excursion / build.hip_height,
        stroke_hips=float(orbit.stance_stroke().max()) / build.hip_height,
        margin_least=float(np.nanmin(margins.least)) / build.leg_length,
        margin_mean=float(mean) / build.leg_length,
        feet_needed=needed,
        short_share=float(arcs.length[arcs.feet_down < needed].sum()),
        unsupported=demand.unsupported,
        verdict=verdict,
        reasons=reasons,
        change=None,
    )


def mended(
    check: GaitCheck, gait: Gait, creature: Build, go_on: Callable[[], object] = lambda: None
) -> GaitCheck:
    """Return what `judge_gait` found, with the nearest change that makes the gait plausible.

    Args:
        check: what it found.
        gait: the gait as it was given to it.
        creature: for which it was judged.
        go_on: called again and again; what it raises gives the search up, which may take seconds.
    """
    if check.verdict == PLAUSIBLE:
        return check
    demand = Demand.of(gait, creature, check.speed, check.orbit.weight)
    return replace(check, change=nearest_change(gait, demand, go_on))


def _verdict(demand: Demand) -> tuple[str, tuple[str, ...]]:
    """Return what to think of a demand, and why."""
    worst = 0
    found: list[tuple[float, str]] = []
    for name, value, unit in demand.values():
        limit = LIMITS[name]
        excess = limit.excess(value)
        if excess <= 0.0:
            continue
        beyond = excess > limit.most_excess
        worst = max(worst, 2 if beyond else 1)
        words = limit.words.format(
            value=value * unit,
            fair=limit.fair * unit,
            most=limit.most * unit,
            foot=demand.build.foot(int(np.argmin(_stretch(demand, name)))),
            support=_support(demand),
        )
        found.append((excess / limit.most_excess, words))
    found.sort(key=lambda reason: -reason[0])
    return VERDICTS[worst], tuple(words for _, words in found)


def _stretch(demand: Demand, name: str) -> np.ndarray:
    """Return the shares [K] of the cycle of which a limit finds the shortest too short."""
    extent = demand.gait.swing_extent
    return extent if name == "swing" else 1.0 - extent


def _support(demand: Demand) -> str:
    needed = feet_needed(demand.gait)
    if needed < 3:
        return "no foot stands" if needed == 1 else "fewer than two feet stand"
    return "fewer than three feet stand, or the body's centre is not between them"
