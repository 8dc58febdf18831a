"""How a place lies to the other legs: none may be there, and legs should not cross (P1 5.1)."""

from __future__ import annotations

from polypod.compute import kernel
from polypod.footprints.settings import PlanSettings, StepRequest
from polypod.math.vec3 import Vec3
from polypod.paths.check import leg_gap
from polypod.paths.scratch import OtherLegs

REJECTED = -1.0


@kernel
def crosses_leg(legs: OtherLegs, s: int, hip: Vec3, x: float, z: float) -> bool:
    """Return whether, in plan, the line from the hip to the place crosses leg segment `s`."""
    ax = legs.a[s, 0]
    az = legs.a[s, 2]
    bx = legs.b[s, 0]
    bz = legs.b[s, 2]
    side_a = (x - hip.x) * (az - hip.z) - (z - hip.z) * (ax - hip.x)
    side_b = (x - hip.x) * (bz - hip.z) - (z - hip.z) * (bx - hip.x)
    if side_a * side_b >= 0.0:
        return False
    side_hip = (bx - ax) * (hip.z - az) - (bz - az) * (hip.x - ax)
    side_foot = (bx - ax) * (z - az) - (bz - az) * (x - ax)
    return side_hip * side_foot < 0.0


@kernel
def leg_factor(
    settings: PlanSettings, request: StepRequest, legs: OtherLegs, x: float, z: float
) -> float:
    """Return 1, the factor for crossed legs, or REJECTED where another leg is in the place."""
    leg = request.leg_length
    foot = max(request.foot_half_x, request.foot_half_z)
    factor = 1.0
    for s in range(request.other_foot_count):
        clear = legs.radius[s] + foot + settings.leg_gap * leg
        gap = leg_gap(legs, s, x, z)
        if gap < clear:
            at_start = leg_gap(legs, s, request.start_world.x, request.start_world.z)
            if gap < 0.999 * at_start:
                return REJECTED
        if crosses_leg(legs, s, request.hip_touchdown, x, z):
            factor = settings.crossing
    # Its own side of the body: no further across than the preferred place is out.
    side = request.side
    out = (x - request.body_position.x) * side.x + (z - request.body_position.z) * side.z
    wanted = (request.preferred_world.x - request.body_position.x) * side.x + (
        request.preferred_world.z - request.body_position.z
    ) * side.z
    return min(factor, settings.crossing) if out < min(0.0, wanted) else factor
