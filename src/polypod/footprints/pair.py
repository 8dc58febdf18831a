"""One pair of footprint and path: made in three dimensions, scored, checked (P1 section 5.2)."""

from __future__ import annotations

from polypod.compute import kernel
from polypod.environment.table import EnvironmentTable
from polypod.footprints.scratch import TALLY_PATHS, PlanScratch
from polypod.footprints.settings import PlanSettings, StepRequest, foot_radius
from polypod.math.vec3 import Vec3, length_plan
from polypod.paths.apart import LegsAhead, path_factor, strains_hip
from polypod.paths.check import chords_clear, deepest, meets_legs, out_of_reach
from polypod.paths.curve import PATH_KNOTS, PathRow
from polypod.paths.lift import BLEND, SHORTEST, arc_start, lift_path, place_knots, straight_plan
from polypod.paths.score import path_score
from polypod.paths.scratch import LiftScratch, OtherLegs

NOTHING = -1.0
# A pair that scores less, as where legs would touch, is taken only if farther places do no better.
POOR = 0.5
# A way that is so many times as long as the straight one goes round something.
ROUND = 1.1


@kernel
def try_pair(
    env: EnvironmentTable,
    settings: PlanSettings,
    request: StepRequest,
    legs: OtherLegs,
    legs_ahead: LegsAhead,
    lift: LiftScratch,
    points: int,
    end: Vec3,
    place_score: float,
    best: float,
    trial: PathRow,
) -> tuple[float, float]:
    """Return the scores of the pair and of its path; NOTHING if it cannot win or is impossible.

    `lift.plan[:points]` holds the path in plan to `end`. The finished path, in `trial`, is checked
    against the true shapes; where it touches them it is raised there once.
    """
    phase, height = arc_start(env, request, end.y)
    leg = request.leg_length
    foot = foot_radius(request)
    place_knots(lift, points, request.start_world, end, SHORTEST * leg, phase, height)
    for k in range(PATH_KNOTS):
        lift.extra[k] = 0.0
    blend = BLEND
    for _ in range(2):
        if not lift_path(env, settings, request, lift, blend, trial):
            return NOTHING, 0.0
        quality = path_score(settings, lift, points)
        pair = (1.0 - settings.weight_path) * place_score + settings.weight_path * quality
        if pair <= best or out_of_reach(request, settings.reach, trial):
            return NOTHING, 0.0
        if meets_legs(legs, request.other_foot_count, foot + settings.leg_gap * leg, trial):
            return NOTHING, 0.0
        detour = lift.plan[points - 1, 2] > ROUND * length_plan(end - request.start_world)
        if detour and strains_hip(legs_ahead, request, trial):
            return NOTHING, 0.0
        # It poses legs: after what costs less to find out.
        pair *= path_factor(legs_ahead, request, trial)
        if pair <= best:
            return NOTHING, 0.0
        if deepest(env, settings.penetration * leg, request, trial, lift.extra) <= 0.0:
            if not chords_clear(env, settings.chord * leg, request, trial):
                return NOTHING, 0.0
            return pair, quality
        blend *= 0.25
    return NOTHING, 0.0


@kernel
def try_direct(
    env: EnvironmentTable,
    settings: PlanSettings,
    request: StepRequest,
    legs: OtherLegs,
    scratch: PlanScratch,
    place_score: float,
    end: Vec3,
    best: float,
) -> tuple[float, float]:
    """Return what `try_pair` does for the straight way to a place; its path is in the trial."""
    points = straight_plan(scratch.lift, request.start_world, end)
    scratch.tally[TALLY_PATHS] += 1
    return try_pair(
        env, settings, request, legs, scratch.ahead, scratch.lift, points, end, place_score, best,
        scratch.trial,
    )  # fmt: skip
