"""The named gaits, for any number of legs, and which one a creature takes by default.

Sources of the phases and duties: Hildebrand 1965, 1976, 1977 (walk, gallops), Willey 2004 (walking
trot), Hutchinson 2006 (amble), Witte 2006 (gallop's duty), Wilson 1966 and DeAngelis 2019 (insects'
continuum), Li 2013 (crab), Manton 1954 (millipede). Tables give touchdowns after the left hind
foot's; disks hold lift-offs, so a swing starts at touchdown + duty.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from polypod.errors import GaitError, choices
from polypod.gait.pattern import FloatArray, Gait, IntArray, wrapped

# A creature is let into the next gait this much of a Froude number late, in either direction.
FROUDE_HYSTERESIS = 0.1
# Natural duty of sprawlers: 1 - swing / period, with BIOMECHANICS' stride 2.1 L Fr^0.275 and a
# constant swing of 0.9 sqrt(L / g) (desert iguana, Fieler & Jayne 1998).
SPRAWLER_STRIDE = 2.1
SPRAWLER_STRIDE_POWER = 0.275
SPRAWLER_SWING = 0.9


@dataclass(frozen=True)
class _Entry:
    """How a named gait's touchdowns follow from a leg's side and row.

    Either `lag`: rows follow each other from the back by `lag` on each side, the right side
    `right` after the left. Or `corners`: touchdowns of left hind, right hind, left fore and right
    fore; rows between are interpolated.
    """

    family: str
    duty_low: float
    duty: float
    duty_high: float
    lag: float = 0.0  # at mean duty `duty`
    lag_per_duty: float = 0.0
    right: float = 0.5
    corners: tuple[float, float, float, float] | None = None
    leading_share: float = 0.0  # the left side's duty is greater by this share, the right's less


def _arthropod(low: float, duty: float, high: float) -> _Entry:
    """Return a piece of the insects' continuum, whose ideal lag is 1 - duty (Wilson 1966)."""
    return _Entry("arthropod", low, duty, high, lag=1.0 - duty, lag_per_duty=-1.0)


_ENTRIES = {
    "walk": _Entry("walk", 0.58, 0.65, 0.70, lag=0.25),
    "stalk": _Entry("walk", 0.70, 0.75, 0.80, lag=0.20),
    "walking-trot": _Entry("walk", 0.60, 0.67, 0.75, lag=0.46),
    "trot": _Entry("run", 0.30, 0.45, 0.50, lag=0.5),
    # A sprawler's walking trot and trot, one into the other: lag .46 when slow to .5 when fast.
    "lizard": _Entry("run", 0.29, 0.67, 0.75, lag=0.46, lag_per_duty=-0.18),
    "amble": _Entry("run", 0.40, 0.48, 0.55, lag=0.25),
    "pace": _Entry("run", 0.35, 0.43, 0.50, corners=(0.0, 0.5, 0.05, 0.55)),
    "canter": _Entry("run", 0.38, 0.41, 0.45, corners=(0.0, 0.28, 0.30, 0.57)),
    "transverse-gallop": _Entry("run", 0.16, 0.25, 0.30, corners=(0.0, 0.13, 0.37, 0.52)),
    "rotary-gallop": _Entry("run", 0.15, 0.20, 0.25, corners=(0.0, 0.12, 0.60, 0.48)),
    "half-bound": _Entry("run", 0.25, 0.35, 0.45, corners=(0.0, 0.025, 0.45, 0.60)),
    "bound": _Entry("run", 0.25, 0.35, 0.45, corners=(0.0, 0.0, 0.5, 0.5)),
    "pronk": _Entry("run", 0.15, 0.25, 0.35, corners=(0.0, 0.0, 0.0, 0.0)),
    "run": _Entry("run", 0.25, 0.35, 0.40, lag=0.5),
    "hop": _Entry("run", 0.30, 0.40, 0.50, corners=(0.0, 0.0, 0.5, 0.5)),
    "tripod": _arthropod(0.50, 0.50, 0.60),
    "tetrapod": _arthropod(0.60, 2.0 / 3.0, 0.75),
    "wave": _arthropod(0.75, 5.0 / 6.0, 0.90),
    # All three of them: what insects do from slow to fast (DeAngelis 2019, Szczecinski 2018).
    "insect": _arthropod(0.50, 2.0 / 3.0, 0.90),
    # Lag .45 when fast to .40 when slow: a staggered alternating tetrapod.
    "spider": _Entry("arthropod", 0.50, 0.65, 0.75, lag=0.42, lag_per_duty=-0.2),
    "scorpion": _Entry("arthropod", 0.60, 0.67, 0.75, lag=0.60),
    # Sideways, the leading (left) side stands longer.
    "crab": _Entry("arthropod", 0.60, 0.65, 0.70, lag=0.5, leading_share=0.04),
    # From front to back, as giant centipedes' waves with long strides (Manton 1952, Kuroda 2022):
    # each foot lands behind the one ahead of it. The other way legs would cross in mid-air.
    "centipede": _Entry("arthropod", 0.50, 0.60, 0.70, lag=-0.10),
    "millipede": _Entry("arthropod", 0.60, 0.70, 0.80, lag=0.06, right=0.0),
}
_BIPED_DUTY = {"walk": (0.57, 0.62, 0.68)}
# A ring of legs has no pairs to alternate: these gaits step round it, never two neighbours in turn.
_RING_GAITS = ("tripod", "tetrapod", "wave", "insect", "spider", "scorpion", "crab")


def names() -> tuple[str, ...]:
    """Return the names of all gaits; each works for every creature."""
    return tuple(_ENTRIES)


def make_gait(name: str, side: ArrayLike, row: ArrayLike, duty: float | None = None) -> Gait:
    """Return a named gait's disks for a creature's feet.

    Args:
        name: one of `names()`.
        side: [K] +1 left, -1 right, 0 in the middle.
        row: [K] 0 for the hindmost legs, counted forward.
        duty: mean duty wanted, clamped to the gait's own range; None: the gait's preferred one.

    Raises:
        GaitError: no such gait, or sides and rows that are none.
    """
    if name not in _ENTRIES:
        raise GaitError(f"there is no gait '{name}'; choose from {choices(names())}")
    entry = _ENTRIES[name]
    sides, levels = _checked_legs(side, row)
    low, preferred, high = entry.duty_low, entry.duty, entry.duty_high
    if sides.size == 2:
        low, preferred, high = _BIPED_DUTY.get(name, (low, preferred, high))
    lag_per_duty = np.zeros(sides.size)
    if name in _RING_GAITS and (sides == 0).any():
        touchdown = _ring_touchdowns(sides, levels)
    elif entry.corners is not None:
        touchdown = _corner_touchdowns(entry.corners, sides, levels)
    else:
        lag = entry.lag
        if entry.right == 0.0:
            # In phase, a body too short for a whole wave would leave the ground: spread one wave.
            lag = max(lag, 1.0 / (int(levels.max()) + 1))
        along = levels.astype(np.float64)
        touchdown = _with_middle(along * lag, along * lag + entry.right, sides)
        lag_per_duty = along * entry.lag_per_duty
    share = 1.0 + entry.leading_share * sides
    foot_duty = preferred * share / share.mean()
    gait = Gait(
        name=name,
        swing_start=wrapped(touchdown + foot_duty),
        swing_extent=1.0 - foot_duty,
        duty_low=low,
        duty_high=high,
        family=entry.family,
        lag_per_duty=lag_per_duty,
    )
    return gait if duty is None else gait.with_duty(duty)


def _checked_legs(side: ArrayLike, row: ArrayLike) -> tuple[IntArray, IntArray]:
    """Return sides and dense levels from the back, such that no two feet share a place."""
    sides, rows = np.asarray(side), np.asarray(row)
    integers = sides.dtype.kind in "iu" and rows.dtype.kind in "iu"
    if sides.ndim != 1 or sides.shape != rows.shape or not integers:
        raise GaitError("a gait needs one whole number for side and one for row of each foot")
    if sides.size < 2:
        raise GaitError(f"a gait needs at least 2 feet, not {sides.size}")
    if not np.isin(sides, (-1, 0, 1)).all() or (rows < 0).any():
        raise GaitError("a foot's side is 1 (left), -1 (right) or 0 (middle), its row 0 or more")
    sides = sides.astype(np.int64)
    levels = np.unique(rows, return_inverse=True)[1].astype(np.int64).reshape(-1)
    if np.unique(sides).size == 1:
        # All feet in one line: every other one takes the part of the other side.
        order = np.argsort(levels, kind="stable")
        sides = np.empty_like(sides)
        sides[order] = 1 - 2 * (np.arange(sides.size) % 2)
        levels[order] = np.arange(sides.size) // 2
    places = np.stack([sides, levels], axis=1)
    if np.unique(places, axis=0).shape[0] < sides.size:
        for one_side in (-1, 0, 1):
            feet = np.flatnonzero(sides == one_side)
            levels[feet[np.argsort(levels[feet], kind="stable")]] = np.arange(feet.size)
    return sides, levels


def _with_middle(left: FloatArray, right: FloatArray, sides: IntArray) -> FloatArray:
    """Return each foot's own touchdown; a middle foot's lies midway from left to right."""
    apart = wrapped(right - left)
    middle = left + np.where(apart <= 0.5, apart, apart - 1.0) / 2.0
    return np.where(sides > 0, left, np.where(sides < 0, right, middle))


def _corner_touchdowns(
    corners: tuple[float, float, float, float], sides: IntArray, levels: IntArray
) -> FloatArray:
    """Return touchdowns interpolated along each side from the hind to the fore feet's."""
    left_hind, right_hind, left_fore, right_fore = corners
    along = levels / max(int(levels.max()), 1)
    left = left_hind + (left_fore - left_hind) * along
    right = right_hind + (right_fore - right_hind) * along
    return _with_middle(left, right, sides)


def _ring_touchdowns(sides: IntArray, levels: IntArray) -> FloatArray:
    """Return touchdowns evenly spread, each foot's successor across the ring from it.

    Legs in ring order: left side forward, middle feet in front, right side backward, middle feet
    behind. Neighbours are a step apart that is nearest to half a cycle and visits all feet, so that
    two that swing in turn are not neighbours (five legs: 0, .6, .2, .8, .4).
    """
    count = sides.size
    front = 2 * levels >= levels.max()
    ahead, behind = (sides == 0) & front, (sides == 0) & ~front
    quarter = np.select([sides > 0, ahead, sides < 0, behind], [0, 1, 2, 3])
    forward = np.where(sides >= 0, levels, -levels) * np.where(behind, -1, 1)
    order = np.lexsort((forward, quarter))
    steps = [step for step in range(1, count) if math.gcd(step, count) == 1]
    step = min(steps, key=lambda step: (abs(2 * step - count), -step))
    touchdown = np.empty(count)
    touchdown[order] = np.arange(count) * step % count / count
    return touchdown


def natural_duty(froude: float, upright: bool) -> float:
    """Return the duty that a creature takes by itself, before its gait clamps it.

    Upright: contact time over period (Hoyt 2000, Alexander 1976) for a hip 1 m high, where the two
    laws are consistent; v^2 / (g h). Sprawling: constant swing; v^2 / (g L), L the leg's length.
    """
    froude = min(max(froude, 1e-4), 1e4)
    if upright:
        return float(min(0.404 * froude**-0.235, 0.95))
    period = SPRAWLER_STRIDE * froude ** (SPRAWLER_STRIDE_POWER - 0.5)
    return float(max(1.0 - SPRAWLER_SWING / period, 0.05))


def gait_ladder(
    side: ArrayLike, row: ArrayLike, upright: ArrayLike
) -> tuple[tuple[str, ...], tuple[float, ...]]:
    """Return a creature's gaits from slow to fast, and the Froude numbers between them.

    Two legs walk and run; four upright ones walk, trot, canter and gallop. Sprawlers have one gait
    whose pattern follows the speed: four legs the lizard's, up to six, and rings of legs, the
    insects' continuum, eight to ten the spider's, more the centipede's. Arguments as for
    `default_name`.
    """
    sides, _ = _checked_legs(side, row)
    count = sides.size
    if count == 2:
        return ("walk", "run"), (0.5,)
    if count == 4 and (sides != 0).all():
        if _stands_upright(upright):
            return ("walk", "trot", "canter", "transverse-gallop"), (0.35, 2.0, 3.0)
        return ("lizard",), ()
    if count <= 6 or ((sides == 0).any() and count < 12):
        return ("insect",), ()
    return (("spider",), ()) if count <= 10 else (("centipede",), ())


def _stands_upright(upright: ArrayLike) -> bool:
    return bool(np.mean(np.asarray(upright, dtype=np.float64)) > 0.5)


def default_name(
    side: ArrayLike, row: ArrayLike, upright: ArrayLike, froude: float, current: str = ""
) -> str:
    """Return the name of the gait that a creature takes at a speed.

    Args:
        side: [K] as for `make_gait`.
        row: [K] as for `make_gait`.
        upright: a flag, or [K] flags of which most count.
        froude: v^2 / (g h), h the hip's height for upright creatures, the leg's length for others.
        current: the gait it has: left only when the limit is passed by a tenth.
    """
    if not froude >= 0.0:
        raise GaitError(f"a Froude number is at least 0, not {froude}")
    ladder, limits = gait_ladder(side, row, upright)
    place = ladder.index(current) if current in ladder else -1
    passed = 0
    for limit_place, limit in enumerate(limits):
        slack = 0.0 if place < 0 else FROUDE_HYSTERESIS * (1 if place <= limit_place else -1)
        passed += froude > limit * (1.0 + slack)
    return ladder[passed]


def default_gait(
    side: ArrayLike, row: ArrayLike, upright: ArrayLike, froude: float, current: str = ""
) -> Gait:
    """Return the gait that a creature takes at a speed, at its natural duty.

    Arguments as for `default_name`, gaits as in `gait_ladder`.
    """
    name = default_name(side, row, upright, froude, current)
    return make_gait(name, side, row, own_duty(name, upright, froude))


def own_duty(name: str, upright: ArrayLike, froude: float) -> float:
    """Return the natural duty of a creature in a gait, before the gait clamps it."""
    arthropod = _ENTRIES[name].family == "arthropod"
    return natural_duty(froude, _stands_upright(upright) and not arthropod)
