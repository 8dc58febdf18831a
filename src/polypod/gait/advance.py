"""One step of the gait manager: tempo, transition, needle (P1 3.3)."""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.gait.needle import minimum_feet_down, turn_needle
from polypod.gait.tempo import tempo
from polypod.gait.transition import adopt_disks, align_cycle, approach_disks
from polypod.math.intervals import wrap_phase

# The duty factor follows speed within about so many cycles.
DUTY_CYCLES = 0.5


@kernel
def fastest_foot_speed(c: int, state: Any, tables: Any) -> float:
    """Return the speed of the fastest foot's rest place, m/s: it sets the tempo in a turn."""
    legs = tables.legs
    most = 0.0
    for k in range(legs.length.shape[0]):
        across = legs.sole_stance[k, 0] + state.spacing[c, k, 0]
        along = legs.sole_stance[k, 2] + state.spacing[c, k, 1]
        # Heading turns +Z toward +X: a place at +X moves backward.
        forward = state.speed[c] - state.turn_rate[c] * across
        sideways = state.turn_rate[c] * along
        most = max(most, math.hypot(forward, sideways))
    return most


@kernel
def stance_travel_limit(c: int, command: Any, tables: Any) -> float:
    """Return how far every leg lets its foot travel under the body while it stands, metres."""
    ik = tables.ik
    sideways = abs(math.sin(command.travel[c]))
    limit = math.inf
    for k in range(ik.stance_travel.shape[0]):
        travel = ik.stance_travel[k] + sideways * (ik.stance_travel_least[k] - ik.stance_travel[k])
        limit = min(limit, travel)
    return limit


@kernel
def destination_disks(c: int, command: Any, duty: float, start_out: Any, extent_out: Any) -> None:
    """Write the disks of the gait asked for at a mean duty factor, [K] each."""
    for k in range(start_out.shape[0]):
        foot_duty = command.gait_share[c, k] * duty
        touchdown = command.gait_touchdown[c, k]
        touchdown += command.gait_lag[c, k] * (duty - command.gait_duty[c, 0])
        start_out[k] = wrap_phase(touchdown + foot_duty)
        extent_out[k] = 1.0 - foot_duty


@kernel
def advance_gait(
    c: int, dt: float, wishes_to_step: bool, state: Any, command: Any, tables: Any, scratch: Any
) -> float:
    """Advance one creature's gait by `dt` seconds; return the needle's turn, cycles.

    `wishes_to_step` keeps the needle of a standing creature turning while a foot is off its place.
    """
    speed = fastest_foot_speed(c, state, tables)
    aim = tempo(
        speed, tables.hip_height, tables.leg_length, tables.upright, command.gait_duty[c, 1],
        command.gait_duty[c, 2], stance_travel_limit(c, command, tables), command.period[c],
    )  # fmt: skip
    feet = state.swinging.shape[1]
    in_swing = 0
    for k in range(feet):
        if state.swinging[c, k]:
            in_swing += 1
    if not wishes_to_step and in_swing == 0:
        state.cycle_rate[c] = 0.0
        return 0.0
    state.cycle_rate[c] = 1.0 / aim.period
    needle = turn_needle(state.needle[c], dt, aim.period)
    state.needle[c] = needle.needle
    state.duty[c] += (aim.duty - state.duty[c]) * (1.0 - math.exp(-needle.turn / DUTY_CYCLES))
    if state.gait_number[c] != command.gait_number[c]:
        state.gait_number[c] = command.gait_number[c]
        state.blend_left[c] = command.blend_cycles[c]
        state.duty[c] = aim.duty
        destination_disks(c, command, state.duty[c], scratch.start, scratch.extent)
        state.needle[c] = align_cycle(
            state.needle[c], state.swing_start[c], state.goal_start[c], state.lift_phase[c],
            scratch.start, scratch.extent,
        )  # fmt: skip
    destination_disks(c, command, state.duty[c], scratch.start, scratch.extent)
    blending = state.blend_left[c] > 0.0
    state.blend_left[c] = approach_disks(
        state.goal_start[c], state.goal_extent[c], scratch.start, scratch.extent,
        needle.turn, state.blend_left[c],
    )  # fmt: skip
    waiting = adopt_disks(
        state.swing_start[c], state.swing_extent[c],
        state.goal_start[c], state.goal_extent[c], state.swinging[c],
    )  # fmt: skip
    for k in range(feet):
        state.stood[c, k] += needle.turn
    least = minimum_feet_down(scratch.start, scratch.extent)
    # On the way between two gaits the weaker of their own minima holds.
    if (blending or waiting > 0) and state.least_down[c] < least:
        least = state.least_down[c]
    state.least_down[c] = least
    return float(needle.turn)
