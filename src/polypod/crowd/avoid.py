"""How a body keeps clear of other creatures' bodies: foresight in steering, and a bound on a step.

Reciprocal velocity obstacles, judged along a fan of courses: both of two that are on their way
take half of what it needs. What is foreseen has room for the feet too; who has waited long squeezes
by. The bound is on trunks alone and holds in any crowd: two bodies share what is between them, so
that they never meet however each moves.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.crowd.company import Company

# So many of the nearest others are heeded.
HEEDED = 12
# How far ahead, leg pendulum times.
FORESIGHT = 6.0
# Leg pendulum times of waiting after which half of the room for feet is given up.
PATIENCE = 6.0
# A creature that gets along so much slower than it would is waiting for others.
WAITING_PACE = 0.4
BOUND_PASSES = 3
TOUCH = 1e-6  # of their radii


@kernel
def list_neighbours(c: int, within: float, state: Any, scratch: Any) -> int:
    """List in `scratch.neighbour` the nearest others that are `within` m; return how many.

    From bound to bound, nearest first. Whoever can walk under another's belly does not count.
    """
    company = scratch.company
    if company.size[0] == 0:
        return 0
    me = state.member[c]
    x = company.centre[me, 0]
    z = company.centre[me, 1]
    reach = within + company.bound[me] + company.most[0]
    side = company.bucket_place[2]
    first_x = x - reach - company.bucket_place[0]
    first_z = z - reach - company.bucket_place[1]
    left = max(int(first_x / side), 0) if first_x > 0.0 else 0
    top = max(int(first_z / side), 0) if first_z > 0.0 else 0
    right = min(int((first_x + 2.0 * reach) / side), company.bucket_shape[1] - 1)
    bottom = min(int((first_z + 2.0 * reach) / side), company.bucket_shape[0] - 1)
    count = 0
    for line in range(top, bottom + 1):
        for column in range(left, right + 1):
            bucket = line * company.bucket_shape[1] + column
            for i in range(company.bucket_start[bucket], company.bucket_start[bucket + 1]):
                other = company.bucket_item[i]
                away = math.hypot(company.centre[other, 0] - x, company.centre[other, 1] - z)
                away -= company.bound[me] + company.bound[other]
                if other == me or away > within or passes_under(me, other, company):
                    continue
                at = min(count, HEEDED)
                while at > 0 and (
                    scratch.neighbour_gap[at - 1] > away
                    or (scratch.neighbour_gap[at - 1] == away and scratch.neighbour[at - 1] > other)
                ):
                    if at < HEEDED:
                        scratch.neighbour[at] = scratch.neighbour[at - 1]
                        scratch.neighbour_gap[at] = scratch.neighbour_gap[at - 1]
                    at -= 1
                if at < HEEDED:
                    scratch.neighbour[at] = other
                    scratch.neighbour_gap[at] = away
                    count = min(count + 1, HEEDED)
    return count


@kernel
def passes_under(me: int, other: int, company: Company) -> bool:
    """Return whether one of two trunks is higher than the other's back."""
    return bool(
        company.height[me, 0] > company.height[other, 1]
        or company.height[other, 0] > company.height[me, 1]
    )


@kernel
def threat(
    me: int, count: int, x: float, z: float, room: float, horizon: float, scratch: Any
) -> float:
    """Return how soon a velocity (world x, z, m/s) leads into another: 0 not, 1 at once.

    Between 1 and 2 where they are too near already, and come nearer. `count` neighbours are listed;
    `room` is the share of the room for feet that is kept, and `horizon` is in seconds.
    """
    company = scratch.company
    worst = 0.0
    for i in range(count):
        other = scratch.neighbour[i]
        share = 0.5 if company.goes[other] else 1.0
        own_x = company.velocity[me, 0]
        own_z = company.velocity[me, 1]
        to_x = (x - own_x) / share + own_x - company.velocity[other, 0]
        to_z = (z - own_z) / share + own_z - company.velocity[other, 1]
        square = to_x * to_x + to_z * to_z
        radius = company.disc_radius[me] + company.disc_radius[other]
        radius += room * (company.feet_room[me] + company.feet_room[other])
        for a in range(company.discs[me]):
            for b in range(company.discs[other]):
                gap_x = company.disc[other, b, 0] - company.disc[me, a, 0]
                gap_z = company.disc[other, b, 1] - company.disc[me, a, 1]
                nearing = gap_x * to_x + gap_z * to_z
                if nearing <= 0.0:
                    continue
                far = gap_x * gap_x + gap_z * gap_z
                beyond = far - radius * radius
                if beyond <= 0.0:
                    worst = max(worst, 1.0 + nearing / math.sqrt(far * square))
                    continue
                inside = nearing * nearing - square * beyond
                if inside > 0.0:
                    seconds = (nearing - math.sqrt(inside)) / square
                    worst = max(worst, 1.0 - seconds / horizon)
    return worst


@kernel
def step_nearer(
    me: int, a: int, x: float, z: float, turn: float, to_x: float, to_z: float, company: Company
) -> tuple[float, float, float, float]:
    """Return by how much a step brings a creature's disc `a` nearer to a place, m.

    The step is from where it was as the frame began to (x, z), turned by `turn`. Also how far the
    place was, and the direction to it (unit, world x and z).
    """
    out_x = company.disc[me, a, 0] - company.origin[me, 0]
    out_z = company.disc[me, a, 1] - company.origin[me, 1]
    sine = math.sin(turn)
    cosine = math.cos(turn) - 1.0
    step_x = x - company.origin[me, 0] + out_x * cosine + out_z * sine
    step_z = z - company.origin[me, 1] + out_z * cosine - out_x * sine
    gap_x = to_x - company.disc[me, a, 0]
    gap_z = to_z - company.disc[me, a, 1]
    away = max(math.hypot(gap_x, gap_z), 1e-12)
    gap_x /= away
    gap_z /= away
    return step_x * gap_x + step_z * gap_z, away, gap_x, gap_z


@kernel
def apart_from(
    c: int, count: int, x: float, z: float, heading: float, state: Any, scratch: Any
) -> tuple[float, float, bool]:
    """Return the place of a body, world x and z, at which its trunk meets no neighbour.

    `count` of them are listed. Since the frame began it may take half of what there was between any
    disc of its own and any of theirs, and all that there was to a foot of theirs. A place that is
    too near is moved aside; the third value says whether it is apart then.
    """
    company = scratch.company
    me = state.member[c]
    turn = heading - company.origin[me, 2]
    own = company.disc_radius[me]
    for attempt in range(BOUND_PASSES + 1):
        excess = 0.0
        for i in range(count):
            if scratch.neighbour_gap[i] > own:
                continue
            other = scratch.neighbour[i]
            discs = company.discs[other]
            first_leg = company.first_leg[other]
            for a in range(company.discs[me]):
                for b in range(discs + company.first_leg[other + 1] - first_leg):
                    if b < discs:
                        radius = own + company.disc_radius[other]
                        to_x = company.disc[other, b, 0]
                        to_z = company.disc[other, b, 1]
                    else:
                        leg = first_leg + b - discs
                        radius = own + company.leg_radius[leg]
                        to_x = company.leg_sole[leg, 0]
                        to_z = company.leg_sole[leg, 2]
                    nearer, away, gap_x, gap_z = step_nearer(me, a, x, z, turn, to_x, to_z, company)
                    nearer -= max((0.5 if b < discs else 1.0) * (away - radius), 0.0)
                    if nearer > 0.0:
                        excess = max(excess, nearer / own)
                        if attempt < BOUND_PASSES:
                            x -= nearer * gap_x
                            z -= nearer * gap_z
        if excess <= TOUCH:
            return x, z, True
    return x, z, False


@kernel
def note_yielding(c: int, dt: float, pace: float, state: Any) -> None:
    """Note for how long a creature has waited for others."""
    if pace < WAITING_PACE:
        state.yielded[c] += dt
    else:
        state.yielded[c] = max(state.yielded[c] - dt, 0.0)
