"""The periodic vertical motion of a gait in closed form (P2 4, Figure 11).

Each foot drives a virtual particle of its own, as if it bore the body alone. Through a stance,
u in [-.5, .5], it pushes with

    f(u) = (cos(pi u) - q cos(3 pi u)) / (duty (2 / pi) (1 + q / 3))    in units of gravity,

whose mean over the cycle is 1; in its swing the particle flies. So the fall stalls at mid-stance,
propulsion gives the speed that makes the swing ballistic (P2 equation 5c), and nothing is tuned.
The shape is Alexander & Jayes' (1978): q = 0 bounces, lowest at mid-stance; q = .4, which they
measured on walking people, vaults. P2's own constant forces of reception and propulsion do not
bounce at all at a duty of one half. The body is the weighted mean of the particles.

Phases are fractions of the cycle, forces are in units of gravity, heights in metres about the mean
height, which is 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from polypod.errors import SettingError
from polypod.gait.pattern import BoolArray, FloatArray, Gait

GRAVITY = 9.81  # m/s^2
# Beyond it a foot would pull at mid-stance.
LARGEST_VAULT = 1.0
# Samples of a cycle among which extremes are looked for before they are refined.
SAMPLES = 256
SAMPLES_A_STANCE = 12
# Each leaves a quarter of the bracket about an extreme: 2 / SAMPLES to 3e-8, values to 1e-14.
REFINEMENTS = 9
REFINED = 9
# Of several turning points the greatest on the grid need not be the greatest.
CANDIDATES = 4


class Extreme(NamedTuple):
    """Where in the cycle something is greatest or least, and how much it is there."""

    phase: float
    value: float


@dataclass(frozen=True, eq=False)
class Orbit:
    """The vertical motion of a body on K feet that repeats itself in every cycle.

    Attributes:
        touchdown: [K] phase at which each foot lands.
        duty: [K] share of the cycle for which it stands, in (0, 1).
        weight: [K] share that each foot has in the body's motion; they sum to 1.
        period: s.
        vault: q in [0, 1], 0 where the body bounces.
    """

    touchdown: FloatArray
    duty: FloatArray
    weight: FloatArray
    period: float
    vault: float = 0.0

    def foot_force(self, phase: ArrayLike) -> FloatArray:
        """Return with how many g each foot pushes its own particle, [..., K] for phases [...]."""
        turn = math.pi * self._progress(phase)
        force = np.cos(turn) - self.vault * np.cos(3.0 * turn)
        return np.where(self._stands(phase), force / (self.duty * self._impulse), 0.0)

    def foot_speed(self, phase: ArrayLike) -> FloatArray:
        """Return the speeds upward of the particles, m/s, [..., K] for phases [...]."""
        since = self._since_mid_stance(phase)
        turn = math.pi * since / self.duty
        pushed = np.sin(turn) / math.pi - self.vault * np.sin(3.0 * turn) / (3.0 * math.pi)
        falling = since - np.copysign(0.5, since)  # about mid-swing
        speed = np.where(self._stands(phase), pushed / self._impulse - since, -falling)
        return np.asarray(speed * GRAVITY * self.period)

    def foot_height(self, phase: ArrayLike) -> FloatArray:
        """Return the heights of the particles over their means, m, [..., K] for phases [...]."""
        since = self._since_mid_stance(phase)
        falling = since - np.copysign(0.5, since)
        lowest, top = self._turning_heights
        height = np.where(
            self._stands(phase), lowest + self._rise(since), top - 0.5 * falling * falling
        )
        return np.asarray(height * GRAVITY * self.period**2)

    def force(self, phase: ArrayLike) -> FloatArray:
        """Return with how many g the feet push the body, shaped like the phases."""
        return self.foot_force(phase) @ self.weight

    def speed(self, phase: ArrayLike) -> FloatArray:
        """Return the body's speed upward, m/s, shaped like the phases."""
        return self.foot_speed(phase) @ self.weight

    def height(self, phase: ArrayLike) -> FloatArray:
        """Return the body's height over its mean height, m, shaped like the phases."""
        return self.foot_height(phase) @ self.weight

    @property
    def foot_peak(self) -> FloatArray:
        """[K] the most with which each foot pushes its own particle, g.

        As an animal's foot feels it: so many times the load that it bears in standing.
        """
        q = self.vault
        # d/du is sin(x) (12 q cos(x)^2 - 3 q - 1) = 0 with x = pi u.
        cosine = math.sqrt((1.0 + 3.0 * q) / (12.0 * q)) if q > 1.0 / 9.0 else 1.0
        most = cosine * (1.0 + 3.0 * q - 4.0 * q * cosine * cosine)
        return np.asarray(most / (self.duty * self._impulse))

    @cached_property
    def highest(self) -> Extreme:
        """Where the body is highest, m."""
        return self._extreme(self.height, +1.0)

    @cached_property
    def lowest(self) -> Extreme:
        """Where the body is lowest, m."""
        return self._extreme(self.height, -1.0)

    @property
    def excursion(self) -> float:
        """How far the body goes up and down, m, from its lowest to its highest."""
        return self.highest.value - self.lowest.value

    @cached_property
    def strongest(self) -> Extreme:
        """Where the feet push the body most, g."""
        return self._extreme(self.force, +1.0)

    @cached_property
    def weakest(self) -> Extreme:
        """Where the feet push the body least, g; 0 in flight."""
        return self._extreme(self.force, -1.0)

    def stance_stroke(self) -> FloatArray:
        """Return how far [K] the body rises and falls while each foot stands, m.

        Its leg has to give way and stretch by so much.
        """
        through = self.touchdown + self.duty * np.linspace(0.0, 1.0, 33)[:, None]
        return np.ptp(self.height(through), axis=0)

    @property
    def _impulse(self) -> float:
        """The integral of the unscaled force over u."""
        return 2.0 / math.pi * (1.0 + self.vault / 3.0)

    def _since_mid_stance(self, phase: ArrayLike) -> FloatArray:
        """Return cycles since each foot's mid-stance, in [-.5, .5), [..., K]."""
        turned = np.asarray(phase, dtype=np.float64)[..., None] - self.touchdown - 0.5 * self.duty
        return np.asarray(turned - np.floor(turned + 0.5))

    def _progress(self, phase: ArrayLike) -> FloatArray:
        """Return u: -.5 at touchdown, 0 at mid-stance, .5 at lift-off, and beyond in swing."""
        return self._since_mid_stance(phase) / self.duty

    def _stands(self, phase: ArrayLike) -> BoolArray:
        return np.abs(self._since_mid_stance(phase)) <= 0.5 * self.duty

    def _rise(self, since: FloatArray) -> FloatArray:
        """Return the height over mid-stance's in a stance, in g T^2, `since` mid-stance."""
        turn = math.pi * since / self.duty
        pushed = (1.0 - np.cos(turn)) - self.vault * (1.0 - np.cos(3.0 * turn)) / 9.0
        return np.asarray(self.duty * pushed / (math.pi**2 * self._impulse) - 0.5 * since * since)

    @cached_property
    def _turning_heights(self) -> tuple[FloatArray, FloatArray]:
        """[K] height at mid-stance and [K] at mid-swing, in g T^2, such that the mean is 0."""
        q, duty = self.vault, self.duty
        bend = (1.0 - 2.0 / math.pi) - q * (1.0 + 2.0 / (3.0 * math.pi)) / 9.0
        stance = duty * duty * bend / (math.pi**2 * self._impulse) - duty**3 / 24.0
        take_off = self._rise(0.5 * duty)
        swing = 1.0 - duty
        lowest = -(stance + swing * take_off + swing**3 / 12.0)
        return lowest, lowest + take_off + swing * swing / 8.0

    @cached_property
    def _grid(self) -> FloatArray:
        """Phases at which extremes are looked for: events, mid-stances, and between them."""
        # A stance too short for the even samples has its own: a vault pushes twice in each.
        short = self.duty * SAMPLES < SAMPLES_A_STANCE
        inside = np.linspace(0.0, 1.0, SAMPLES_A_STANCE + 1)[:, None]
        within = (self.touchdown + self.duty * inside)[:, short].reshape(-1)
        middle = self.touchdown + 0.5 * self.duty
        events = np.concatenate([self.touchdown, middle, self.touchdown + self.duty, within])
        return np.unique(np.concatenate([np.mod(events, 1.0), np.arange(SAMPLES) / SAMPLES]))

    def _extreme(self, value: Callable[[FloatArray], FloatArray], sign: float) -> Extreme:
        """Return the greatest (sign +1) or least (-1) of a function of the phase."""
        grid = self._grid
        rated = sign * value(grid)
        turning = (rated >= np.roll(rated, 1)) & (rated >= np.roll(rated, -1))
        candidates = np.flatnonzero(turning)
        candidates = candidates[np.argsort(-rated[candidates], kind="stable")[:CANDIDATES]]
        before = np.append(grid[-1] - 1.0, grid)[candidates]
        after = np.append(grid, grid[0] + 1.0)[candidates + 1]
        rows = np.arange(len(candidates))
        for _ in range(REFINEMENTS):
            trial = np.linspace(before, after, REFINED, axis=1)
            best = np.argmax(sign * value(trial), axis=1)
            before = trial[rows, np.maximum(best - 1, 0)]
            after = trial[rows, np.minimum(best + 1, REFINED - 1)]
        # Extremes at events are on the grid already.
        phases = np.concatenate([grid[candidates], 0.5 * (before + after)])
        values = value(phases)
        place = int(np.argmax(sign * values))
        return Extreme(float(phases[place] % 1.0), float(values[place]))


def vault_of(gait: Gait, upright: bool) -> float:
    """Return q: walks on legs that stand below their hips vault, everything else bounces."""
    return gait.vault if upright else 0.0


def orbit_of(
    gait: Gait, period: float, weight: ArrayLike | None = None, vault: float = 0.0
) -> Orbit:
    """Return the vertical motion that a gait implies.

    Args:
        gait: its disks say when feet push.
        period: s, the cycle's duration.
        weight: [K] how much each foot counts in the body's motion; any scale; None: all alike.
        vault: q in [0, 1], see `vault_of`.

    Raises:
        SettingError: a number that cannot be used.
    """
    if not 0.0 < period < math.inf:
        raise SettingError(f"a gait's period is {period} s; it must be above 0")
    if not 0.0 <= vault <= LARGEST_VAULT:
        raise SettingError(f"a gait's vault is {vault}; it must be from 0 to {LARGEST_VAULT:g}")
    return Orbit(
        touchdown=gait.touchdown,
        duty=1.0 - gait.swing_extent,
        weight=normal_weight(weight, gait.foot_count),
        period=float(period),
        vault=float(vault),
    )


def normal_weight(weight: ArrayLike | None, foot_count: int) -> FloatArray:
    """Return the share [K] that each foot has in the body's motion; they sum to 1.

    Raises:
        SettingError: they are not one positive number for each foot.
    """
    if weight is None:
        return np.full(foot_count, 1.0 / foot_count)
    try:
        values = np.array(weight, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise SettingError("weights of feet must be a list of numbers") from None
    if values.shape != (foot_count,):
        raise SettingError(
            f"weights of feet must be {foot_count} numbers, one for each foot, "
            f"not of shape {values.shape}"
        )
    if not (np.isfinite(values).all() and (values > 0.0).all()):
        raise SettingError(f"weights of feet must all be above 0, not {values.tolist()}")
    return values / values.max() / (values / values.max()).sum()
