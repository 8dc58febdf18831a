"""The curve over a requirement: its upper hull, and a Hermite that never dips below the hull.

P1 raises control points to the elevations and hopes; here the slope at each corner of the hull lies
between the slopes of the two sides that meet there, so that every piece bulges outward.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel

# A corner at which the slope changes by less is none.
ON_LINE = 1e-9


@kernel
def upper_hull(station: Any, need: Any, count: int, hull: Any) -> int:
    """Write the corners of the upper convex hull of (station, need) and return how many.

    `station` [count] rises strictly; the first and last points are always corners. One on the line
    between its neighbours is none, however that rounds: twins shall have the same corners.
    """
    corners = 0
    for k in range(count):
        while corners >= 2:
            a = hull[corners - 2]
            b = hull[corners - 1]
            rise = (need[k] - need[a]) * (station[b] - station[a])
            least = rise + ON_LINE * (station[b] - station[a]) * (station[k] - station[a])
            if (need[b] - need[a]) * (station[k] - station[a]) > least:
                break
            corners -= 1
        hull[corners] = k
        corners += 1
    return corners


@kernel
def corner_slope(station: Any, need: Any, a: int, b: int, c: int) -> float:
    """Return the slope at corner `b`: half way, as an angle, between its two sides' slopes."""
    before = math.atan2(need[b] - need[a], station[b] - station[a])
    after = math.atan2(need[c] - need[b], station[c] - station[b])
    return math.tan(0.5 * (before + after))


@kernel
def hull_curve(station: Any, need: Any, hull: Any, corners: int, height: Any, slope: Any) -> None:
    """Write height and slope of the curve over the hull at every station between its ends.

    The first and the last piece are parabolas, as steep at the outer end as they need to be.
    """
    slope_a = 0.0
    for corner in range(corners - 1):
        a = hull[corner]
        b = hull[corner + 1]
        span = station[b] - station[a]
        side = (need[b] - need[a]) / span
        slope_b = side
        if corner + 2 < corners:
            slope_b = corner_slope(station, need, a, b, hull[corner + 2])
        elif corner > 0:
            slope_b = 2.0 * side - slope_a
        if corner == 0:
            slope_a = 2.0 * side - slope_b
        # Over the side by (slope_a - side) u (1-u)^2 + (side - slope_b) u^2 (1-u), both >= 0.
        rise_a = (slope_a - side) * span
        rise_b = (side - slope_b) * span
        for k in range(a, b):
            u = (station[k] - station[a]) / span
            rest = 1.0 - u
            bulge = u * rest * (rise_a * rest + rise_b * u)
            height[k] = need[a] + (need[b] - need[a]) * u + bulge
            turn = rise_a * rest * (1.0 - 3.0 * u) + rise_b * u * (2.0 - 3.0 * u)
            slope[k] = side + turn / span
        height[b] = need[b]
        slope[b] = slope_b
        slope_a = slope_b
