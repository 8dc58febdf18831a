"""Candidate places out of the maps: where feet may land, best first, spread in space (P1 5.1)."""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.environment.maps import LocalMap
from polypod.environment.table import EnvironmentTable, is_forbidden
from polypod.footprints.place import judge_place
from polypod.footprints.scratch import SHORTER_STEPS, CandidateScratch, GroundScratch
from polypod.footprints.settings import PlanSettings, StepRequest, foot_radius
from polypod.math.vec3 import Vec3, distance, load_vec3, mix, store_vec3
from polypod.paths.apart import LegsAhead
from polypod.paths.check import leg_gap
from polypod.paths.scratch import GridScratch, OtherLegs

# A cell's offer stays this far inside it, cells: lookup and traversal then agree on its cell.
INSET = 0.02
# Places picked for each one kept: some that the maps allow fail the exact test.
PICKS = 2
# The shortest of the shorter steps that are looked at: share of the way back.
SHORTEST = 0.7
STRUCK = -1e300  # the first score of a cell that is out
# What a cell counts less where a wide foot would stand on an edge: it comes after all others.
ON_EDGE = 10.0


@kernel
def close_cells(
    env: EnvironmentTable,
    settings: PlanSettings,
    request: StepRequest,
    legs: OtherLegs,
    window: LocalMap,
    grid: GridScratch,
) -> None:
    """Write which cells feet may not pass: forbidden ones and the other legs' projections.

    The cells about the start are closed only if their middle truly is: the foot stands there.
    """
    n = window.size[0]
    cell = window.place[2]
    for row in range(n):
        for column in range(n):
            grid.closed[row, column] = window.forbidden[row, column]
    foot = foot_radius(request)
    for s in range(request.other_foot_count):
        clear = legs.radius[s] + foot + settings.leg_gap * request.leg_length
        low_x = min(legs.a[s, 0], legs.b[s, 0]) - clear - window.place[0]
        high_x = max(legs.a[s, 0], legs.b[s, 0]) + clear - window.place[0]
        low_z = min(legs.a[s, 2], legs.b[s, 2]) - clear - window.place[1]
        high_z = max(legs.a[s, 2], legs.b[s, 2]) + clear - window.place[1]
        for row in range(max(int(low_z / cell), 0), min(int(high_z / cell) + 1, n)):
            z = window.place[1] + (row + 0.5) * cell
            for column in range(max(int(low_x / cell), 0), min(int(high_x / cell) + 1, n)):
                x = window.place[0] + (column + 0.5) * cell
                if leg_gap(legs, s, x, z) < clear:
                    grid.closed[row, column] = True
    start_row = int((request.start_world.z - window.place[1]) / cell)
    start_column = int((request.start_world.x - window.place[0]) / cell)
    for row in range(max(start_row - 1, 0), min(start_row + 2, n)):
        z = window.place[1] + (row + 0.5) * cell
        for column in range(max(start_column - 1, 0), min(start_column + 2, n)):
            x = window.place[0] + (column + 0.5) * cell
            if grid.closed[row, column]:
                grid.closed[row, column] = is_forbidden(env, x, z, 0.0)


@kernel
def offer(window: LocalMap, row: int, column: int, wanted: Vec3) -> Vec3:
    """Return the point of a cell that is nearest in plan to the preferred place; y is 0."""
    cell = window.place[2]
    low_x = window.place[0] + (column + INSET) * cell
    low_z = window.place[1] + (row + INSET) * cell
    size = (1.0 - 2.0 * INSET) * cell
    x = min(max(wanted.x, low_x), low_x + size)
    return Vec3(x, 0.0, min(max(wanted.z, low_z), low_z + size))


@kernel
def list_cells(
    settings: PlanSettings,
    request: StepRequest,
    window: LocalMap,
    grid: GridScratch,
    found: CandidateScratch,
) -> int:
    """Write the cells that may accept a foot, with a first score, and return how many."""
    n = window.size[0]
    cell = window.place[2]
    leg = request.leg_length
    wanted = request.preferred_world
    offset = request.effector_offset_touchdown
    leaving_offset = request.effector_offset_end_of_stance
    foot = max(request.foot_half_x, request.foot_half_z)
    level = settings.uneven * leg + settings.uneven_foot * foot
    tolerance = level + settings.slope * 1.5 * cell
    first_row = max(int((wanted.z - request.search_radius - window.place[1]) / cell), 0)
    last_row = min(int((wanted.z + request.search_radius - window.place[1]) / cell), n - 1)
    first = max(int((wanted.x - request.search_radius - window.place[0]) / cell), 0)
    last = min(int((wanted.x + request.search_radius - window.place[0]) / cell), n - 1)
    count = 0
    for row in range(first_row, last_row + 1):
        for column in range(first, last + 1):
            if grid.closed[row, column] or window.wet[row, column]:
                continue
            high = window.highest[row, column]
            step = high - window.lowest[row, column]
            if step > tolerance:
                continue
            point = offer(window, row, column, wanted)
            away = math.hypot(point.x - wanted.x, point.z - wanted.z)
            if away > request.search_radius:
                continue
            place = Vec3(point.x, high, point.z)
            landing = distance(place + offset, request.hip_touchdown)
            leaving = distance(place + leaving_offset, request.hip_end_of_stance)
            stretch = max(landing, leaving) - request.reach_comfort_max
            if landing > request.reach_max + cell:
                continue
            score = settings.weight_distance * (1.0 - away / request.search_radius)
            score += settings.weight_edge * 0.5 * min(window.edge_distance[row, column], 2.0)
            if stretch > 0.0:
                room = max(request.reach_max - request.reach_comfort_max, stretch)
                score -= settings.weight_reach * stretch / room
            rise = abs(high - request.level_height) / (settings.rise * leg)
            score -= request.level_weight * min(rise, 1.0)
            # A foot wider than two cells that is over an edge somewhere in a cell mostly is so in
            # all of it. Lizards' took all picks in vain: among low crates every cell seems even.
            if foot > cell and step > level:
                score -= ON_EDGE
            found.cell[count, 0] = row
            found.cell[count, 1] = column
            found.first_score[count] = score
            count += 1
    return count


@kernel
def rule_out(
    window: LocalMap, found: CandidateScratch, cells: int, wanted: Vec3, point: Vec3, spacing: float
) -> None:
    """Strike the listed cells whose offer is nearer than `spacing` (m) to a place taken."""
    for k in range(cells):
        other = offer(window, found.cell[k, 0], found.cell[k, 1], wanted)
        if math.hypot(other.x - point.x, other.z - point.z) < spacing:
            found.first_score[k] = STRUCK


@kernel
def keep_place(
    found: CandidateScratch, kept: int, score: float, place: Vec3, row: int, column: int
) -> None:
    """Insert a place among the `kept` ones, which stay in descending order of score."""
    at = kept
    while at > 0 and found.score[at - 1] < score:
        found.score[at] = found.score[at - 1]
        for axis in range(3):
            found.place[at, axis] = found.place[at - 1, axis]
        for axis in range(2):
            found.place_cell[at, axis] = found.place_cell[at - 1, axis]
        at -= 1
    found.score[at] = score
    store_vec3(found.place[at], place)
    found.place_cell[at, 0] = row
    found.place_cell[at, 1] = column


@kernel
def judge_shorter(
    env: EnvironmentTable,
    settings: PlanSettings,
    request: StepRequest,
    legs: OtherLegs,
    legs_ahead: LegsAhead,
    window: LocalMap,
    ground: GroundScratch,
    found: CandidateScratch,
    kept: int,
) -> int:
    """Judge places on the way to the preferred one, where the leg ahead is not yet away from.

    Returns how many places are kept. Legs of one side step into each other's places: a shorter
    step keeps clear where one to the sides of the place does not.
    """
    cell = window.place[2]
    wanted = request.preferred_world
    for k in range(1, SHORTER_STEPS + 1):
        if kept >= found.score.shape[0]:
            break
        point = mix(wanted, request.start_world, SHORTEST * k / SHORTER_STEPS)
        if math.hypot(point.x - wanted.x, point.z - wanted.z) > request.search_radius:
            break
        row = int((point.z - window.place[1]) / cell)
        column = int((point.x - window.place[0]) / cell)
        score, y = judge_place(env, settings, request, legs, legs_ahead, ground, point.x, point.z)
        if score >= 0.0:
            keep_place(found, kept, score, Vec3(point.x, y, point.z), row, column)
            kept += 1
    return kept


@kernel
def judge_candidates(
    env: EnvironmentTable,
    settings: PlanSettings,
    request: StepRequest,
    legs: OtherLegs,
    legs_ahead: LegsAhead,
    window: LocalMap,
    cells: int,
    ground: GroundScratch,
    found: CandidateScratch,
    kept: int,
) -> int:
    """Judge the best of the listed cells exactly, spread in space; return how many places are kept.

    `found.place[:kept]` already holds the preferred place if that can be stood on. Each pick rules
    out the cells about it, or the best would crowd into one patch. A cell offers its point nearest
    to the preferred place, or else its middle.
    """
    cell = window.place[2]
    spacing = settings.candidate_spacing * request.leg_length
    limit = min(settings.candidate_limit, found.score.shape[0] - 1 - SHORTER_STEPS)
    room = min(kept + limit, found.score.shape[0])
    if kept > 0:
        rule_out(window, found, cells, request.preferred_world, load_vec3(found.place[0]), spacing)
    for _ in range(PICKS * limit):
        best = -1
        for k in range(cells):
            if found.first_score[k] > STRUCK and (
                best < 0 or found.first_score[k] > found.first_score[best]
            ):
                best = k
        if best < 0 or kept >= room:
            break
        row = found.cell[best, 0]
        column = found.cell[best, 1]
        found.first_score[best] = STRUCK
        point = offer(window, row, column, request.preferred_world)
        score, y = judge_place(env, settings, request, legs, legs_ahead, ground, point.x, point.z)
        if score < 0.0:
            x = window.place[0] + (column + 0.5) * cell
            point = Vec3(x, 0.0, window.place[1] + (row + 0.5) * cell)
            score, y = judge_place(
                env, settings, request, legs, legs_ahead, ground, point.x, point.z
            )
        if score < 0.0:
            continue
        rule_out(window, found, cells, request.preferred_world, point, spacing)
        keep_place(found, kept, score, Vec3(point.x, y, point.z), row, column)
        kept += 1
    return kept
