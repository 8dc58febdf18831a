"""One step of the gait manager: tempo, transition, needle (P1 3.3)."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.push import is_pushed
from polypod.compute import kernel
from polypod.controller.steering import CYCLE, PlanPose, plan_pose, predict, unpushed
from polypod.controller.stride import SINK_CYCLES
from polypod.controller.swing import FASTEST_CATCH_UP
from polypod.gait.follow import PINNED, duty_change, note_gait_speed, take_gait, wished_rung
from polypod.gait.needle import minimum_feet_down, turn_needle
from polypod.gait.stride import Stride, stride_at, wished_caution
from polypod.gait.transition import adopt_disks, align_cycle, approach_disks
from polypod.gait.variation import varied_period
from polypod.math.intervals import wrap_phase

# The duty factor follows speed within about so many cycles.
DUTY_CYCLES = 0.5
# How far ahead the tempo looks, leg pendulum times: about half a cycle.
SOON = 1.5
# Strides get shorter or longer with the ground within so many cycles.
CAUTION_CYCLES = 1.0
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
    # Girdles that go where the head went do not swing sideways, and the head turns first.
    swing = aside.rate_heading if state.led[c] else turn_rate
    if state.led[c]:
        turn_rate = max(abs(turn_rate), abs(state.front_rate[c]))
    most = 0.0
    for k in range(legs.length.shape[0]):
        across = legs.sole_stance[k, 0] + state.spacing[c, k, 0]
        along = legs.sole_stance[k, 2] + state.spacing[c, k, 1]
        # Heading turns +Z toward +X: a place at +X moves backward.
        forward = pose.speed + push_ahead - turn_rate * across
        sideways = push_left + swing * along
        most = max(most, math.hypot(forward, sideways))
    if is_pushed(aside):
        most = math.hypot(most, WAY_BACK * tables.recovery * math.hypot(aside.x, aside.z))
    return most


@kernel
def destination_disks(c: int, state: Any, duty: float, start_out: Any, extent_out: Any) -> None:
    """Write the disks of the gait that a creature walks in at a mean duty factor, [K] each."""
    for k in range(start_out.shape[0]):
        foot_duty = state.gait_share[c, k] * duty
        touchdown = state.gait_touchdown[c, k]
        touchdown += state.gait_lag[c, k] * (duty - state.gait_duty[c, 0])
        start_out[k] = wrap_phase(touchdown + foot_duty)
        extent_out[k] = 1.0 - foot_duty


@kernel
def asked_stride(
    c: int, now: PlanPose, state: Any, command: Any, tables: Any, settings: Any
) -> Stride:
    """Return the stride at the speed now or soon: a walk's first step is as quick as its second."""
    soon = predict(now, SOON * tables.pendulum_time, c, state, command, tables, settings)
    speed = max(
        fastest_foot_speed(c, now, state, command, tables),
        fastest_foot_speed(c, soon, state, command, tables),
    )
    return stride_at(c, speed, state, command, tables, settings)


@kernel
def quickest_period(
    c: int, pose: PlanPose, duty: float, state: Any, command: Any, tables: Any, settings: Any
) -> float:
    """Return the shortest cycle of a pushed creature, s: legs have their own pendulum's time.

    Who is asked to walk quicker than that keeps its tempo.
    """
    speed = fastest_foot_speed(c, unpushed(pose), state, command, tables)
    own = stride_at(c, speed, state, command, tables, settings)
    quickest = FASTEST_CATCH_UP * QUICKEST_STEP * tables.pendulum_time / (1.0 - duty)
    return min(quickest, own.period)


@kernel
def begin_transition(
    c: int, rung: int, duty: float, stood: bool, state: Any, command: Any, scratch: Any
) -> None:
    """Begin to change to the gait that was taken: its circle is turned to where it is nearest.

    Not where the user drew one gait out of the other: all other feet would be turned about with
    what was drawn. Of a creature that `stood` all feet change at once, if its gait follows its
    speed: it begins its next walk with the slowest.
    """
    pinned = rung == PINNED or state.rung[c] == PINNED
    state.gait_number[c] = command.gait_number[c]
    state.rung[c] = rung
    at_once = stood and command.follows[c]
    state.blend_left[c] = 0.0 if at_once else command.blend_cycles[c]
    state.duty[c] = duty
    destination_disks(c, state, duty, scratch.start, scratch.extent)
    if not (pinned and command.same_circle[c]):
        state.needle[c] = align_cycle(
            state.needle[c], state.swing_start[c], state.goal_start[c], state.lift_phase[c],
            scratch.start, scratch.extent,
        )  # fmt: skip


@kernel
def advance_gait(
    c: int, dt: float, wishes_to_step: bool, state: Any, command: Any, tables: Any,
    settings: Any, scratch: Any,
) -> float:  # fmt: skip
    """Advance one creature's gait by `dt` seconds; return the needle's turn, cycles.

    `wishes_to_step` keeps the needle of a standing creature turning while a foot is off its place.
    """
    now = plan_pose(c, state)
    note_gait_speed(c, now.speed, dt * state.cycle_rate[c], state)
    rung = wished_rung(c, state, command, tables)
    changes = rung != state.rung[c] or state.gait_number[c] != command.gait_number[c]
    if changes:
        take_gait(c, rung, state, command, tables)
    aim = asked_stride(c, now, state, command, tables, settings)
    feet = state.swinging.shape[1]
    in_swing = 0
    for k in range(feet):
        if state.swinging[c, k]:
            in_swing += 1
    if not wishes_to_step and in_swing == 0:
        state.cycle_rate[c] = 0.0
        rise = dt / (CYCLE * tables.pendulum_time) * tables.stride.sink
        state.sink[c] = max(state.sink[c] - rise, 0.0)
        if changes and command.follows[c]:
            begin_transition(c, rung, aim.duty, True, state, command, scratch)
        return 0.0
    period = aim.period
    if is_pushed(now.aside):
        period = max(period, quickest_period(c, now, aim.duty, state, command, tables, settings))
    if math.isnan(command.period[c]):
        period /= 1.0 + state.hurry[c]
    if settings.stride_variation > 0.0:
        period = varied_period(c, dt, period, state, settings)
    stood = state.cycle_rate[c] <= 0.0
    state.cycle_rate[c] = 1.0 / period
    needle = turn_needle(state.needle[c], dt, period)
    state.hurry[c] *= math.exp(-needle.turn / HURRY_CYCLES)
    state.needle[c] = needle.needle
    state.duty[c] += duty_change(
        c, aim.duty - state.duty[c], needle.turn, DUTY_CYCLES, state, command
    )
    state.caution[c] += (wished_caution(c, state, tables) - state.caution[c]) * (
        1.0 - math.exp(-needle.turn / CAUTION_CYCLES)
    )
    state.sink[c] += (aim.sink - state.sink[c]) * (1.0 - math.exp(-needle.turn / SINK_CYCLES))
    if changes:
        begin_transition(c, rung, aim.duty, stood, state, command, scratch)
    destination_disks(c, state, state.duty[c], scratch.start, scratch.extent)
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
