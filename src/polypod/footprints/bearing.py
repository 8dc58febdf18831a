"""Whether a foot's whole shape is borne, exactly: nothing pokes up under it, no part hangs over.

Samples tell the plane on which a foot would stand; between them a post may rise or a slot gape. So
each solid near the foot is cut with the foot's shape and with that plane (`cut`).
"""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.environment.shapes import SPHERE
from polypod.environment.table import EnvironmentTable, FloatArray
from polypod.footprints.covering import is_covered
from polypod.footprints.cut import ANYWHERE, Cut, bound, cut_of
from polypod.footprints.relief import terrain_spread
from polypod.footprints.scratch import GroundScratch
from polypod.footprints.settings import Tread

# An area below this share of the foot's is rounding.
AREA = 1e-9


@kernel
def is_borne(env: EnvironmentTable, tread: Tread, count: int, ground: GroundScratch) -> bool:
    """Return whether all under a foot's shape is within the tread's tolerance of its plane.

    Gaps between solids count where they are wider than twice the tread's `gap`.

    Args:
        env: the world.
        tread: the place.
        count: solids about it, which `ground.near` lists.
        ground: scratch.
    """
    if count > ground.near.shape[0]:
        return False
    least, most = terrain_spread(env, tread)
    if most > tread.tolerance:
        return False
    for i in range(count):
        o = ground.near[i]
        if env.forbidden[o] and rises(env, tread, o, ANYWHERE, ground):
            return False
        if rises(env, tread, o, tread.tolerance, ground):
            return False
    return least >= -tread.tolerance or is_covered(env, tread, count, ground)


@kernel
def rises(env: EnvironmentTable, tread: Tread, o: int, level: float, ground: GroundScratch) -> bool:
    """Return whether solid `o` is higher than `level` above the plane anywhere under the shape.

    The foot's rectangle is cut down by one half-plane after the other; something must be left.
    """
    cut = cut_of(env, tread, o)
    if env.kind[o] == SPHERE:
        return ball_rises(env, tread, cut, o, level)
    corner = ground.corner
    n = 4
    for v in range(4):
        corner[0, v, 0] = tread.half_a if v == 0 or v == 3 else -tread.half_a
        corner[0, v, 1] = tread.half_b if v < 2 else -tread.half_b
    now = 0
    for k in range(env.footprint_count[o] + env.plane_count[o]):
        g, h, room = bound(env, tread, cut, o, k, level)
        reach = abs(g) * tread.half_a + abs(h) * tread.half_b
        if reach <= room:
            continue
        if -reach >= room:
            return False
        if n + 1 >= corner.shape[1]:
            return True
        n = cut_polygon(corner, now, n, g, h, room)
        now = 1 - now
        if n < 3:
            return False
    twice_area = 0.0
    for v in range(n):
        w = v + 1 if v + 1 < n else 0
        twice_area += corner[now, v, 0] * corner[now, w, 1]
        twice_area -= corner[now, w, 0] * corner[now, v, 1]
    return abs(twice_area) > AREA * tread.half_a * tread.half_b


@kernel
def cut_polygon(corner: FloatArray, now: int, n: int, g: float, h: float, room: float) -> int:
    """Write to the other row the part of polygon `corner[now, :n]` with g a + h b <= room.

    Returns how many corners it has.
    """
    kept = 0
    for v in range(n):
        w = v + 1 if v + 1 < n else 0
        here = room - g * corner[now, v, 0] - h * corner[now, v, 1]
        there = room - g * corner[now, w, 0] - h * corner[now, w, 1]
        if here >= 0.0:
            corner[1 - now, kept, 0] = corner[now, v, 0]
            corner[1 - now, kept, 1] = corner[now, v, 1]
            kept += 1
        if (here > 0.0 and there < 0.0) or (here < 0.0 and there > 0.0):
            share = here / (here - there)
            for axis in range(2):
                step = corner[now, w, axis] - corner[now, v, axis]
                corner[1 - now, kept, axis] = corner[now, v, axis] + share * step
            kept += 1
    return kept


@kernel
def ball_rises(env: EnvironmentTable, tread: Tread, cut: Cut, o: int, level: float) -> bool:
    """Return whether a sphere is higher than `level` above the plane anywhere under the shape."""
    off_x = env.position[o, 0] - cut.middle.x
    off_z = env.position[o, 2] - cut.middle.z
    a = off_x * cut.a_x + off_z * cut.a_z
    b = off_x * cut.b_x + off_z * cut.b_z
    radius = env.half_size[o, 0]
    nearest_a = min(max(a, -tread.half_a), tread.half_a)
    nearest_b = min(max(b, -tread.half_b), tread.half_b)
    if math.hypot(a - nearest_a, b - nearest_b) >= radius:
        return False
    if level == ANYWHERE:
        return True
    height = env.position[o, 1] - cut.middle.y - tread.y - level
    # Where the sphere is as steep as the plane it is highest above it.
    lean = radius / math.sqrt(1.0 + tread.slope_a**2 + tread.slope_b**2)
    top_a = a - lean * tread.slope_a
    top_b = b - lean * tread.slope_b
    if abs(top_a) <= tread.half_a and abs(top_b) <= tread.half_b:
        return bool(height + lean - tread.slope_a * top_a - tread.slope_b * top_b > 0.0)
    for side in range(4):
        sign = 1.0 if side % 2 == 0 else -1.0
        across = side < 2
        # The circle in which the side's upright plane cuts the sphere.
        at = sign * (tread.half_a if across else tread.half_b)
        away = at - (a if across else b)
        if abs(away) >= radius:
            continue
        ring = math.sqrt(radius * radius - away * away)
        slope = tread.slope_b if across else tread.slope_a
        middle = b if across else a
        end = tread.half_b if across else tread.half_a
        best = middle - ring * slope / math.sqrt(1.0 + slope * slope)
        best = min(max(best, -end), end)
        room = ring * ring - (best - middle) * (best - middle)
        if room <= 0.0:
            continue
        plane = slope * best + (tread.slope_a if across else tread.slope_b) * at
        if height + math.sqrt(room) - plane > 0.0:
            return True
    return False
