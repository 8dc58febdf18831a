"""The cheapest way from a place to all others: a wave over the map of what is passable."""

from __future__ import annotations

from polypod.compute import kernel
from polypod.paths.grid import DIAGONAL, STRAIGHT, step_of
from polypod.paths.scratch import BUCKETS
from polypod.routes.passable import NARROW, enter, room_at
from polypod.routes.state import RouteScratch

# What a step over no ground costs more, and one in a narrow place; a straight one costs 10, and all
# together must be fewer than there are buckets.
GAP_TOLL = 3
SQUEEZE_TOLL = 14


@kernel
def spread(
    route: RouteScratch, row: int, column: int, level: float, to_row: int, to_column: int
) -> None:
    """Write cost, level and direction of the cheapest way from a cell to all cells.

    The body starts over ground of height `level`, m. The wave ends at (to_row, to_column); where
    there is no such cell (-1) it goes everywhere. Costs are small integers: Dial's ring of buckets.
    A cell is entered at the height of the cheapest way to it; of two as cheap, the first.
    """
    n = route.window.size[0]
    cell = route.window.place[2]
    for i in range(n):
        for j in range(n):
            route.distance[i, j] = -1
    for bucket in range(BUCKETS):
        route.first[bucket] = -1
    route.entry[0, 0] = -1
    route.entry[0, 1] = row
    route.entry[0, 2] = column
    route.first[0] = 0
    route.distance[row, column] = 0
    route.level[row, column] = level
    route.gap[row, column] = 0.0
    entries = 1
    waiting = 1
    cost = 0
    while waiting > 0:
        item = route.first[cost % BUCKETS]
        if item < 0:
            cost += 1
            continue
        route.first[cost % BUCKETS] = route.entry[item, 0]
        waiting -= 1
        row = route.entry[item, 1]
        column = route.entry[item, 2]
        if route.distance[row, column] != cost:
            continue
        if row == to_row and column == to_column:
            return
        level = route.level[row, column]
        gap = route.gap[row, column]
        for direction in range(8):
            d_row, d_column = step_of(direction)
            r = row + d_row
            c = column + d_column
            if r < 0 or c < 0 or r >= n or c >= n:
                continue
            reached = cost + (DIAGONAL if direction & 1 else STRAIGHT)
            known = route.distance[r, c]
            if known >= 0 and known <= reached:
                continue
            length = cell * (1.4142135623730951 if direction & 1 else 1.0)
            free, there, gone = enter(route, r, c, level, gap, length)
            if free and direction & 1:
                # A diagonal needs both cells beside it.
                free, _, _ = enter(route, row, c, level, gap, cell)
                if free:
                    free, _, _ = enter(route, r, column, level, gap, cell)
            if not free:
                continue
            if gone > 0.0:
                reached += GAP_TOLL
            if room_at(route, r, c, there) == NARROW:
                reached += SQUEEZE_TOLL
            if known >= 0 and known <= reached:
                continue
            route.distance[r, c] = reached
            route.parent[r, c] = direction
            route.level[r, c] = there
            route.gap[r, c] = gone
            bucket = reached % BUCKETS
            route.entry[entries, 0] = route.first[bucket]
            route.entry[entries, 1] = r
            route.entry[entries, 2] = c
            route.first[bucket] = entries
            entries += 1
            waiting += 1


@kernel
def trace(route: RouteScratch, row: int, column: int) -> int:
    """Write the cells from (row, column) back to the wave's start; return how many there are."""
    count = 0
    while True:
        route.cells[count, 0] = row
        route.cells[count, 1] = column
        count += 1
        if route.distance[row, column] == 0:
            return count
        d_row, d_column = step_of(route.parent[row, column])
        row -= d_row
        column -= d_column
