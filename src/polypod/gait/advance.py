"""One step of the gait manager: tempo, transition, needle (P1 3.3)."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.push import NO_DEFLECTION, is_pushed
from polypod.compute import kernel
from polypod.controller.steering import PlanPose, plan_pose, predict
from polypod.controller.swing import FASTEST_CATCH_UP
from polypod.gait.needle import minimum_feet_down, turn_needle
from polypod.gait.tempo import tempo
from polypod.gait.transition import adopt_disks, align_cycle, approach_disks
from polypod.math.intervals import wrap_phase

# The duty factor follows speed within about so many cycles.
DUTY_CYCLES = 0.5
# How far ahead the tempo looks, leg pendulum times: about half a cycle.
SOON = 1.5
# A foot that has just lifted, or will soon land, moves slower than the body: the part of the reach
# that is left to the stance.
SWING_LAG = 0.9
# Cycles in which a hurry dies away once legs have room again.
HURRY_CYCLES = 3.0
# A balance step, twice as quick as the gait's, takes at least so many leg pendulum times; and the
# way back to the path is as fast as this share of the spring's rate times how far off it is.
QUICKEST_STEP = 0.45
WAY_BACK = math.exp(-1.0)


@kernel
def fastest_foot_speed(
    c: int, pose: PlanPose, state: Any, command: Any, tables: Any
) -> float:  # fmt: skip
    """Return the speed of the fastest foot's rest place, m/s: it sets the tempo in a turn.

    Also when pushed, and until the body is back: how far it still is counts like a speed.
    """
    legs = tables.legs
    aside = pose.aside
    course = pose.heading - aside.heading + command.travel[c]
    push_ahead = math.sin(course) * aside.rate_x + math.cos(course) * aside.rate_z
    push_left = math.cos(course) * aside.rate_x - math.sin(course) * aside.rate_z
    turn_rate = pose.turn_rate + aside.rate_heading
    most = 0.0
    for k in range(legs.length.shape[0]):
        across = legs.sole_stance[k, 0] + state.spacing[c, k, 0]
        along = legs.sole_stance[k, 2] + state.spacing[c, k, 1]
        # Heading turns +Z toward +X: a place at +X moves backward.
        forward = pose.speed + push_ahead - turn_rate * across
        sideways = push_left + turn_rate * along
        most = max(most, math.hypot(forward, sideways))
    if is_pushed(aside):
        most = math.hypot(most, WAY_BACK * tables.recovery * math.hypot(aside.x, aside.z))
    return most


@kernel
def quickest_period(
    c: int, pose: PlanPose, duty: float, state: Any, command: Any, tables: Any
) -> float:
    """Return the shortest cycle of a pushed creature, s: legs have their own pendulum's time.

    Who is asked to walk quicker than that keeps its tempo.
    """
    alone = PlanPose(
        pose.x, pose.z, pose.heading, pose.turn_rate, pose.speed, pose.waypoint, pose.corner,
        pose.detour, pose.pace, NO_DEFLECTION,
    )  # fmt: skip
    own = tempo(
        fastest_foot_speed(c, alone, state, command, tables), tables.hip_height, tables.leg_length,
        tables.upright, command.gait_duty[c, 1], command.gait_duty[c, 2],
        stance_travel_limit(c, state, command, tables), command.period[c],
    )  # fmt: skip
    quickest = FASTEST_CATCH_UP * QUICKEST_STEP * tables.pendulum_time / (1.0 - duty)
    return min(quickest, own.period)


@kernel
def stance_travel_limit(c: int, state: Any, command: Any, tables: Any) -> float:
    """Return how far every leg lets its foot travel under the body while it stands, metres."""
    return travel_limit(
        state.goal_start[c], state.goal_extent[c], command.travel[c], tables.ik, tables.legs
    )


@kernel
def travel_limit(start: Any, extent: Any, direction: float, ik: Any, legs: Any) -> float:
    """Return how far the legs let a foot travel under the body while it stands, metres.

    Args:
        start: [K] the gait's disks.
        extent: [K] the gait's disks.
        direction: rad, of the travel from straight ahead.
        ik: an IkTable.
        legs: a LegTable.
    """
    sideways = abs(math.sin(direction))
    limit = math.inf
    for k in range(ik.stance_travel.shape[0]):
        travel = ik.stance_travel[k] + sideways * (ik.stance_travel_least[k] - ik.stance_travel[k])
        limit = min(limit, travel)
    return min(SWING_LAG * limit, neighbour_limit(start, extent, direction, legs))


@kernel
def neighbour_limit(start: Any, extent: Any, direction: float, legs: Any) -> float:
    """Return the stance travel at which a foot just reaches the one behind it, metres.

    Of two neighbours on a side, the front one that stands since an earlier touchdown has come back
    toward the hind one: by the lag of their touchdowns times the stride. Arthropods do not let
    their legs cross there; long upright legs pass beside each other.
    """
    limit = math.inf
    across = math.sin(direction)
    along = math.cos(direction)
    for back in range(legs.length.shape[0]):
        if legs.upright[back] or legs.side[back] == 0:
            continue
        for front in range(legs.length.shape[0]):
            if legs.side[front] != legs.side[back] or legs.row[front] != legs.row[back] + 1:
                continue
            duty = 1.0 - extent[back]
            lag = wrap_phase(start[back] + extent[back] - (start[front] + extent[front]))
            if lag < duty:
                gap = (legs.sole_stance[front, 2] - legs.sole_stance[back, 2]) * along
                gap += (legs.sole_stance[front, 0] - legs.sole_stance[back, 0]) * across
                limit = min(limit, abs(gap) / max(lag, 1e-3) * duty)
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
    c: int, dt: float, wishes_to_step: bool, state: Any, command: Any, tables: Any,
    settings: Any, scratch: Any,
) -> float:  # fmt: skip
    """Advance one creature's gait by `dt` seconds; return the needle's turn, cycles.

    `wishes_to_step` keeps the needle of a standing creature turning while a foot is off its place.
    The tempo is that of the speed now or soon: the first step of a walk is as quick as the second.
    """
    now = plan_pose(c, state)
    soon = predict(now, SOON * tables.pendulum_time, c, state, command, tables, settings)
    speed = max(
        fastest_foot_speed(c, now, state, command, tables),
        fastest_foot_speed(c, soon, state, command, tables),
    )
    aim = tempo(
        speed, tables.hip_height, tables.leg_length, tables.upright, command.gait_duty[c, 1],
        command.gait_duty[c, 2], stance_travel_limit(c, state, command, tables), command.period[c],
    )  # fmt: skip
    feet = state.swinging.shape[1]
    in_swing = 0
    for k in range(feet):
        if state.swinging[c, k]:
            in_swing += 1
    if not wishes_to_step and in_swing == 0:
        state.cycle_rate[c] = 0.0
        return 0.0
    period = aim.period
    if is_pushed(now.aside):
        period = max(period, quickest_period(c, now, aim.duty, state, command, tables))
    if math.isnan(command.period[c]):
        period /= 1.0 + state.hurry[c]
    state.cycle_rate[c] = 1.0 / period
    needle = turn_needle(state.needle[c], dt, period)
    state.hurry[c] *= math.exp(-needle.turn / HURRY_CYCLES)
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
