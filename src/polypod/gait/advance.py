"""One step of the gait manager: tempo, transition, needle (P1 3.3)."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from polypod.body.push import NO_DEFLECTION, is_pushed
from polypod.compute import kernel
from polypod.controller.rest import level_height
from polypod.controller.steering import CYCLE, PlanPose, plan_pose, predict
from polypod.controller.stride import SINK_CYCLES, travel_limit
from polypod.controller.swing import FASTEST_CATCH_UP
from polypod.gait.follow import duty_change, note_gait_speed, take_gait, wished_rung
from polypod.gait.needle import minimum_feet_down, turn_needle
from polypod.gait.tempo import tempo
from polypod.gait.transition import adopt_disks, align_cycle, approach_disks
from polypod.gait.variation import varied_period
from polypod.math.intervals import wrap_phase
from polypod.math.vec3 import load_vec3

# The duty factor follows speed within about so many cycles.
DUTY_CYCLES = 0.5
# How far ahead the tempo looks, leg pendulum times: about half a cycle.
SOON = 1.5
# A foot that has just lifted falls behind its body until it is as fast, and one that will land goes
# ahead: in a bell-shaped swing by .14 of a stride, times the share of the cycle for which it swings
# to this power. The leg is shorter meanwhile, and the body gives way: half of that counts.
SWING_LAG = 0.07
LAG_POWER = 1.5
# A front foot is out of the way of the one behind it when it has been up for so many cycles.
GONE = 0.1
# Strides are shortest on ground as steep, or as uneven in hip heights, as this; and get so within
# so many cycles.
STEEP = 0.3
ROUGH = 0.1
CAUTION_CYCLES = 1.0
# Cycles in which a hurry dies away once legs have room again.
HURRY_CYCLES = 3.0
# A balance step, twice as quick as the gait's, takes at least so many leg pendulum times; and the
# way back to the path is as fast as this share of the spring's rate times how far off it is.
QUICKEST_STEP = 0.45
WAY_BACK = math.exp(-1.0)


class Stride(NamedTuple):
    """How a creature is to step."""

    period: float  # s a cycle
    duty: float  # mean duty factor
    sink: float  # m by which its body is to be lower than it stands


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
            left = 1.0 - max(lag - duty, 0.0) / GONE
            if left > 0.0:
                gap = (legs.sole_stance[front, 2] - legs.sole_stance[back, 2]) * along
                gap += (legs.sole_stance[front, 0] - legs.sole_stance[back, 0]) * across
                limit = min(limit, abs(gap) / max(lag, 1e-3) * duty / left)
    return limit


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
def stance_share(duty: float) -> float:
    """Return the part of a leg's reach along the way that is left to the stance."""
    return duty / (duty + 2.0 * SWING_LAG * (1.0 - duty) ** LAG_POWER)


@kernel
def stride_of(
    speed: float, duty_low: float, duty_high: float, user_period: float, start: Any, extent: Any,
    direction: float, caution: float, yaw: float, hip_height: float, leg_length: float,
    upright: bool, legs: Any, stride: Any,
) -> Stride:  # fmt: skip
    """Return the stride at a speed: as an animal's would be, as far as the legs reach.

    Args:
        speed: m/s, of the fastest foot's rest place over the ground.
        duty_low: least mean duty factor.
        duty_high: greatest mean duty factor.
        user_period: s, the cycle's duration that the user wants, NaN: as an animal would.
        start: [K] the gait's disks.
        extent: [K] the gait's disks.
        direction: rad, of the travel from straight ahead.
        caution: share of what a lower body adds to a stride that is not taken.
        yaw: how much girdles of sprawling legs yaw by their feet, 1: as animals' do.
        hip_height: m, from the ground to the hips as the creature stands.
        leg_length: m, hip to sole along the leg.
        upright: legs stand below their hips.
        legs: a LegTable.
        stride: a StrideTable.
    """
    free = tempo(
        speed, hip_height, leg_length, upright, duty_low, duty_high, math.inf, user_period
    )  # fmt: skip
    # Legs reach farther from a lower body, which sinks as far as the stride needs it. Girdles that
    # yaw by their feet are half way back when one of a pair lands long before the other lifts.
    share = stance_share(free.duty)
    yaw *= min(1.0, 0.5 / free.duty) ** 2
    standing = share * travel_limit(0, direction, yaw, stride)
    lowest = max(share * travel_limit(1, direction, yaw, stride), standing)
    lowest += caution * (standing - lowest)
    most = neighbour_limit(start, extent, direction, legs)
    wished = min(speed * free.duty * free.period, most)
    travel = min(max(wished, standing), lowest)
    sink = (travel - standing) / max(lowest - standing, 1e-12) * stride.sink
    asked = tempo(
        speed, hip_height, leg_length, upright, duty_low, duty_high, min(travel, most), user_period
    )  # fmt: skip
    return Stride(asked.period, asked.duty, sink)


@kernel
def stride_at(c: int, speed: float, state: Any, command: Any, tables: Any, settings: Any) -> Stride:
    """Return a creature's stride at a speed, m/s.

    The gait is that of the state; what the user pins of it is kept, a duty within its range.
    """
    low = state.gait_duty[c, 1]
    high = state.gait_duty[c, 2]
    if not math.isnan(command.duty[c]):
        low = min(max(command.duty[c], low), high)
        high = low
    yaw = state.spine_share[c, 1, 0] * settings.spine_yaw
    return stride_of(
        speed, low, high, command.period[c], state.goal_start[c], state.goal_extent[c],
        command.travel[c], state.caution[c], yaw, tables.hip_height, tables.leg_length,
        tables.upright, tables.legs, tables.stride,
    )  # fmt: skip


@kernel
def wished_caution(c: int, state: Any, tables: Any) -> float:
    """Return how much shorter than on level ground a creature's strides are to be, 0 to 1.

    On steep ground, on things that lie about, and where feet stand or are about to land above or
    below the plane that they make together: people, dogs and horses shorten their strides there.
    """
    most = 0.0
    for k in range(state.swinging.shape[1]):
        place = load_vec3(state.foot[c, k])
        support = state.foot_support[c, k]
        if state.swinging[c, k]:
            place = load_vec3(state.foot_target[c, k])
            support = state.landing_support[c, k]
        if support >= 0:
            return 1.0
        most = max(most, abs(place.y - level_height(c, place.x, place.z, state)))
    steep = math.hypot(state.slope[c, 0], state.slope[c, 1])
    rough = most / (ROUGH * tables.hip_height) + steep / STEEP
    share = min(rough, 1.0)
    return share * share * (3.0 - 2.0 * share)


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
    alone = PlanPose(
        pose.x, pose.z, pose.heading, pose.turn_rate, pose.speed, pose.waypoint, pose.corner,
        pose.detour, pose.pace, NO_DEFLECTION,
    )  # fmt: skip
    speed = fastest_foot_speed(c, alone, state, command, tables)
    own = stride_at(c, speed, state, command, tables, settings)
    quickest = FASTEST_CATCH_UP * QUICKEST_STEP * tables.pendulum_time / (1.0 - duty)
    return min(quickest, own.period)


@kernel
def begin_transition(
    c: int, rung: int, duty: float, stood: bool, state: Any, command: Any, scratch: Any
) -> None:
    """Begin to change to the gait that was taken: its circle is turned to where it is nearest.

    Of a creature that `stood` all feet change at once, if its gait follows its speed: it begins
    its next walk with the slowest.
    """
    state.gait_number[c] = command.gait_number[c]
    state.rung[c] = rung
    at_once = stood and command.follows[c]
    state.blend_left[c] = 0.0 if at_once else command.blend_cycles[c]
    state.duty[c] = duty
    destination_disks(c, state, duty, scratch.start, scratch.extent)
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
