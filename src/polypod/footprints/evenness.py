"""How even the ground under and about a foot is, from samples of it (P1 section 5.1)."""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.environment.table import EnvironmentTable, surface_at
from polypod.footprints.legs import REJECTED
from polypod.footprints.settings import FootShape, PlanSettings, Tread
from polypod.math.vec3 import Vec3

# Gaps between solids up to so wide carry a foot, toes (by which its shape is grown).
GAP = 0.5


@kernel
def lay_tread(
    env: EnvironmentTable,
    settings: PlanSettings,
    foot: FootShape,
    leg: float,
    place: Vec3,
    ahead: float,
) -> tuple[Tread, float]:
    """Return the foot's shape, grown by its toe, on the plane through four points of its outline.

    Also how far the place itself is from the lines between opposite points, m. `leg` is the leg's
    length, m.
    """
    half_a = foot.half_x + settings.toe * leg
    half_b = foot.half_z + settings.toe * leg
    a_x = half_a * foot.cosine
    a_z = half_a * foot.sine
    b_x = half_b * foot.sine
    b_z = half_b * foot.cosine
    east, _ = surface_at(env, place.x + a_x, place.z - a_z, ahead)
    west, _ = surface_at(env, place.x - a_x, place.z + a_z, ahead)
    north, _ = surface_at(env, place.x + b_x, place.z + b_z, ahead)
    south, _ = surface_at(env, place.x - b_x, place.z - b_z, ahead)
    rough = max(abs(east + west - 2.0 * place.y), abs(north + south - 2.0 * place.y)) * 0.5
    tread = Tread(
        place.x,
        place.y,
        place.z,
        half_a,
        half_b,
        foot.sine,
        foot.cosine,
        (east - west) / (2.0 * half_a),
        (north - south) / (2.0 * half_b),
        settings.uneven * leg + settings.uneven_foot * foot.radius,
        GAP * settings.toe * leg,
        ahead,
    )
    return tread, rough


@kernel
def even_score(env: EnvironmentTable, tread: Tread, rough: float, steepest: float) -> float:
    """Return 1 for a plane under the foot's shape down to 0 at the tolerance; REJECTED beyond.

    `rough` is what is already known of it, m; to that come the corners.
    """
    slope_a = tread.slope_a
    slope_b = tread.slope_b
    if slope_a * slope_a + slope_b * slope_b > steepest * steepest:
        return REJECTED
    for corner in range(4):
        a = tread.half_a if corner < 2 else -tread.half_a
        b = tread.half_b if corner % 2 == 0 else -tread.half_b
        at_x = tread.x + a * tread.cosine + b * tread.sine
        at_z = tread.z - a * tread.sine + b * tread.cosine
        height, _ = surface_at(env, at_x, at_z, tread.ahead)
        rough = max(rough, abs(height - tread.y - slope_a * a - slope_b * b))
    return REJECTED if rough > tread.tolerance else 1.0 - rough / tread.tolerance


@kernel
def edge_score(
    env: EnvironmentTable,
    foot: FootShape,
    out: float,
    steepest: float,
    drop: float,
    x: float,
    y: float,
    z: float,
    ahead: float,
) -> float:
    """Return the share of a ring about the foot that continues its surface without edge or wall."""
    ring_x = foot.half_x + out
    ring_z = foot.half_z + out
    good = 0.0
    for k in range(4):
        # Opposite points: on any slope their mean is the height between them.
        a = ring_x * (1.0 if k == 0 else (0.7 if k != 2 else 0.0))
        b = ring_z * (1.0 if k == 2 else (0.7 if k == 1 else (-0.7 if k == 3 else 0.0)))
        dx = a * foot.cosine + b * foot.sine
        dz = -a * foot.sine + b * foot.cosine
        there, _ = surface_at(env, x + dx, z + dz, ahead)
        opposite, _ = surface_at(env, x - dx, z - dz, ahead)
        steep = max(abs(there - y), abs(opposite - y)) > steepest * math.hypot(dx, dz)
        if abs(there + opposite - 2.0 * y) <= drop and not steep:
            good += 0.25
    return good
