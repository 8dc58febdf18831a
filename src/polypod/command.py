"""What a user asks of a herd, by name; writes the arrays that kernels read."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from polypod.errors import SettingError
from polypod.gait.pattern import FloatArray, Gait
from polypod.state import HerdCommand

FARTHEST = 1e5  # m, of any place asked for


def numbers_of(name: str, value: ArrayLike, unit: str) -> FloatArray:
    """Return what was given as an array of numbers.

    Raises:
        SettingError: it is no number, or no array of numbers.
    """
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise SettingError(f"{name} is {value!r}; it must be numbers, in {unit}") from None


class Asked:
    """An attribute of `Command` that is one number a creature; a single number is given to all."""

    def __init__(self, low: float, high: float, unit: str) -> None:
        self.low = low
        self.high = high
        self.unit = unit

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, command: Any, owner: type) -> Any:
        return self if command is None else getattr(command.arrays, self.name)

    def __set__(self, command: Command, value: ArrayLike) -> None:
        numbers = numbers_of(self.name, value, self.unit)
        if not np.all((numbers >= self.low) & (numbers <= self.high)):
            raise SettingError(
                f"{self.name} is {value!r}; "
                f"it must be from {self.low:g} to {self.high:g} {self.unit}"
            )
        try:
            getattr(command.arrays, self.name)[:] = numbers
        except ValueError:
            count = command.arrays.speed.shape[0]
            raise SettingError(
                f"{self.name} has shape {numbers.shape}; give one number, or one for each of "
                f"{count} creatures"
            ) from None


class Command:
    """Speed, direction, gait and posture asked of a herd; changeable at any time between steps.

    Attributes (each one number for all, or one for each creature; all read back as arrays [C]):
        speed: m/s.
        heading: rad about +Y from +Z toward +X; used where there is no path.
        travel: rad from the heading to the direction of travel (a crab's is pi / 2).
        step_height: m, of a swing foot over level ground.
        body_height: m, of the body centre above the plane of the feet.
        blend_cycles: gait cycles in which a change of gait takes place.
    """

    speed = Asked(0.0, 100.0, "m/s")
    heading = Asked(-1e6, 1e6, "rad")
    travel = Asked(-math.pi, math.pi, "rad")
    step_height = Asked(0.0, 100.0, "m")
    body_height = Asked(0.0, 1000.0, "m")
    blend_cycles = Asked(0.1, 100.0, "cycles")

    def __init__(self, arrays: HerdCommand) -> None:
        self.arrays = arrays
        # What the gait asked for is called, where one was.
        self.gait_name = np.full(arrays.speed.shape, "", object)

    @property
    def period(self) -> Any:
        """Seconds a gait cycle [C]; NaN where it follows speed and morphology."""
        return self.arrays.period

    @period.setter
    def period(self, value: ArrayLike | None) -> None:
        self._pin("period", value, 1e-3, 1e3, "s")

    @property
    def duty(self) -> Any:
        """Mean duty factor [C], kept within the gait's range; NaN where it follows speed."""
        return self.arrays.duty

    @duty.setter
    def duty(self, value: ArrayLike | None) -> None:
        self._pin("duty", value, 0.01, 0.99, "of the cycle")

    def _pin(self, name: str, value: ArrayLike | None, low: float, high: float, unit: str) -> None:
        numbers = numbers_of(name, math.nan if value is None else value, unit)
        if np.any(numbers < low) or np.any(numbers > high):
            raise SettingError(
                f"{name} is {value!r}; it must be from {low:g} to {high:g} {unit}, or None"
            )
        try:
            getattr(self.arrays, name)[:] = numbers
        except ValueError:
            raise SettingError(
                f"{name} has shape {numbers.shape}; give one number, or one for each creature"
            ) from None

    @property
    def spacing(self) -> Any:
        """Shift of each foot's rest place [C, K, 2]: toward the left and forward, m (P1 Fig 6)."""
        return self.arrays.spacing

    @spacing.setter
    def spacing(self, value: ArrayLike) -> None:
        numbers = numbers_of("spacing", value, "metres")
        if not np.all(np.abs(numbers) <= 1000.0):
            raise SettingError(f"spacing is {value!r}; it must be [feet, 2] metres up to 1000")
        try:
            self.arrays.spacing[:] = numbers
        except ValueError:
            shape = self.arrays.spacing.shape
            raise SettingError(
                f"spacing has shape {numbers.shape}; it must fit [creatures, feet, 2] = {shape}"
            ) from None

    def reach(self, foot: int, place: ArrayLike, creature: int | slice = slice(None)) -> None:
        """Take a leg out of the gait and send its sole to a place [3], world, m.

        It goes there as far as it reaches while the others walk on, and may be sent elsewhere at
        any time; `put_back` ends it. What is in its way is the caller's care.

        Raises:
            SettingError: no such foot, or a place that cannot be used.
        """
        self._judge_foot(foot)
        numbers = numbers_of("a place to reach for", place, "metres")
        if numbers.shape != (3,) or not np.all(np.abs(numbers) <= FARTHEST):
            raise SettingError(
                f"a place to reach for is {place!r}; it must be x, y, z within {FARTHEST:g} m"
            )
        self.arrays.reach_place[creature, foot] = numbers
        self.arrays.reaching[creature, foot] = True

    def put_back(self, foot: int, creature: int | slice = slice(None)) -> None:
        """Put a leg back into the gait: its foot lands and walks on.

        Raises:
            SettingError: no such foot.
        """
        self._judge_foot(foot)
        self.arrays.reaching[creature, foot] = False

    def _judge_foot(self, foot: int) -> None:
        count = self.arrays.reaching.shape[1]
        if not isinstance(foot, int | np.integer) or not 0 <= foot < count:
            raise SettingError(f"foot is {foot!r}; it must be from 0 to {count - 1}")

    def set_gait(
        self, gait: Gait, creature: int | slice = slice(None), *, same_circle: bool = False
    ) -> None:
        """Ask for a gait, whatever the speed; a walking creature changes to it by P1's rule.

        `follow_speed` lets go of it.

        Args:
            gait: to walk in.
            creature: whose; all where none is said.
            same_circle: it was drawn out of the gait before, so phases of both count from the same
                moment: feet whose sector is as it was step as they did. Else the creature's circle
                is turned to where the gaits are nearest.

        Raises:
            SettingError: the gait is for another number of feet.
        """
        feet = self.arrays.gait_touchdown.shape[1]
        if gait.foot_count != feet:
            raise SettingError(
                f"gait '{gait.name}' is for {gait.foot_count} feet; this creature has {feet}"
            )
        self.arrays.gait_touchdown[creature] = gait.touchdown
        self.arrays.gait_share[creature] = gait.duty_share
        self.arrays.gait_lag[creature] = gait.lag_per_duty
        self.arrays.gait_vault[creature] = gait.vault
        self.arrays.gait_number[creature] += 1
        self.arrays.gait_duty[creature] = (gait.duty, gait.duty_low, gait.duty_high)
        self.arrays.follows[creature] = False
        self.arrays.same_circle[creature] = same_circle
        self.gait_name[creature] = gait.name
        if not math.isnan(gait.period):
            self.arrays.period[creature] = gait.period

    def follow_speed(
        self, creature: int | slice = slice(None), *, same_circle: bool = False
    ) -> None:
        """Let the gait follow the speed, as it does where none was asked for.

        A period that a gait brought along stays until `period` is set. `same_circle` as of
        `set_gait`: the gait before was drawn out of the one that follows speed.
        """
        self.arrays.follows[creature] = True
        self.arrays.same_circle[creature] = same_circle
        self.gait_name[creature] = ""

    def set_path(self, waypoints: Sequence[Sequence[float]], creature: int) -> None:
        """Ask one creature to walk over waypoints [W, 2] of x, z, and to stop at the last.

        Raises:
            SettingError: the points are not finite pairs, or more than there is room for.
        """
        points = numbers_of("a path", waypoints, "metres")
        room = self.arrays.waypoints.shape[1]
        shaped = points.ndim == 2 and points.shape[1] == 2
        if not shaped or not np.all(np.abs(points) <= FARTHEST):
            raise SettingError(f"a path must be a list of points x, z within {FARTHEST:g} m")
        if not 1 <= len(points) <= room:
            raise SettingError(f"a path has {len(points)} points; it may have 1 to {room}")
        self.arrays.waypoints[creature, : len(points)] = points
        self.arrays.waypoint_count[creature] = len(points)
