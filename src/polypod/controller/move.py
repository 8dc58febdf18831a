"""The body's step on the plane: steered, refined by its feet, bounded by other bodies (P1 3.2)."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.push import hold_back, is_pushed, load_deflection, moved_aside
from polypod.compute import kernel
from polypod.controller.balance import brace
from polypod.controller.course import choose_course
from polypod.controller.propulsion import propulsion
from polypod.controller.retreat import note_caught, way_back
from polypod.controller.steering import PlanPose, plan_pose, steer
from polypod.crowd.avoid import FORESIGHT, apart_from, list_neighbours, note_yielding


@kernel
def feedback(c: int, state: Any, tables: Any, settings: Any) -> tuple[float, float]:
    """Return the velocity, world x and z, by which the body follows its feet (P1 3.2, Fig 7).

    The mean offset of the chosen footprints from the preferred ones, discarded while it is small
    for this morphology, made up at a share of it a gait cycle.
    """
    count = state.swinging.shape[1]
    x = 0.0
    z = 0.0
    for k in range(count):
        x += (state.foot_target[c, k, 0] - state.foot_preferred[c, k, 0]) / count
        z += (state.foot_target[c, k, 2] - state.foot_preferred[c, k, 2]) / count
    size = math.hypot(x, z)
    threshold = settings.feedback_threshold * tables.leg_length
    if size <= threshold:
        return 0.0, 0.0
    share = settings.feedback_share * state.cycle_rate[c] * (1.0 - threshold / size)
    return x * share, z * share


@kernel
def look_round(c: int, state: Any, command: Any, tables: Any, settings: Any, scratch: Any) -> int:
    """List the creatures that may come into a creature's way in the scratch; return how many."""
    state.crowded[c] = False
    if scratch.company.size[0] == 0 or settings.personal_space <= 0.0:
        return 0
    fastest = max(command.speed[c], state.speed[c]) + scratch.company.most[1]
    within = FORESIGHT * tables.pendulum_time * fastest
    near = list_neighbours(c, max(within, tables.leg_length), state, scratch)
    state.crowded[c] = near > 0 and scratch.neighbour_gap[0] < tables.leg_length
    return near


@kernel
def move_body(
    c: int, dt: float, state: Any, command: Any, tables: Any, settings: Any, env: Any, scratch: Any
) -> PlanPose:
    """Return the pose on the plane at the end of the frame: steered, and refined by the feet."""
    near = look_round(c, state, command, tables, settings, scratch)
    state.detour[c], state.pace[c] = choose_course(
        c, near, state, command, tables, settings, env, scratch
    )
    note_yielding(c, dt, state.pace[c], state)
    if state.halted[c] > 0.0:
        # It does not turn about for a way out either.
        state.detour[c] = 0.0
        state.pace[c] = 0.0
    note_caught(c, dt, state, tables, env)
    back_x, back_z = way_back(c, state, tables, settings)
    if state.caught[c] > 0:
        state.pace[c] = 0.0
    here = plan_pose(c, state)
    driven = propulsion(c, state, scratch)
    pose = steer(here, c, state, command, tables, settings, dt, driven)
    shift_x, shift_z = feedback(c, state, tables, settings)
    shift_x += back_x
    shift_z += back_z
    x = pose.x + shift_x * dt
    z = pose.z + shift_z * dt
    aside = pose.aside
    if is_pushed(aside):
        aside = brace(c, dt, aside, state, tables)
        x += aside.x - pose.aside.x
        z += aside.z - pose.aside.z
        # Feet that step aside to catch it take it along, and not its path.
        aside = moved_aside(aside, shift_x * dt, shift_z * dt)
    heading = pose.heading
    turn_rate = pose.turn_rate
    speed = pose.speed
    if near > 0:
        free_x, free_z, apart = apart_from(c, near, x, z, heading, state, scratch)
        if not apart:
            free_x = here.x
            free_z = here.z
            heading = state.heading[c]
            turn_rate = 0.0
        asked = math.hypot(x - here.x, z - here.z)
        left = math.hypot(free_x - here.x, free_z - here.z)
        speed *= min(left / max(asked, 1e-12), 1.0)
        was = load_deflection(c, state)
        turned = 1.0 if apart else 0.0
        course = heading - aside.heading + command.travel[c]
        way = 0.5 * (state.speed[c] + speed) * dt
        aside = hold_back(was, aside, x - free_x, z - free_z, turned, course, way, dt, tables)
        x = free_x
        z = free_z
    return PlanPose(
        x,
        z,
        heading,
        turn_rate,
        speed,
        pose.waypoint,
        pose.corner,
        pose.detour,
        pose.pace,
        aside,
        pose.gone,
    )
