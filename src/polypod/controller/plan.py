"""Footprints and paths for the feet that need them in a step (P1 3.2, Fig 5).

One function calls the planner for them all.
"""

from __future__ import annotations

from typing import Any

from polypod.body.reach import may_drag
from polypod.body.support import foot_on_its_way
from polypod.compute import kernel
from polypod.controller.balance import foot_to_catch_with, is_due
from polypod.controller.feet import plan_foot, preferred_footprint
from polypod.controller.lift import (
    feet_needed,
    foot_out_of_turn,
    leave_ground,
    note_standing,
    seconds_to_touchdown,
    swings_longer,
    wait_for_place,
    way_off,
)
from polypod.controller.moving import foot_in_the_way, step_out, way_blocked
from polypod.controller.steering import PlanPose
from polypod.controller.swing import (
    FASTEST_CATCH_UP,
    is_held_up,
    swing_time_left,
    take_new_way,
    way_on,
    wishes_new_plan,
)
from polypod.crowd.legs import is_taken
from polypod.gait.needle import lift_phase, next_foot_to_lift, swing_progress

# A foot over a place that its leg does not reach is sent elsewhere after so many cycles.
OUT_OF_REACH = 0.08


@kernel
def hastens(c: int, k: int, state: Any) -> bool:
    """Return whether a foot should be down already, in a run: it keeps its plan.

    Planned anew and anew for a body that waits for nothing, it would never land.
    """
    gone = swing_progress(state.needle[c], state.swing_start[c, k], state.swing_extent[c, k])
    return bool(may_drag(c, state) and gone < 0.0)


@kernel
def plan_feet(
    c: int, dt: float, pose: PlanPose, state: Any, command: Any, tables: Any, settings: Any,
    env: Any, plan_settings: Any, scratch: Any,
) -> None:  # fmt: skip
    """Plan swinging feet anew whose world changed, and let the feet whose turn it is lift.

    A foot may lift late, inside a window of its disk; never where that would leave fewer feet down
    than the gait's own minimum. One that finds no place holds its own and looks farther next time.
    """
    for k in range(state.swinging.shape[1]):
        if not state.swinging[c, k] or state.reaching[c, k]:
            continue
        blocked = env.mover_count > 0 and way_blocked(c, k, state, tables, env)
        blocked = blocked or is_held_up(c, k, state)
        blocked = blocked or (state.crowded[c] and is_taken(c, k, state, tables, scratch))
        # A foot that was dragged along may not get to where it was to land.
        late = state.waiting[c, k] * state.cycle_rate[c]
        blocked = blocked or (may_drag(c, state) and late > OUT_OF_REACH)
        if not blocked and (
            state.swing_progress[c, k] > settings.replan_until or hastens(c, k, state)
        ):
            continue
        left = swing_time_left(c, k, state)
        preferred = preferred_footprint(c, k, pose, left, state, command, tables, settings)
        if not blocked and not wishes_new_plan(c, k, preferred, state, tables, settings):
            continue
        radius = settings.search_radius * tables.legs.length[k]
        errand = way_on(c, k, preferred, left, radius, state)
        counted = foot_on_its_way(c, k, state)
        if plan_foot(
            c, k, dt, pose, errand, state, command, tables, settings, env, plan_settings, scratch
        ):
            take_new_way(c, k, errand.launch, counted, state, settings, scratch)
    landing = note_standing(c, dt, state.turn[c], state, tables, settings, scratch)
    searching = True
    first = 0
    while searching:
        k = foot_in_the_way(c, first, state, tables, env)
        in_turn = False
        if k < state.swinging.shape[1]:
            first = k + 1
            step_out(c, k, state, tables, env)
        else:
            k = foot_to_catch_with(c, pose, state, command, tables, settings, scratch)
            in_turn = is_due(c, k, state, settings)
        if k == state.swinging.shape[1]:
            k = next_foot_to_lift(
                state.needle[c], state.swing_start[c], state.swing_extent[c], state.swinging[c],
                state.stood[c], scratch.held, feet_needed(c, state), settings.late_lift, landing,
            )  # fmt: skip
            in_turn = k >= 0
            searching = in_turn
        if k < 0:
            k = foot_out_of_turn(c, dt, pose, state, tables, scratch)
            if k == state.swinging.shape[1]:
                break
            in_turn = swings_longer(c, k, state)
        scratch.held[k] = True
        begun = state.needle[c]
        seconds = state.swing_extent[c, k] / (FASTEST_CATCH_UP * state.cycle_rate[c])
        if in_turn:
            begun = lift_phase(state.needle[c], state.turn[c], state.swing_start[c, k])
            seconds = seconds_to_touchdown(c, k, state)
        errand = way_off(c, k, seconds, pose, state, command, tables, settings)
        if plan_foot(
            c, k, dt, pose, errand, state, command, tables, settings, env, plan_settings, scratch
        ):
            leave_ground(c, k, begun, state, tables, settings, scratch, env)
        else:
            wait_for_place(c, k, dt, errand.preferred, state, env)
