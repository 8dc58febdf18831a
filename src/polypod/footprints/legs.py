"""How a place lies to the other legs: none may be there, and legs should not cross (P1 5.1)."""

from __future__ import annotations

from polypod.compute import kernel
from polypod.footprints.settings import PlanSettings, StepRequest, foot_radius
from polypod.math.vec3 import Vec3
from polypod.paths.apart import LegsAhead, place_factor
from polypod.paths.check import leg_gap
from polypod.paths.scratch import OtherLegs

REJECTED = -1.0


@kernel
def leg_factor(
    settings: PlanSettings,
    request: StepRequest,
    legs: OtherLegs,
    legs_ahead: LegsAhead,
    place: Vec3,
) -> float:
    """Return 1, less where legs come near or cross, or REJECTED where another is in the place."""
    leg = request.leg_length
    foot = foot_radius(request)
    for s in range(request.other_foot_count):
        clear = legs.radius[s] + foot + settings.leg_gap * leg
        gap = leg_gap(legs, s, place.x, place.z)
        if gap < clear:
            at_start = leg_gap(legs, s, request.start_world.x, request.start_world.z)
            if gap < 0.999 * at_start:
                return REJECTED
    # Its own side of the body: no further across than the preferred place is out.
    side = request.side
    away = place - request.body_position
    out = away.x * side.x + away.z * side.z
    wanted = (request.preferred_world.x - request.body_position.x) * side.x + (
        request.preferred_world.z - request.body_position.z
    ) * side.z
    factor = place_factor(legs_ahead, request, place)
    return factor * settings.crossing if out < min(0.0, wanted) else factor
