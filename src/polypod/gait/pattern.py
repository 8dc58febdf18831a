"""A gait's pattern: one disk a foot with the sector in which the foot swings (P1 3.3, Figure 8).

Phases are fractions of the cycle in [0, 1). A foot lifts off at `swing_start`, lands at its
touchdown `swing_start + swing_extent`, and stands for the rest: its duty is `1 - swing_extent`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from polypod.config import WALKING_VAULT
from polypod.errors import GaitError, choices

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

FAMILIES = ("walk", "run", "arthropod")
# Neither swing nor stance may be shorter than this share of the cycle: a sector that a needle
# passes within a frame of film is not a step.
SHORTEST_SECTOR = 0.01
# Events closer than this happen at the same moment: feet that change places by the table must not
# leave a moment without support through the rounding of a phase.
SAME_MOMENT = 1e-9
ROUNDING = 1e-9


def wrapped(phase: ArrayLike) -> FloatArray:
    """Return phases in [0, 1) at the same places of the circle."""
    values = np.mod(np.asarray(phase, dtype=np.float64), 1.0)
    return np.where(values < 1.0, values, 0.0)


@dataclass(frozen=True, eq=False)
class Gait:
    """The disks of K feet, and how they follow the duty that a speed asks for.

    Attributes:
        name: what the gait is called.
        swing_start: [K] phase at which each foot lifts off.
        swing_extent: [K] share of the cycle for which each foot swings.
        duty_low: least mean duty at which it is still this gait.
        duty_high: greatest mean duty at which it is still this gait.
        family: "walk" (the body vaults), "run" (it bounces) or "arthropod".
        lag_per_duty: [K] how far a touchdown moves on the circle per unit of mean duty; zero but in
            the metachronal gaits, whose lag follows the duty.
        period: s, the cycle's duration where the gait asks for one, NaN where speed sets it.

    Raises:
        GaitError: the disks are not a gait.
    """

    name: str
    swing_start: FloatArray
    swing_extent: FloatArray
    duty_low: float = math.nan
    duty_high: float = math.nan
    family: str = "walk"
    lag_per_duty: FloatArray = field(default_factory=lambda: np.zeros(0))
    period: float = math.nan

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name.strip() or not self.name.isprintable():
            raise GaitError(f"a gait's name must be printable text, not {self.name!r}")
        if self.family not in FAMILIES:
            raise GaitError(
                f"gait '{self.name}' has family {self.family!r}; choose from {choices(FAMILIES)}"
            )
        start = self._numbers("swing_start", self.swing_start)
        extent = self._numbers("swing_extent", self.swing_extent)
        lag = self._numbers("lag_per_duty", self.lag_per_duty)
        if lag.size == 0:
            lag = np.zeros(start.size)
        if start.size == 0 or not start.shape == extent.shape == lag.shape:
            raise GaitError(
                f"gait '{self.name}' needs one start and one extent for each foot, "
                f"not {start.size} starts, {extent.size} extents and {lag.size} lags"
            )
        for name, values in (("swing_start", start), ("swing_extent", extent), ("lag", lag)):
            values.flags.writeable = False
            object.__setattr__(self, "lag_per_duty" if name == "lag" else name, values)
        self._check_sectors(start, extent)
        self._settle_duty_range()
        if not (math.isnan(self.period) or 0.0 < self.period < math.inf):
            raise GaitError(
                f"gait '{self.name}' has a period of {self.period} s; it must be above 0"
            )

    def _numbers(self, key: str, given: ArrayLike) -> FloatArray:
        try:
            values = np.array(given, dtype=np.float64, order="C", ndmin=1)
        except (TypeError, ValueError, OverflowError):
            raise GaitError(f"gait '{self.name}': {key} must be a list of numbers") from None
        if values.ndim != 1 or not np.isfinite(values).all():
            raise GaitError(f"gait '{self.name}': {key} must be a list of finite numbers")
        return values

    def _check_sectors(self, start: FloatArray, extent: FloatArray) -> None:
        for foot in np.flatnonzero((start < 0.0) | (start >= 1.0)):
            raise GaitError(
                f"gait '{self.name}': foot {foot} starts its swing at {start[foot]:g}; "
                "a start is a fraction of the cycle, at least 0 and below 1"
            )
        low, high = SHORTEST_SECTOR, 1.0 - SHORTEST_SECTOR
        for foot in np.flatnonzero((extent < low - ROUNDING) | (extent > high + ROUNDING)):
            raise GaitError(
                f"gait '{self.name}': foot {foot} swings for {extent[foot]:g} of the cycle; "
                f"an extent is between 0 and 1, at least {low:g} and at most {high:g}"
            )

    def _settle_duty_range(self) -> None:
        low = self.duty if math.isnan(self.duty_low) else float(self.duty_low)
        high = self.duty if math.isnan(self.duty_high) else float(self.duty_high)
        if not low - ROUNDING <= self.duty <= high + ROUNDING:
            raise GaitError(
                f"gait '{self.name}' has a mean duty of {self.duty:.4g}, "
                f"outside of its own range from {low:.4g} to {high:.4g}"
            )
        longest = float(np.max(1.0 - self.swing_extent)) * high / self.duty
        shortest = float(np.min(1.0 - self.swing_extent)) * low / self.duty
        if min(shortest, 1.0 - longest) < SHORTEST_SECTOR - ROUNDING:
            raise GaitError(
                f"gait '{self.name}': the duty range from {low:.4g} to {high:.4g} leaves a foot "
                f"no swing or no stance of at least {SHORTEST_SECTOR:g} of the cycle"
            )
        object.__setattr__(self, "duty_low", low)
        object.__setattr__(self, "duty_high", high)

    @property
    def foot_count(self) -> int:
        """Number of feet, K."""
        return int(self.swing_start.size)

    @property
    def touchdown(self) -> FloatArray:
        """[K] phases at which the feet land."""
        return wrapped(self.swing_start + self.swing_extent)

    @property
    def duty(self) -> float:
        """Mean over the feet of stance time / stride time."""
        return float(np.mean(1.0 - self.swing_extent))

    @property
    def duty_sum(self) -> float:
        """Sum of the feet's duties: the mean number of feet down."""
        return float(np.sum(1.0 - self.swing_extent))

    @property
    def duty_share(self) -> FloatArray:
        """[K] each foot's duty over the mean duty."""
        return np.asarray((1.0 - self.swing_extent) / self.duty)

    @property
    def vault(self) -> float:
        """Alexander's q of the body's motion on upright legs: walks vault, all else bounces."""
        return WALKING_VAULT if self.family == "walk" else 0.0

    def with_duty(self, duty: float) -> Gait:
        """Return this gait at another mean duty, clamped to the gait's own range.

        Touchdowns stay (but for the metachronal gaits' lag), lift-offs move; each foot keeps its
        share of the duty.
        """
        if not math.isfinite(duty):
            raise GaitError(f"gait '{self.name}' cannot have a duty of {duty}")
        wanted = min(max(float(duty), self.duty_low), self.duty_high)
        foot_duty = (1.0 - self.swing_extent) * (wanted / self.duty)
        touchdown = self.swing_start + self.swing_extent + self.lag_per_duty * (wanted - self.duty)
        return replace(
            self, swing_start=wrapped(touchdown + foot_duty), swing_extent=1.0 - foot_duty
        )

    def feet_down(self, phase: ArrayLike) -> IntArray:
        """Return how many feet stand at the given phases, shaped like them."""
        inside = wrapped(np.asarray(phase, dtype=np.float64)[..., None] - self.swing_start)
        return np.asarray(np.count_nonzero(inside >= self.swing_extent, axis=-1), dtype=np.int64)

    def support(self) -> tuple[FloatArray, IntArray]:
        """Return the arcs of the cycle between events: their lengths and the feet down in each.

        Exact: the number of feet down changes only where a foot lifts or lands. Arcs shorter than
        `SAME_MOMENT` are left out.
        """
        ends = np.sort(np.concatenate([self.swing_start, self.touchdown]))
        length = np.append(ends[1:], ends[0] + 1.0) - ends
        real = length > SAME_MOMENT
        return length[real], self.feet_down(ends[real] + length[real] / 2.0)

    @property
    def minimum_feet_down(self) -> int:
        """Least number of feet that stand at any moment of the cycle."""
        return int(self.support()[1].min())

    @property
    def maximum_feet_down(self) -> int:
        """Greatest number of feet that stand at any moment of the cycle."""
        return int(self.support()[1].max())

    @property
    def flight_share(self) -> float:
        """Share of the cycle in which no foot stands."""
        length, down = self.support()
        return float(length[down == 0].sum())

    @property
    def standing_phase(self) -> float:
        """Phase at which the needle of a standing creature waits for its first step.

        The lift-off at which the fewest feet are within their sectors: those miss their swing.
        """
        down = self.feet_down(self.swing_start - 2.0 * SAME_MOMENT)
        return float(self.swing_start[int(np.argmax(down))])
