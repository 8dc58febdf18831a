"""How good a path is: its length, its bending, its acceleration (P1 section 5.2)."""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.footprints.settings import PlanSettings
from polypod.paths.curve import PATH_KNOTS
from polypod.paths.scratch import LiftScratch


@kernel
def plan_bending(lift: LiftScratch, points: int) -> float:
    """Return the sum of all turns of a path in plan, radians."""
    turns = 0.0
    for k in range(1, points - 1):
        ax = lift.plan[k, 0] - lift.plan[k - 1, 0]
        az = lift.plan[k, 1] - lift.plan[k - 1, 1]
        bx = lift.plan[k + 1, 0] - lift.plan[k, 0]
        bz = lift.plan[k + 1, 1] - lift.plan[k, 1]
        turns += abs(math.atan2(ax * bz - az * bx, ax * bx + az * bz))
    return turns


@kernel
def path_score_bound(
    settings: PlanSettings, direct: float, total: float, rise: float, bending: float
) -> float:
    """Return what a path can hardly exceed, judged by its plan alone: the 2D score of P1.

    `direct` and `total` are lengths in plan of the straight line and of the path, `rise` is the way
    up and down that both have in common (m); `bending` in radians.
    """
    whole = settings.weight_length + settings.weight_bending + settings.weight_acceleration
    shorter = min((math.hypot(direct, rise) + 1e-300) / (math.hypot(total, rise) + 1e-300), 1.0)
    score = settings.weight_length * shorter + settings.weight_acceleration
    return (score + settings.weight_bending / (1.0 + bending / (0.5 * math.pi))) / whole


@kernel
def path_score(settings: PlanSettings, lift: LiftScratch, points: int) -> float:
    """Return the score in [0, 1] of the lifted path: 1 for the direct, unhindered swing.

    Length and acceleration are compared with the step-height arc over the straight line; the
    acceleration is the mean square of second differences over knots.
    """
    last = points - 1
    direct = math.hypot(lift.plan[last, 0] - lift.plan[0, 0], lift.plan[last, 1] - lift.plan[0, 1])
    total = lift.plan[last, 2]
    scale = direct / total if total > 0.0 else 1.0
    longest = max(lift.station[PATH_KNOTS - 1], 1e-300)
    ideal_length = path_length = 0.0
    ideal_energy = path_energy = 1e-300
    for k in range(1, PATH_KNOTS):
        # A station is longer than the plan only for a step on the spot.
        along = (lift.station[k] - lift.station[k - 1]) * (total / longest)
        ideal_length += math.hypot(along * scale, lift.arc[k] - lift.arc[k - 1])
        dx = lift.knot[k, 0] - lift.knot[k - 1, 0]
        dz = lift.knot[k, 1] - lift.knot[k - 1, 1]
        dy = lift.height[k] - lift.height[k - 1]
        path_length += math.sqrt(dx * dx + dy * dy + dz * dz)
        if k < PATH_KNOTS - 1:
            after = (lift.station[k + 1] - lift.station[k]) * (total / longest)
            bend = lift.arc[k + 1] - 2.0 * lift.arc[k] + lift.arc[k - 1]
            ideal_energy += (after - along) * (after - along) * scale * scale + bend * bend
            bx = lift.knot[k + 1, 0] - lift.knot[k, 0] - dx
            bz = lift.knot[k + 1, 1] - lift.knot[k, 1] - dz
            by = lift.height[k + 1] - lift.height[k] - dy
            path_energy += bx * bx + by * by + bz * bz
    whole = settings.weight_length + settings.weight_bending + settings.weight_acceleration
    shorter = min((ideal_length + 1e-300) / (path_length + 1e-300), 1.0)
    smoother = min(math.sqrt(ideal_energy / path_energy), 1.0)
    bending = plan_bending(lift, points) / (0.5 * math.pi)
    score = settings.weight_length * shorter + settings.weight_acceleration * smoother
    return (score + settings.weight_bending / (1.0 + bending)) / whole
