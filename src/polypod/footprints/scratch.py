"""Memory that the planner works in: one for each thread, made once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.environment.maps import LocalMap, make_local_map
from polypod.footprints.settings import PlanSettings
from polypod.paths.apart import LegsAhead
from polypod.paths.curve import PathRow, path_store
from polypod.paths.scratch import GridScratch, LiftScratch, grid_scratch, lift_scratch

MAP_CELLS = 70  # most cells a side
SHORTER_STEPS = 4  # looked at where the preferred place is poor, as where legs would touch
# Of a place: solids near it, corners of a polygon, sides of what bears a foot.
MOST_NEAR, MOST_CORNERS, MOST_LINES = 128, 64, 128

# Rows of `PlanScratch.tally`.
TALLY_DIRECT = 0  # 1: the direct swing ended the search
TALLY_CANDIDATES = 1
TALLY_WAVEFRONTS = 2
TALLY_PATHS = 3  # 3D paths made
TALLY_PLACES = 4  # the most candidates that were there at once, of those in `CandidateScratch`


class CandidateScratch(NamedTuple):
    """Places for a foot; C is the candidate limit, the shorter steps and the preferred place."""

    cell: NDArray[np.int64]  # [n n, 2] row and column of cells that may accept a foot
    first_score: NDArray[np.float64]  # [n n] by the maps alone
    place: NDArray[np.float64]  # [C, 3] world, m; in descending order of score
    place_cell: NDArray[np.int64]  # [C, 2] row and column
    score: NDArray[np.float64]  # [C] in [0, 1]


class GroundScratch(NamedTuple):
    """Solids about a place, and what they cut of the foot's shape."""

    near: NDArray[np.int64]  # [N] solids
    corner: NDArray[np.float64]  # [2, V, 2] m: a polygon, and the same with a piece cut off
    line: NDArray[np.float64]  # [L, 3] sides of what bears the foot: normal a, b, and offset, m
    line_of: NDArray[np.int64]  # [L] the solid that each is of


class PlanScratch(NamedTuple):
    """Everything `plan_step` writes besides its answer; the caller fills the other legs."""

    other_a: NDArray[np.float64]  # [S, 3] world, m: ends of the other legs' segments
    other_b: NDArray[np.float64]  # [S, 3]
    other_radius: NDArray[np.float64]  # [S] m
    ahead: LegsAhead  # the legs as they will be
    window: LocalMap
    grid: GridScratch
    lift: LiftScratch
    found: CandidateScratch
    ground: GroundScratch
    trial: PathRow  # the path being tried
    tally: NDArray[np.int64]  # [5] what the last request took, for display and measurements


def make_plan_scratch(
    settings: PlanSettings, ahead: LegsAhead, company_segments: int = 0
) -> PlanScratch:
    """Return the memory for one thread.

    Args:
        settings: with the largest candidate and slice limits that will be asked for.
        ahead: the legs.
        company_segments: the most segments of other creatures.
    """
    n, other_segments = MAP_CELLS, len(ahead.leg) + company_segments
    places = settings.candidate_limit + 1 + SHORTER_STEPS
    return PlanScratch(
        other_a=np.zeros((other_segments, 3)),
        other_b=np.zeros((other_segments, 3)),
        other_radius=np.zeros(other_segments),
        ahead=ahead,
        window=make_local_map(n),
        grid=grid_scratch(n, settings.slice_limit + 1),
        lift=lift_scratch(),
        found=CandidateScratch(
            cell=np.zeros((n * n, 2), np.int64),
            first_score=np.zeros(n * n),
            place=np.zeros((places, 3)),
            place_cell=np.zeros((places, 2), np.int64),
            score=np.zeros(places),
        ),
        ground=ground_scratch(),
        trial=path_store(),
        tally=np.zeros(5, np.int64),
    )


class SeenPlaces(NamedTuple):
    """What the feet of one creature looked at when each was planned last, to be shown."""

    who: NDArray[np.int64]  # [1] whose feet are noted, -1: nobody's
    count: NDArray[np.int64]  # type: ignore[assignment]  # [K] places of each foot
    place: NDArray[np.float64]  # [K, C, 3] world, m
    score: NDArray[np.float64]  # [K, C] in [0, 1]


def seen_places(feet: int, places: int) -> SeenPlaces:
    """Return the memory for so many feet and places of each."""
    return SeenPlaces(
        who=np.full(1, -1, np.int64),
        count=np.zeros(feet, np.int64),
        place=np.zeros((feet, places, 3)),
        score=np.zeros((feet, places)),
    )


def ground_scratch() -> GroundScratch:
    """Return the memory in which places are judged."""
    return GroundScratch(
        near=np.zeros(MOST_NEAR, np.int64),
        corner=np.zeros((2, MOST_CORNERS, 2)),
        line=np.zeros((MOST_LINES, 3)),
        line_of=np.zeros(MOST_LINES, np.int64),
    )
