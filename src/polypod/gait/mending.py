"""The nearest change that makes a gait plausible, found by trying.

Tried are what a user would turn: the duty, the period, when one foot or a few of them step; then
duty and period together, another speed, and last another gait. What is offered was judged as it is
written, with rounded numbers.

Changes are compared by one measure: the logarithm of the ratio for period and speed, for duty that
of stance over swing, and three times the sum of the shifts in cycles: a quarter of a cycle counts
as much as twice the period.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import product
from typing import NamedTuple

import numpy as np

from polypod.errors import GaitError
from polypod.gait.build import FASTEST
from polypod.gait.library import make_gait, names
from polypod.gait.limits import Demand
from polypod.gait.pattern import Gait, wrapped

SHIFT_COST = 3.0
# Shifts of touchdowns that are tried, cycles.
SHIFT_STEP = 0.02
# The same where several feet are shifted.
COARSE_SHIFT = 0.05
LARGEST_SHIFT = 0.5
MOST_SHIFTED = 3
# Moving one of many feet mends little and takes long to try.
MOST_FEET_SHIFTED = 12
# Periods and speeds tried: so many to an octave, over so many octaves either way.
STEPS_AN_OCTAVE = 8
OCTAVES = 4
# Steps of the duties tried together with periods.
COARSE_DUTY = 0.05
GoOn = Callable[[], object]


@dataclass(frozen=True, eq=False)
class Change:
    """Something to turn, and what comes of it.

    Attributes:
        gait: the gait changed, plausible at `speed`.
        speed: m/s.
        text: what to turn, as in "a duty of 0.3 instead of 0.15".
        size: how large the change is by the measure of this module.
    """

    gait: Gait
    speed: float
    text: str
    size: float


class _Turned(NamedTuple):
    """What is turned; None and nothing: left as it is."""

    duty: float | None = None
    period: float | None = None
    shifts: tuple[tuple[int, float], ...] = ()  # feet, and by how many cycles they step later
    speed: float | None = None
    name: str | None = None


def nearest_change(asked: Gait, demand: Demand, go_on: GoOn = lambda: None) -> Change | None:
    """Return the smallest change found that makes a gait plausible, None where none was found.

    Args:
        asked: the gait as given, with its range of duties.
        demand: what it asks of the creature.
        go_on: called before each change that is tried; what it raises gives the search up.
    """
    one = [*_duties(), *_periods(demand), *_shifts(asked, (), SHIFT_STEP)]
    found = _first(asked, demand, one, go_on)
    if found is not None:
        return found
    both = [
        _several_shifts(asked, demand, go_on),
        _first(asked, demand, _duties_and_periods(demand), go_on),
    ]
    smallest = min(both, key=lambda change: change.size if change is not None else math.inf)
    if smallest is not None:
        return smallest
    found = _first(asked, demand, _speeds(demand), go_on)
    return found or _first(asked, demand, [_Turned(name=name) for name in names()], go_on)


def _first(asked: Gait, demand: Demand, tried: Iterable[_Turned], go_on: GoOn) -> Change | None:
    """Return the smallest change that passes."""
    for turned in sorted(tried, key=lambda turned: _size(turned, demand)):
        go_on()
        made = _demand_of(turned, asked, demand)
        if made is None:
            continue
        gait, result = made
        # Legs that do not reach so far shorten a period: then it is not what was said.
        kept = turned.period is None or result.period == turned.period
        if kept and result.passes():
            return Change(gait, result.speed, _text(turned, demand), _size(turned, demand))
    return None


def _several_shifts(asked: Gait, demand: Demand, go_on: GoOn) -> Change | None:
    """Return a few feet's shifts that pass together, each the best after those before."""
    before: tuple[tuple[int, float], ...] = ()
    for _ in range(MOST_SHIFTED - 1):
        tried = list(_shifts(asked, before, COARSE_SHIFT))
        if not tried:
            return None
        excess = []
        for turned in tried:
            go_on()
            excess.append(_excess(turned, asked, demand))
        before = tried[excess.index(min(excess))].shifts
        found = _first(asked, demand, _shifts(asked, before, COARSE_SHIFT), go_on)
        if found is not None:
            return found
    return None


def _excess(turned: _Turned, asked: Gait, demand: Demand) -> float:
    made = _demand_of(turned, asked, demand)
    return math.inf if made is None else made[1].total_excess()


def _demand_of(turned: _Turned, asked: Gait, demand: Demand) -> tuple[Gait, Demand] | None:
    """Return a changed gait and what it asks, None where it is none."""
    try:
        gait = _applied(turned, asked, demand)
    except GaitError:  # a sector too short, or too few feet for a named gait
        return None
    speed = demand.speed if turned.speed is None else turned.speed
    return gait, Demand.of(gait, demand.build, speed, demand.weight)


def _applied(turned: _Turned, asked: Gait, demand: Demand) -> Gait:
    """Return the gait with a change.

    Raises:
        GaitError: there is no such gait.
    """
    if turned.name is not None:
        return make_gait(turned.name, demand.build.legs.side, demand.build.legs.row)
    gait = asked
    if turned.duty is not None:
        low, high = min(gait.duty_low, turned.duty), max(gait.duty_high, turned.duty)
        gait = replace(gait, duty_low=low, duty_high=high).with_duty(turned.duty)
        gait = replace(gait, duty_low=math.nan, duty_high=math.nan)
    if turned.period is not None:
        gait = replace(gait, period=turned.period)
    if turned.shifts:
        start = gait.swing_start.copy()
        for foot, shift in turned.shifts:
            start[foot] += shift
        gait = replace(gait, swing_start=wrapped(start))
    return gait


def _size(turned: _Turned, demand: Demand) -> float:
    size = SHIFT_COST * sum(abs(shift) for _, shift in turned.shifts)
    if turned.duty is not None:
        old = demand.gait.duty
        size += abs(math.log(turned.duty * (1.0 - old) / (old * (1.0 - turned.duty))))
    for value, before in ((turned.period, demand.period), (turned.speed, demand.speed)):
        if value is not None:
            size += abs(math.log(value / before))
    # Gaits in the library's order.
    return size if turned.name is None else float(names().index(turned.name))


def _text(turned: _Turned, demand: Demand) -> str:
    words = []
    if turned.name is not None:
        words.append(f"the gait '{turned.name}' instead")
    if turned.duty is not None:
        old = f"{demand.gait.duty:.2g}"
        kept = float(old) == turned.duty
        words.append(
            f"a duty kept at {old}" if kept else f"a duty of {turned.duty:g} instead of {old}"
        )
    if turned.period is not None:
        words.append(f"a period of {turned.period:g} s instead of {demand.period:.2g} s")
    if turned.speed is not None:
        words.append(f"a speed of {turned.speed:g} m/s instead of {demand.speed:.3g} m/s")
    for foot, shift in turned.shifts:
        way = "later" if shift > 0.0 else "earlier"
        words.append(f"{demand.build.foot(foot)} stepping {abs(shift):g} of a cycle {way}")
    return " and ".join(words)


def _duties() -> Iterator[_Turned]:
    for hundredths in range(2, 98):
        yield _Turned(duty=hundredths / 100.0)


def _periods(demand: Demand) -> Iterator[_Turned]:
    for period in _around(demand.period):
        yield _Turned(period=period)


def _duties_and_periods(demand: Demand) -> Iterator[_Turned]:
    duties = [round(duty, 2) for duty in np.arange(COARSE_DUTY, 0.99, COARSE_DUTY).tolist()]
    for duty, period in product(duties, _around(demand.period)):
        yield _Turned(duty=duty, period=period)


def _speeds(demand: Demand) -> Iterator[_Turned]:
    for speed in _around(demand.speed) if demand.speed > 0.0 else ():
        if speed <= FASTEST:
            yield _Turned(speed=speed)


def _shifts(
    asked: Gait, before: tuple[tuple[int, float], ...], shift_step: float
) -> Iterator[_Turned]:
    """Yield changes that shift one foot more."""
    if asked.foot_count > MOST_FEET_SHIFTED:
        return
    steps = [shift_step * (i + 1) for i in range(round(LARGEST_SHIFT / shift_step))]
    for foot, step, sign in product(range(asked.foot_count), steps, (1.0, -1.0)):
        if foot not in [shifted for shifted, _ in before]:
            yield _Turned(shifts=(*before, (foot, round(sign * step, 2))))


def _around(value: float) -> list[float]:
    """Return numbers of two digits about one, evenly spread in their logarithms."""
    steps = np.arange(-OCTAVES * STEPS_AN_OCTAVE, OCTAVES * STEPS_AN_OCTAVE + 1)
    near = value * np.exp2(steps / STEPS_AN_OCTAVE)
    return sorted({float(f"{number:.2g}") for number in near.tolist() if number > 0.0})
