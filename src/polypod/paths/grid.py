"""Ways through the obstacles' map: wavefront, line of sight, and the path's cells (P1 section 4).

A cell is blocked in a slice where it is closed or higher than the slice's level. Two cells are
neighbours along rows, columns and diagonals; a diagonal needs both cells beside it, and a line of
sight through the corner of four cells needs all of them, so that both agree on what is free.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.paths.scratch import BUCKETS, GridScratch

STRAIGHT = 10
DIAGONAL = 14
# What a step away from a cell beside a blocked one costs more: paths keep off obstacles.
POTENTIAL = 6
CORNER_TIE = 1e-9  # cells


@kernel
def is_blocked(closed: Any, highest: Any, level: float, row: int, column: int) -> bool:
    """Return whether feet may not pass a cell in the slice."""
    return closed[row, column] or highest[row, column] > level


@kernel
def step_of(direction: int) -> tuple[int, int]:
    """Return the step in rows and columns to neighbour 0 to 7; even ones are straight."""
    if direction == 0:
        return 0, 1
    if direction == 1:
        return 1, 1
    if direction == 2:
        return 1, 0
    if direction == 3:
        return 1, -1
    if direction == 4:
        return 0, -1
    if direction == 5:
        return -1, -1
    if direction == 6:
        return -1, 0
    return -1, 1


@kernel
def spread_wavefront(
    grid: GridScratch, highest: Any, n: int, layer: int, start_row: int, start_column: int
) -> None:
    """Write the cheapest cost and the way from the start to every cell of a slice.

    Costs are small integers, so that the front lives in a ring of buckets (Dial's algorithm)
    rather than in a heap. The start is left even if it is blocked itself. Near blocked cells every
    step costs more: the potential field.
    """
    level = grid.level[layer]
    distance = grid.distance[layer]
    parent = grid.parent[layer]
    closed = grid.closed
    for row in range(n):
        for column in range(n):
            distance[row, column] = -1
    for bucket in range(BUCKETS):
        grid.first[bucket] = -1
    grid.entry[0, 0] = -1
    grid.entry[0, 1] = start_row
    grid.entry[0, 2] = start_column
    grid.first[0] = 0
    distance[start_row, start_column] = 0
    parent[start_row, start_column] = 0
    entries = 1
    waiting = 1
    cost = 0
    while waiting > 0:
        ring = cost % BUCKETS
        item = grid.first[ring]
        if item < 0:
            cost += 1
            continue
        grid.first[ring] = grid.entry[item, 0]
        waiting -= 1
        row = grid.entry[item, 1]
        column = grid.entry[item, 2]
        if distance[row, column] != cost:
            continue
        # Bit d tells that neighbour d is free.
        free = 0
        count = 0
        for direction in range(8):
            d_row, d_column = step_of(direction)
            r = row + d_row
            c = column + d_column
            if r < 0 or c < 0 or r >= n or c >= n:
                count += 1
                continue
            if not is_blocked(closed, highest, level, r, c):
                free |= 1 << direction
                count += 1
        beside = cost if count == 8 else cost + POTENTIAL
        for direction in range(8):
            if not free >> direction & 1:
                continue
            reached = beside + STRAIGHT
            if direction & 1:
                both = 1 << (direction - 1) | 1 << (direction + 1 & 7)
                if free & both != both:
                    continue
                reached = beside + DIAGONAL
            d_row, d_column = step_of(direction)
            r = row + d_row
            c = column + d_column
            if distance[r, c] >= 0 and distance[r, c] <= reached:
                continue
            distance[r, c] = reached
            parent[r, c] = direction
            ring = reached % BUCKETS
            grid.entry[entries, 0] = grid.first[ring]
            grid.entry[entries, 1] = r
            grid.entry[entries, 2] = c
            grid.first[ring] = entries
            entries += 1
            waiting += 1
    grid.spread[layer] = 1


@kernel
def trace_cells(grid: GridScratch, layer: int, row: int, column: int) -> int:
    """Write the cells from (row, column) back to the start and return how many; 0: no way."""
    distance = grid.distance[layer]
    if distance[row, column] < 0:
        return 0
    count = 0
    while True:
        grid.cells[count, 0] = row
        grid.cells[count, 1] = column
        count += 1
        if distance[row, column] == 0:
            return count
        d_row, d_column = step_of(grid.parent[layer, row, column])
        row -= d_row
        column -= d_column


@kernel
def line_of_sight(
    closed: Any, highest: Any, level: float, n: int, u0: float, v0: float, u1: float, v1: float
) -> bool:
    """Return whether no blocked cell meets the segment from (u0, v0) to (u1, v1).

    Places are in cells: u along columns, v along rows. Supercover traversal: every cell the
    segment touches counts. The cell of the first point is left out: a foot may leave where it is.
    """
    column = min(max(math.floor(u0), 0), n - 1)
    row = min(max(math.floor(v0), 0), n - 1)
    last_column = min(max(math.floor(u1), 0), n - 1)
    last_row = min(max(math.floor(v1), 0), n - 1)
    step_column = 1 if u1 > u0 else -1
    step_row = 1 if v1 > v0 else -1
    size_u = abs(u1 - u0)
    size_v = abs(v1 - v0)
    # Where along the segment the next column and the next row begin.
    next_u = (column + 1 - u0 if step_column > 0 else u0 - column) / size_u if size_u > 0.0 else 2.0
    next_v = (row + 1 - v0 if step_row > 0 else v0 - row) / size_v if size_v > 0.0 else 2.0
    delta_u = 1.0 / size_u if size_u > 0.0 else 0.0
    delta_v = 1.0 / size_v if size_v > 0.0 else 0.0
    steps = abs(last_column - column) + abs(last_row - row)
    while steps > 0:
        at_corner = column != last_column and row != last_row and abs(next_u - next_v) < CORNER_TIE
        if at_corner:
            if is_blocked(closed, highest, level, row, column + step_column) or is_blocked(
                closed, highest, level, row + step_row, column
            ):
                return False
            column += step_column
            row += step_row
            next_u += delta_u
            next_v += delta_v
            steps -= 2
        elif row == last_row or (column != last_column and next_u < next_v):
            column += step_column
            next_u += delta_u
            steps -= 1
        else:
            row += step_row
            next_v += delta_v
            steps -= 1
        if is_blocked(closed, highest, level, row, column):
            return False
    return True


@kernel
def highest_on_line(highest: Any, n: int, u0: float, v0: float, u1: float, v1: float) -> float:
    """Return the highest cell near the segment, sampled every half cell; places as above."""
    samples = int(2.0 * math.hypot(u1 - u0, v1 - v0)) + 2
    top = -1e300
    for k in range(samples):
        share = k / (samples - 1.0)
        column = min(max(math.floor(u0 + (u1 - u0) * share), 0), n - 1)
        row = min(max(math.floor(v0 + (v1 - v0) * share), 0), n - 1)
        top = max(top, highest[row, column])
    return top
