"""What a gait has to be judged against: a creature's size, its feet's places and their reach."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from polypod.controller.stride import StrideTable
from polypod.errors import GaitError, SettingError
from polypod.gait.pattern import BoolArray, FloatArray, Gait, IntArray
from polypod.gait.stride import stride_of
from polypod.gait.tempo import comfortable_speed
from polypod.morphology.types import Morphology
from polypod.reference import by_reference

FASTEST = 100.0  # m/s
# The tempo's reach depends on the duty and the duty on the tempo; a few rounds settle them.
ROUNDS = 20
SETTLED = 1e-9
# A creature that nobody names: proportions of the built-in wolf and spider, hips .5 m high.
PLAIN_HIP_HEIGHT = 0.5  # m
PLAIN_HIP_OF_LEG = (0.86, 0.47)  # hip heights in leg lengths, upright and sprawling
PLAIN_TRAVEL = (0.70, 0.62)  # stance travel, leg lengths
PLAIN_ASIDE = (0.13, 0.55)  # feet beside the middle, leg lengths
PLAIN_APART = (0.80, 0.40)  # a row before the next, leg lengths


class FeetTable(NamedTuple):
    """What kernels of the gait read of the K legs; as in `LegTable`."""

    length: FloatArray
    upright: BoolArray
    side: IntArray
    row: IntArray
    sole_stance: FloatArray


class Stepping(NamedTuple):
    """A gait as a creature steps it at a speed."""

    gait: Gait  # at its duty there
    period: float  # s


@dataclass(frozen=True, eq=False)
class Build:
    """A creature as gaits see it; body frame, metres.

    Attributes:
        name: what it is called.
        hip_height: m, from the ground to the hips as it stands.
        leg_length: m, the mean from hip to sole.
        upright: most legs stand below their hips.
        legs: places and sides of the feet.
        stride: how far feet may travel while they stand.
        foot_name: [K] empty where a foot has none.
    """

    name: str
    hip_height: float
    leg_length: float
    upright: bool
    legs: FeetTable
    stride: StrideTable
    foot_name: tuple[str, ...]

    @classmethod
    def of(cls, morphology: Morphology, tables: Any = None) -> Build:
        """Return the build of a creature, whose `tables` are made where there are none yet."""
        if tables is None:
            from polypod.tables import make_tables

            tables = make_tables(morphology)
        legs = tables.legs
        return cls(
            name=morphology.name,
            hip_height=tables.hip_height,
            leg_length=tables.leg_length,
            upright=tables.upright,
            legs=FeetTable(legs.length, legs.upright, legs.side, legs.row, legs.sole_stance),
            stride=tables.stride,
            foot_name=morphology.foot_name,
        )

    @classmethod
    def plain(cls, foot_count: int, upright: bool) -> Build:
        """Return a creature that nobody names: legs in pairs from the back, an odd one in front."""
        kind = 0 if upright else 1
        length = PLAIN_HIP_HEIGHT / PLAIN_HIP_OF_LEG[kind]
        foot = np.arange(foot_count)
        side, row = 1 - 2 * (foot % 2), foot // 2
        if foot_count % 2:
            side[-1] = 0
        sole = np.zeros((foot_count, 3))
        sole[:, 0] = PLAIN_ASIDE[kind] * length * side
        sole[:, 2] = PLAIN_APART[kind] * length * (row - 0.5 * row.max())
        travel = np.full(foot_count, PLAIN_TRAVEL[kind] * length)
        posture = "upright" if upright else "sprawling"
        return cls(
            name=f"a plain body on {foot_count} {posture} legs, hips {PLAIN_HIP_HEIGHT:g} m high",
            hip_height=PLAIN_HIP_HEIGHT,
            leg_length=length,
            upright=upright,
            legs=FeetTable(
                np.full(foot_count, length), np.full(foot_count, upright), side, row, sole
            ),
            stride=StrideTable(
                np.stack([travel] * 2), np.zeros((2, foot_count)), travel, 0.0 * travel, 1.0
            ),
            foot_name=("",) * foot_count,
        )

    @property
    def foot_count(self) -> int:
        """Number of feet, K."""
        return len(self.legs.length)

    def foot(self, foot: int) -> str:
        """Return what to call a foot."""
        name = self.foot_name[foot]
        return f"foot {foot} ({name})" if name else f"foot {foot}"

    @cached_property
    def _kernel_legs(self) -> FeetTable:
        return by_reference(self.legs)

    @cached_property
    def _kernel_stride(self) -> StrideTable:
        return by_reference(self.stride)

    @property
    def comfortable_speed(self) -> float:
        """The speed, m/s, at which it walks when nobody says how fast."""
        return comfortable_speed(self.hip_height, self.leg_length, self.upright)

    def steps(self, gait: Gait, speed: float) -> Stepping:
        """Return a gait as this creature walks it: at which duty, and how long a cycle takes.

        A period that the gait asks for is kept as far as the legs reach.

        Args:
            gait: for as many feet.
            speed: m/s, straight ahead.

        Raises:
            GaitError: it is for other feet.
            SettingError: a number that cannot be used.
        """
        if gait.foot_count != self.foot_count:
            raise GaitError(
                f"gait '{gait.name}' is for {gait.foot_count} feet; {self.name} has "
                f"{self.foot_count}"
            )
        if not 0.0 <= speed <= FASTEST:
            raise SettingError(f"speed is {speed:g}; it must be from 0 to {FASTEST:g} m/s")
        stepped = gait
        for _ in range(ROUNDS):
            start, extent = stepped.swing_start.copy(), stepped.swing_extent.copy()
            aim = stride_of(
                float(speed),
                gait.duty_low,
                gait.duty_high,
                gait.period,
                start,
                extent,
                0.0,
                0.0,
                1.0,
                self.hip_height,
                self.leg_length,
                self.upright,
                self._kernel_legs,
                self._kernel_stride,
            )
            if abs(aim.duty - stepped.duty) < SETTLED:
                break
            stepped = gait.with_duty(aim.duty)
        return Stepping(stepped, float(aim.period))
