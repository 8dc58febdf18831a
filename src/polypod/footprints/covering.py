"""Whether solids together bear a foot's whole shape: convex polygons that must leave no gap."""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.environment.convex import ROUND_SAG
from polypod.environment.shapes import BOX, SPHERE
from polypod.environment.table import EnvironmentTable, FloatArray
from polypod.footprints.cut import Cut, bound, cut_of
from polypod.footprints.scratch import GroundScratch
from polypod.footprints.settings import Tread

# Lengths below this share of the foot's are rounding.
TOUCH = 1e-9
# What `gather_lines` answers in place of a number of lines.
WHOLE = -1  # the polygon has all of the shape
TOO_MANY = -2


@kernel
def is_covered(env: EnvironmentTable, tread: Tread, count: int, ground: GroundScratch) -> bool:
    """Return whether solids that reach up to the plane cover all of the foot's shape.

    Each covers a convex polygon. What polygons leave uncovered has corners of its own: of the
    shape, where a polygon's side leaves the shape, or where sides of two polygons cross. If each of
    these lies inside yet another polygon, nothing is uncovered.
    """
    lines = 0
    for i in range(count):
        o = ground.near[i]
        last = gather_lines(env, tread, o, lines, ground)
        if last == WHOLE:
            return True
        if last == TOO_MANY:
            return False
        lines = last
    for v in range(4):
        a = tread.half_a if v % 2 == 0 else -tread.half_a
        b = tread.half_b if v < 2 else -tread.half_b
        if not in_polygon(ground, lines, a, b, -1, -1, TOUCH * tread.half_a):
            return False
    for i in range(lines):
        for j in range(lines + 4):
            if j >= lines:
                a, b, cross = cross_side(tread, ground.line, i, j - lines)
                other = -1
            elif j <= i or ground.line_of[i] == ground.line_of[j]:
                continue
            else:
                a, b, cross = cross_lines(tread, ground.line, i, j)
                other = ground.line_of[j]
            if cross and not in_polygon(
                ground, lines, a, b, ground.line_of[i], other, TOUCH * tread.half_a
            ):
                return False
    return True


@kernel
def gather_lines(
    env: EnvironmentTable, tread: Tread, o: int, lines: int, ground: GroundScratch
) -> int:
    """Add to the scratch the sides, in the foot's shape, of the polygon where `o` bears it.

    Returns how many lines there are then, as many as before where it bears none of the shape; or
    WHOLE or TOO_MANY.
    """
    cut = cut_of(env, tread, o)
    level = -tread.tolerance
    if env.kind[o] == SPHERE:
        # Convex: it bears all if it bears the corners, and what it bears else is left out.
        return WHOLE if ball_bears(env, tread, cut, o) else lines
    # Of a round one, the prism inside it.
    sag = 0.0 if env.kind[o] == BOX else ROUND_SAG * env.half_size[o, 0]
    sides = env.footprint_count[o]
    last = lines
    for k in range(sides + env.plane_count[o]):
        g, h, room = bound(env, tread, cut, o, k, level)
        if k < sides:
            room += tread.gap - sag
        elif k < sides + env.plane_count[o] - 2 and room < math.inf:
            room -= sag / env.planes[o, k - sides, 1]
        reach = abs(g) * tread.half_a + abs(h) * tread.half_b
        if reach <= room:
            continue
        if -reach > room:
            return lines
        if last >= ground.line.shape[0]:
            return TOO_MANY
        size = math.hypot(g, h)
        ground.line[last, 0] = g / size
        ground.line[last, 1] = h / size
        ground.line[last, 2] = room / size
        ground.line_of[last] = o
        last += 1
    return WHOLE if last == lines else last


@kernel
def ball_bears(env: EnvironmentTable, tread: Tread, cut: Cut, o: int) -> bool:
    """Return whether a sphere reaches up to the plane, less the tolerance, at all corners."""
    off_x = env.position[o, 0] - cut.middle.x
    off_z = env.position[o, 2] - cut.middle.z
    middle_a = off_x * cut.a_x + off_z * cut.a_z
    middle_b = off_x * cut.b_x + off_z * cut.b_z
    height = env.position[o, 1] - cut.middle.y - tread.y + tread.tolerance
    for v in range(4):
        a = tread.half_a if v % 2 == 0 else -tread.half_a
        b = tread.half_b if v < 2 else -tread.half_b
        room = env.half_size[o, 0] ** 2 - (a - middle_a) ** 2 - (b - middle_b) ** 2
        if room < 0.0:
            return False
        if height + math.sqrt(room) < tread.slope_a * a + tread.slope_b * b:
            return False
    return True


@kernel
def cross_lines(tread: Tread, line: FloatArray, i: int, j: int) -> tuple[float, float, bool]:
    """Return where two lines cross, and whether they do in the foot's shape."""
    size = line[i, 0] * line[j, 1] - line[i, 1] * line[j, 0]
    if abs(size) < TOUCH:
        return 0.0, 0.0, False
    a = (line[i, 2] * line[j, 1] - line[j, 2] * line[i, 1]) / size
    b = (line[i, 0] * line[j, 2] - line[j, 0] * line[i, 2]) / size
    return a, b, abs(a) <= tread.half_a and abs(b) <= tread.half_b


@kernel
def cross_side(tread: Tread, line: FloatArray, i: int, side: int) -> tuple[float, float, bool]:
    """Return where a line crosses a side of the foot's shape, and whether it does."""
    sign = 1.0 if side % 2 == 0 else -1.0
    if side < 2:
        a = sign * tread.half_a
        if abs(line[i, 1]) < TOUCH:
            return 0.0, 0.0, False
        b = (line[i, 2] - line[i, 0] * a) / line[i, 1]
        return a, b, abs(b) <= tread.half_b
    b = sign * tread.half_b
    if abs(line[i, 0]) < TOUCH:
        return 0.0, 0.0, False
    a = (line[i, 2] - line[i, 1] * b) / line[i, 0]
    return a, b, abs(a) <= tread.half_a


@kernel
def in_polygon(
    ground: GroundScratch, lines: int, a: float, b: float, but: int, nor: int, inside: float
) -> bool:
    """Return whether a place is `inside` metres within a polygon of other solids than two."""
    k = 0
    while k < lines:
        o = ground.line_of[k]
        within = o != but and o != nor
        while k < lines and ground.line_of[k] == o:
            gap = ground.line[k, 2] - ground.line[k, 0] * a - ground.line[k, 1] * b
            within = within and gap > inside
            k += 1
        if within:
            return True
    return False
