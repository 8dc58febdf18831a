"""Places beside the preferred one on open ground, where only legs can be in the way."""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.environment.table import EnvironmentTable
from polypod.footprints.frame import foot_frame, turn_out
from polypod.footprints.pair import POOR, try_direct
from polypod.footprints.place import LOWEST, judge_place
from polypod.footprints.scratch import PlanScratch
from polypod.footprints.settings import DETOUR, PlanSettings, StepRequest
from polypod.math.vec3 import Vec3
from polypod.paths.curve import PathRow, copy_path
from polypod.paths.near import obstacles_near
from polypod.paths.scratch import OtherLegs

# Places on each of so many rings within the search radius.
BESIDE_RINGS = 3
BESIDE_PLACES = 8
# A later place must be better by so much: rounding shall not choose between twins.
TIE = 1e-6


@kernel
def is_open(env: EnvironmentTable, request: StepRequest, near: Any) -> bool:
    """Return whether nothing but level ground is wherever a place or a way may be looked for.

    In any direction about the preferred place, so that the answer does not depend on the axes.
    """
    if env.terrain_range[0] != env.terrain_range[1] or env.water.shape[0] > 0:
        return False
    start = request.start_world
    wanted = request.preferred_world
    foot = max(request.foot_half_x, request.foot_half_z)
    around = request.search_radius + DETOUR * request.leg_length + foot
    around += math.hypot(start.x - wanted.x, start.z - wanted.z)
    x0 = wanted.x - around
    x1 = wanted.x + around
    z0 = wanted.z - around
    z1 = wanted.z + around
    return obstacles_near(env, x0, z0, x1, z1, LOWEST, near) == 0


@kernel
def try_beside(
    env: EnvironmentTable,
    settings: PlanSettings,
    request: StepRequest,
    legs: OtherLegs,
    scratch: PlanScratch,
    best: float,
    path: PathRow,
) -> float:
    """Return the score of the best pair on the first ring about the preferred place that has one.

    It is better than `best`; where there is none that is returned, and `path` is left as it is.

    On open ground only the leg itself and other legs are in the way. The places lie about the
    preferred one in the foot's own axes, outward first: no grid, so that a walk that is turned or
    mirrored is the same walk.
    """
    frame = foot_frame(request)
    before = best
    for ring in range(1, BESIDE_RINGS + 1):
        away = ring / BESIDE_RINGS * 0.9 * request.search_radius
        for k in range(BESIDE_PLACES):
            # Outward, then alternately ahead and behind, inward last.
            turn = (k + 1) // 2 * (2.0 * math.pi / BESIDE_PLACES) * (1.0 if k % 2 == 1 else -1.0)
            offset = turn_out(frame, Vec3(math.cos(turn) * away, 0.0, math.sin(turn) * away))
            x = request.preferred_world.x + offset.x
            z = request.preferred_world.z + offset.z
            score, y = judge_place(
                env, settings, request, legs, scratch.ahead, scratch.lift.near, x, z
            )
            if score < 0.0:
                continue
            end = Vec3(x, y, z)
            least = best + TIE if best >= 0.0 else best
            pair, _ = try_direct(env, settings, request, legs, scratch, score, end, least)
            if pair > least:
                copy_path(scratch.trial, path)
                best = pair
        if best > before and best >= POOR:
            break
    return best
