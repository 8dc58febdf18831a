"""Other creatures' legs and trunks, as a foot's planner sees them."""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.crowd.avoid import list_neighbours
from polypod.math.vec3 import Vec3, load_vec3, store_vec3

# Segments of other creatures that a plan heeds.
COMPANY_SEGMENTS = 48
# A leg counts whose foot is so near to the way there, leg lengths: its knee may be nearer.
BESIDE = 0.5


@kernel
def add_company(
    c: int, k: int, count: int, start: Vec3, preferred: Vec3, seconds: float, radius: float,
    state: Any, tables: Any, scratch: Any,
) -> int:  # fmt: skip
    """Add other creatures' legs and trunks to the `count` segments that foot `k` keeps clear of.

    Legs as they stand or will land, trunks where they will be in `seconds`; those that the foot
    could meet on its way to a place within `radius` m of the preferred one. Returns their number.
    """
    company = scratch.company
    plan = scratch.plan
    most = plan.other_a.shape[0]
    leg = tables.legs.length[k]
    near = list_neighbours(c, radius, state, scratch)
    for i in range(near):
        other = scratch.neighbour[i]
        if count < most:
            last = company.discs[other] - 1
            y = company.height[other, 0]
            move_x = company.velocity[other, 0] * seconds
            move_z = company.velocity[other, 1] * seconds
            for end in range(2):
                d = last if end == 1 else 0
                place = Vec3(
                    company.disc[other, d, 0] + move_x, y, company.disc[other, d, 1] + move_z
                )
                store_vec3((plan.other_a if end == 0 else plan.other_b)[count], place)
            plan.other_radius[count] = company.disc_radius[other]
            count += 1
        for m in range(company.first_leg[other], company.first_leg[other + 1]):
            sole = load_vec3(company.leg_sole[m])
            from_wish = math.hypot(sole.x - preferred.x, sole.z - preferred.z)
            from_start = math.hypot(sole.x - start.x, sole.z - start.z)
            near_end = from_wish < radius + BESIDE * leg
            if count < most and (near_end or from_start < BESIDE * leg):
                store_vec3(plan.other_a[count], sole)
                store_vec3(plan.other_b[count], load_vec3(company.leg_knee[m]))
                plan.other_radius[count] = company.leg_radius[m]
                count += 1
    return count


@kernel
def is_taken(c: int, k: int, state: Any, tables: Any, scratch: Any) -> bool:
    """Return whether another creature's foot stands, or will land, where a swinging foot will."""
    company = scratch.company
    foot = max(tables.legs.foot_half_size[k, 0], tables.legs.foot_half_size[k, 1])
    target = state.foot_target[c, k]
    near = list_neighbours(c, 0.0, state, scratch)
    for i in range(near):
        other = scratch.neighbour[i]
        for m in range(company.first_leg[other], company.first_leg[other + 1]):
            x = company.leg_sole[m, 0] - target[0]
            z = company.leg_sole[m, 2] - target[2]
            if math.hypot(x, z) < foot + company.leg_radius[m]:
                return True
    return False
