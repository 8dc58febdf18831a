"""Places beside the preferred one on open ground, where only legs can be in the way."""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.environment.table import EnvironmentTable
from polypod.footprints.pair import NOTHING, try_pair
from polypod.footprints.place import LOWEST, judge_place
from polypod.footprints.scratch import TALLY_PATHS, PlanScratch
from polypod.footprints.settings import PlanSettings, StepRequest
from polypod.math.vec3 import Vec3
from polypod.paths.curve import PathRow, copy_path
from polypod.paths.lift import straight_plan
from polypod.paths.near import obstacles_near
from polypod.paths.scratch import OtherLegs

# Places on each of so many rings within the search radius.
BESIDE_RINGS = 3
BESIDE_PLACES = 8


@kernel
def is_open(env: EnvironmentTable, request: StepRequest, near: Any) -> bool:
    """Return whether nothing but level ground is within the search radius and the way there."""
    if env.terrain_range[0] != env.terrain_range[1] or env.water.shape[0] > 0:
        return False
    x0 = min(request.start_world.x, request.preferred_world.x) - request.search_radius
    x1 = max(request.start_world.x, request.preferred_world.x) + request.search_radius
    z0 = min(request.start_world.z, request.preferred_world.z) - request.search_radius
    z1 = max(request.start_world.z, request.preferred_world.z) + request.search_radius
    return obstacles_near(env, x0, z0, x1, z1, LOWEST, near) == 0


@kernel
def try_beside(
    env: EnvironmentTable,
    settings: PlanSettings,
    request: StepRequest,
    legs: OtherLegs,
    scratch: PlanScratch,
    path: PathRow,
) -> float:
    """Return the score of the first possible pair beside the preferred place, or NOTHING.

    On open ground only the leg itself and other legs are in the way. The places lie about the
    preferred one in the foot's own axes, outward first: no grid, so that a walk that is turned or
    mirrored is the same walk.
    """
    sine = math.sin(request.foot_yaw)
    cosine = math.cos(request.foot_yaw)
    side = request.side.x * cosine - request.side.z * sine
    outward = 1.0 if side >= 0.0 else -1.0
    for ring in range(1, BESIDE_RINGS + 1):
        away = ring / BESIDE_RINGS * 0.9 * request.search_radius
        for k in range(BESIDE_PLACES):
            # Outward, then alternately ahead and behind, inward last.
            turn = (k + 1) // 2 * (2.0 * math.pi / BESIDE_PLACES) * (1.0 if k % 2 == 1 else -1.0)
            across = math.cos(turn) * away * outward
            along = math.sin(turn) * away
            x = request.preferred_world.x + across * cosine + along * sine
            z = request.preferred_world.z - across * sine + along * cosine
            score, y = judge_place(env, settings, request, legs, scratch.lift.near, x, z)
            if score < 0.0:
                continue
            end = Vec3(x, y, z)
            points = straight_plan(scratch.lift, request.start_world, end)
            scratch.tally[TALLY_PATHS] += 1
            best, _ = try_pair(
                env,
                settings,
                request,
                legs,
                scratch.lift,
                points,
                end,
                score,
                NOTHING,
                scratch.trial,
            )
            if best >= 0.0:
                copy_path(scratch.trial, path)
                return best
    return NOTHING
