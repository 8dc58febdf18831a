"""Which feet leave the ground, and for what: in turn, late, or out of turn (P1 3.2, 3.3)."""

from __future__ import annotations

import math
from typing import Any

from polypod.body.push import caught_at, is_pushed, load_deflection
from polypod.body.reach import shift_as_it_is
from polypod.compute import kernel
from polypod.controller.errand import Errand
from polypod.controller.feet import preferred_footprint
from polypod.controller.parting import MANY
from polypod.controller.rest import rest_offset
from polypod.controller.roll import plan_roll
from polypod.controller.steering import PlanPose
from polypod.controller.swing import begin_swing, swing_pace, wished_progress
from polypod.environment.table import surface
from polypod.gait.needle import swing_progress
from polypod.math.intervals import wrap_phase
from polypod.math.quat import load_quat
from polypod.math.vec3 import Vec3, length, load_vec3, store_vec3

# A leg that pulls at the body by so many leg lengths a frame may step out of turn, if it has stood
# for so many cycles and the creature hurries so much because its legs hold it back.
OUT_OF_TURN_PULL = 1e-3
# So may one that found no place in its turn, before it comes to that. It comes after those that
# pull, and the longer it waits the sooner: leg lengths for each second.
WAITING_PULL = 1e-9
OUT_OF_TURN_STOOD = 0.3
OUT_OF_TURN_HURRY = 0.02
# So may one that stands for so many cycles longer than in its gait, before it pulls: where its leg
# would come to its end within this share of a swing's time.
OVERDUE = 0.05
SOON = 0.12
# A foot that leaves before its turn lands in turn if its swing is longer by this share at most, and
# no longer than so many cycles.
LONGER = 0.8
LONGEST = 0.85
# Standing feet closer than this to their rest place stay, leg lengths.
IN_PLACE = 0.05
# Speeds below this, in leg lengths a pendulum time, are standing.
STILL = 1e-3
# A foot that finds no place looks farther and farther, up to so many times.
WIDEST_SEARCH = 2.6


@kernel
def is_moving(c: int, state: Any, tables: Any) -> bool:
    """Return whether the body moves or turns over the ground."""
    still = STILL * tables.leg_length / tables.pendulum_time
    turning = abs(state.turn_rate[c]) * tables.leg_length
    return abs(state.speed[c]) > still or turning > still


@kernel
def off_place(c: int, k: int, state: Any, tables: Any, settings: Any) -> bool:
    """Return whether a foot stands too far from its rest place under a standing body.

    Under one that is pushed that is the place from where it catches the body. Who stands because it
    makes no headway keeps its feet where they are.
    """
    aside = load_deflection(c, state)
    if state.halted[c] > 0.0 and not is_pushed(aside):
        return False
    caught = caught_at(aside, tables.recovery)
    heading = state.heading[c] - aside.heading + caught.heading
    offset = rest_offset(c, k, heading, state, tables, settings)
    # Against what it asked for: what it could not have then is no reason to step for ever.
    gap_x = state.position[c, 0] - aside.x + caught.x + offset.x - state.foot_preferred[c, k, 0]
    gap_z = state.position[c, 2] - aside.z + caught.z + offset.z - state.foot_preferred[c, k, 2]
    return math.hypot(gap_x, gap_z) > IN_PLACE * tables.legs.length[k]


@kernel
def any_off_place(c: int, state: Any, tables: Any, settings: Any) -> bool:
    """Return whether the creature wishes to step: it moves, or a foot is off its rest place."""
    if is_moving(c, state, tables):
        return True
    for k in range(state.swinging.shape[1]):
        if off_place(c, k, state, tables, settings):
            return True
    return False


@kernel
def seconds_to_touchdown(c: int, k: int, state: Any) -> float:
    """Return the seconds until a foot that lifts now shall land."""
    extent = state.swing_extent[c, k]
    gone = swing_progress(state.needle[c], state.swing_start[c, k], extent)
    seconds: float = (1.0 - max(gone, 0.0)) * extent / state.cycle_rate[c]
    return seconds


@kernel
def way_off(
    c: int, k: int, seconds: float, pose: PlanPose, state: Any, command: Any, tables: Any,
    settings: Any,
) -> Errand:  # fmt: skip
    """Return what a foot that lifts now is to do; one that waits for a place looks farther."""
    radius = settings.search_radius * tables.legs.length[k]
    waited = state.waiting[c, k] * state.cycle_rate[c]
    radius *= min(1.0 + waited * settings.wider_search, WIDEST_SEARCH)
    preferred = preferred_footprint(c, k, pose, seconds, state, command, tables, settings)
    return Errand(preferred, seconds, Vec3(0.0, 0.0, 0.0), 0.0, radius)


@kernel
def feet_needed(c: int, state: Any) -> int:
    """Return how many feet must stay down: the gait's own minimum, less those that reach.

    Of many feet half are enough: where a gait always has as many up as it may, one that is late
    keeps others down, and one that missed its turn would never get another.
    """
    count = state.swinging.shape[1]
    needed = state.least_down[c]
    if count > MANY:
        needed = min(needed, count // 2)
    for k in range(count):
        if state.reaching[c, k] and needed > 1:
            needed -= 1
    return int(needed)


@kernel
def note_standing(c: int, dt: float, turn: float, state: Any, tables: Any, settings: Any,
    scratch: Any) -> float:  # fmt: skip
    """Note in `scratch.held` which feet need not step; return how far back landings count, cycles.

    `turn` is how far the needle turned in this step, cycles: feet that land in this step count as
    standing already, so that feet can change places.
    """
    moving = is_moving(c, state, tables)
    landing = turn
    for k in range(state.swinging.shape[1]):
        scratch.held[k] = not moving and not off_place(c, k, state, tables, settings)
        gone = swing_progress(state.needle[c], state.swing_start[c, k], state.swing_extent[c, k])
        late = state.swinging[c, k] and gone < 0.0 and not state.reaching[c, k]
        if late and wished_progress(c, k, dt, state) < 1.0:
            landing = 0.0
    return landing


@kernel
def overdue(c: int, k: int, state: Any) -> bool:
    """Return whether a foot stands for longer than in its gait, and its turn is yet to come.

    So it is with one that swung while the gait changed: it landed by the old one, and its next turn
    is that of the new one.
    """
    due = wrap_phase(state.swing_start[c, k] - state.needle[c])
    late = state.stood[c, k] > 1.0 - state.swing_extent[c, k] + OVERDUE
    return bool(late and OVERDUE < due < 1.0 - OVERDUE)


@kernel
def ends_soon(c: int, k: int, dt: float, pose: PlanPose, state: Any, tables: Any) -> bool:
    """Return whether a leg would soon hold the body back.

    `pose` is where the body will be `dt` seconds from now; two such steps are foreseen at least.
    """
    if state.cycle_rate[c] <= 0.0:
        return False
    here = load_vec3(state.position[c])
    steps = max(SOON * state.swing_extent[c, k] / (state.cycle_rate[c] * dt), 2.0)
    ahead = Vec3(here.x + steps * (pose.x - here.x), here.y, here.z + steps * (pose.z - here.z))
    foot = load_vec3(state.foot[c, k])
    shift = shift_as_it_is(c, k, foot, state, tables, ahead, load_quat(state.rotation[c]))
    return length(shift) > OUT_OF_TURN_PULL * tables.leg_length


@kernel
def foot_out_of_turn(
    c: int, dt: float, pose: PlanPose, state: Any, tables: Any, scratch: Any
) -> int:
    """Return the foot that may take a quick step outside of its sector; as many as feet: none.

    That is the one that most holds the body back: its leg pulls hardest at a body that its legs
    have slowed down, because it missed its turn. Or one that soon would, for it is overdue. Or else
    one that found no place in its turn and still looks for one, or that of a slowed body which
    missed it for another reason: too few were down then. Where too few feet are down it waits.
    """
    # No foot: not a literal, or all that is called with it would be compiled twice.
    count = state.swinging.shape[1]
    worst = count
    down = 0
    most = 0.0
    for k in range(count):
        if state.swinging[c, k]:
            continue
        down += 1
        if scratch.held[k] or state.stood[c, k] < OUT_OF_TURN_STOOD:
            continue
        pull = state.pull[c, k]
        hurries = state.hurry[c] >= OUT_OF_TURN_HURRY
        if overdue(c, k, state) and ends_soon(c, k, dt, pose, state, tables):
            pull = max(pull, OUT_OF_TURN_PULL * tables.leg_length)
        elif pull < OUT_OF_TURN_PULL * tables.leg_length or not hurries:
            waits = state.waiting[c, k]
            due = wrap_phase(state.swing_start[c, k] - state.needle[c])
            missed = state.stood[c, k] > 1.0 - 0.5 * state.swing_extent[c, k]
            # One that is due soon waits, or it would step early ever after.
            if hurries and missed and due > 0.5 * state.swing_extent[c, k]:
                waits = max(waits, state.stood[c, k] / state.cycle_rate[c])
            pull = waits * WAITING_PULL * tables.leg_length
        if pull > most:
            most = pull
            worst = k
    return int(worst if down > feet_needed(c, state) else count)


@kernel
def swings_longer(c: int, k: int, state: Any) -> bool:
    """Have an overdue foot that leaves now land in turn; return False where that is too far off.

    For this swing its sector begins now. After a quick step it would be early ever after.
    """
    due = wrap_phase(state.swing_start[c, k] - state.needle[c])
    extent = state.swing_extent[c, k]
    if not overdue(c, k, state) or due > LONGER * extent or due + extent > LONGEST:
        return False
    state.swing_start[c, k] = state.needle[c]
    state.swing_extent[c, k] = due + extent
    return True


@kernel
def leave_ground(
    c: int, k: int, begun: float, state: Any, tables: Any, settings: Any, scratch: Any, env: Any
) -> None:
    """Put a foot on the path just planned, whose time begins at the needle's phase `begun`."""
    state.swinging[c, k] = True
    state.airborne[c, k] = 0.0
    begin_swing(c, k, begun, 0.0, state, settings, scratch)
    plan_roll(c, k, swing_pace(c, k, state), state, tables, scratch, env)
    state.waiting[c, k] = 0.0


@kernel
def wait_for_place(c: int, k: int, dt: float, preferred: Vec3, state: Any, env: Any) -> None:
    """Note for how long a foot has found no place, and where it would have liked to land."""
    state.waiting[c, k] += dt
    height, _ = surface(env, preferred.x, preferred.z)
    store_vec3(state.wish[c, k], Vec3(preferred.x, height, preferred.z))
