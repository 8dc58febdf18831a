"""The best pair of footprint and path for one foot's step (P1 section 5.2)."""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.environment.maps import LocalMap, fill_maps
from polypod.environment.table import EnvironmentTable, surface_at
from polypod.footprints.beside import is_open, try_beside
from polypod.footprints.candidates import close_cells, judge_candidates, judge_shorter, list_cells
from polypod.footprints.frame import foot_frame, legs_in, legs_out, path_out, places_out, request_in
from polypod.footprints.pair import NOTHING, POOR, try_direct, try_pair
from polypod.footprints.place import judge_place
from polypod.footprints.scratch import (
    MAP_CELLS,
    TALLY_CANDIDATES,
    TALLY_DIRECT,
    TALLY_PATHS,
    TALLY_PLACES,
    TALLY_WAVEFRONTS,
    PlanScratch,
    make_plan_scratch,
)
from polypod.footprints.settings import (
    DETOUR,
    PlanSettings,
    StepRequest,
    foot_shape,
    landing_time,
)
from polypod.math.vec3 import Vec3, load_vec3, store_vec3
from polypod.paths.curve import PathRow, copy_path
from polypod.paths.score import path_score_bound, plan_bending
from polypod.paths.scratch import OtherLegs
from polypod.paths.slices import OVER_ALL, place_slices, plan_layer, plan_top

__all__ = ["PlanScratch", "make_plan_scratch", "plan_step"]

# A path this good is the direct swing, unhindered.
UNHINDERED = 0.97
ROUNDS = 3


@kernel
def fill_window(
    env: EnvironmentTable, settings: PlanSettings, request: StepRequest, window: LocalMap
) -> None:
    """Fill the maps about the start and the search radius, with room for ways around."""
    start = request.start_world
    wanted = request.preferred_world
    radius = request.search_radius
    low_x = min(start.x, wanted.x - radius)
    high_x = max(start.x, wanted.x + radius)
    low_z = min(start.z, wanted.z - radius)
    high_z = max(start.z, wanted.z + radius)
    foot = max(request.foot_half_x, request.foot_half_z)
    side = max(high_x - low_x, high_z - low_z) + 2.0 * (DETOUR * request.leg_length + foot)
    cell = settings.cell * request.leg_length
    n = math.ceil(side / cell)
    if n > MAP_CELLS:
        n = MAP_CELLS
        cell = side / MAP_CELLS
    toe = settings.toe * request.leg_length
    # The map of where the middle of the foot's shape may be, then told by where its sole is.
    shape = foot_shape(request)
    fill_maps(
        env,
        window,
        0.5 * (low_x + high_x) + shape.middle_x,
        0.5 * (low_z + high_z) + shape.middle_z,
        cell,
        n,
        request.foot_half_x + toe,
        request.foot_half_z + toe,
        request.foot_yaw,
        landing_time(request),
    )
    window.place[0] -= shape.middle_x
    window.place[1] -= shape.middle_z


@kernel
def best_pair(
    env: EnvironmentTable,
    settings: PlanSettings,
    request: StepRequest,
    legs: OtherLegs,
    scratch: PlanScratch,
    kept: int,
    slices: int,
    best: float,
    path: PathRow,
) -> float:
    """Return the score of the best pair, its path written to `path`; `best` is what to beat.

    Places in descending order; for each the way over everything, then the ways around what is
    higher than a slice, from the top slice down. A pair is left as soon as it cannot win: by its
    place, by its path in plan, or by its path in 3D.
    """
    lift = scratch.lift
    window = scratch.window
    for k in range(kept):
        place_score = scratch.found.score[k]
        if (1.0 - settings.weight_path) * place_score + settings.weight_path <= best:
            break
        end = load_vec3(scratch.found.place[k])
        direct = math.hypot(end.x - request.start_world.x, end.z - request.start_world.z)
        top = 2.0 * OVER_ALL  # no path yet
        for layer in range(slices):
            level = scratch.grid.level[layer]
            if end.y > level:
                break
            if top <= level:
                continue  # the path of the slice above is already this low
            row = scratch.found.place_cell[k, 0]
            column = scratch.found.place_cell[k, 1]
            points = plan_layer(
                scratch.grid,
                lift,
                window.highest,
                window.place,
                window.size[0],
                layer,
                request.start_world,
                end,
                row,
                column,
            )
            if points == 0:
                break  # and no way in the slices below
            top = plan_top(window.highest, window.place, window.size[0], lift.plan, points)
            bound = path_score_bound(
                settings,
                direct,
                lift.plan[points - 1, 2],
                2.0 * request.step_height,
                plan_bending(lift, points),
            )
            if (1.0 - settings.weight_path) * place_score + settings.weight_path * bound <= best:
                continue
            scratch.tally[TALLY_PATHS] += 1
            pair, _ = try_pair(
                env, settings, request, legs, scratch.ahead, lift, points, end, place_score, best,
                scratch.trial,
            )  # fmt: skip
            if pair > best:
                best = pair
                copy_path(scratch.trial, path)
                if settings.first_pair:
                    return best
    return best


@kernel
def search(
    env: EnvironmentTable,
    settings: PlanSettings,
    scratch: PlanScratch,
    request: StepRequest,
    legs: OtherLegs,
    direct_score: float,
    best: float,
    path: PathRow,
) -> float:
    """Return the score of the best pair of candidate and path over the maps' grid.

    `direct_score` is the preferred place's own, negative where it cannot be stood on, and `best`
    what is to beat, whose path is in `path`.
    """
    start = request.start_world
    wanted = request.preferred_world
    y, _ = surface_at(env, wanted.x, wanted.z, landing_time(request))
    window = scratch.window
    fill_window(env, settings, request, window)
    close_cells(env, settings, request, legs, window, scratch.grid)
    cells = list_cells(settings, request, window, scratch.grid, scratch.found)
    kept = 0
    if direct_score >= 0.0:
        kept = 1
        scratch.found.score[0] = direct_score
        store_vec3(scratch.found.place[0], Vec3(wanted.x, y, wanted.z))
        scratch.found.place_cell[0, 0] = int((wanted.z - window.place[1]) / window.place[2])
        scratch.found.place_cell[0, 1] = int((wanted.x - window.place[0]) / window.place[2])
    if direct_score < POOR:
        kept = judge_shorter(
            env, settings, request, legs, scratch.ahead, window, scratch.ground, scratch.found, kept
        )
    # Where no pair of the first candidates is good, the next ones get their turn.
    for _ in range(ROUNDS):
        kept = judge_candidates(
            env,
            settings,
            request,
            legs,
            scratch.ahead,
            window,
            cells,
            scratch.ground,
            scratch.found,
            kept,
        )
        if kept == 0:
            continue
        scratch.tally[TALLY_PLACES] = max(scratch.tally[TALLY_PLACES], kept)
        slices = place_slices(
            scratch.grid,
            window.highest,
            window.place,
            window.size[0],
            scratch.found.place,
            kept,
            start,
            max(start.y, y),
            settings.slice_limit,
            settings.slice_thickness * request.step_height,
        )
        best = best_pair(env, settings, request, legs, scratch, kept, slices, best, path)
        scratch.tally[TALLY_CANDIDATES] += kept
        for layer in range(slices):
            scratch.tally[TALLY_WAVEFRONTS] += scratch.grid.spread[layer]
        if best >= POOR:
            break
        kept = 0
    return best


@kernel
def plan_step(
    env: EnvironmentTable,
    settings: PlanSettings,
    scratch: PlanScratch,
    request: StepRequest,
    path: PathRow,
) -> tuple[bool, float]:
    """Plan one foot's step: where it lands and how it gets there.

    First the direct swing to the preferred place itself, against the true shapes: on open ground
    that is all, and nothing snaps to a grid. Otherwise the maps are filled and pairs of candidate
    and path compete.

    Args:
        env: the world.
        settings: how thoroughly and how carefully.
        scratch: one thread's memory, with `request.other_foot_count` segments of other legs.
        request: the step.
        path: where the path is written; left as it is where none is found.

    Returns:
        Whether a valid pair was found, and its score in [0, 1]. If not, hold the foot and try again
        with a larger search radius.
    """
    legs = OtherLegs(scratch.other_a, scratch.other_b, scratch.other_radius)
    for k in range(scratch.tally.shape[0]):
        scratch.tally[k] = 0
    wanted = request.preferred_world
    best = NOTHING
    near = scratch.lift.near
    place_score, y = judge_place(
        env, settings, request, legs, scratch.ahead, scratch.ground, wanted.x, wanted.z
    )
    if place_score >= 0.0:
        end = Vec3(wanted.x, y, wanted.z)
        best, quality = try_direct(env, settings, request, legs, scratch, place_score, end, best)
        if best >= 0.0:
            copy_path(scratch.trial, path)
            good = min(place_score, best) >= settings.open_score
            unhindered = quality >= UNHINDERED and good
            if unhindered or settings.first_pair:
                scratch.tally[TALLY_DIRECT] = 1
                return True, best
    if not is_open(env, request, near):
        best = search(env, settings, scratch, request, legs, place_score, best, path)
        return best >= 0.0, max(best, 0.0)
    best = try_beside(env, settings, request, legs, scratch, best, path)
    if best >= 0.0:
        scratch.tally[TALLY_DIRECT] = 1
        return True, best
    frame = foot_frame(request)
    legs_in(frame, legs, request.other_foot_count)
    for k in range(5):
        scratch.ahead.frame[k] = frame[k]
    own = request_in(frame, request)
    best = search(env, settings, scratch, own, legs, place_score, best, path)
    legs_out(frame, legs, request.other_foot_count)
    places_out(frame, scratch.found.place, scratch.tally[TALLY_PLACES])
    scratch.ahead.frame[4] = 0.0
    if best >= 0.0:
        path_out(frame, path)
    return best >= 0.0, max(best, 0.0)
