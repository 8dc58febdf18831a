"""Exact geometry of one obstacle: the column it fills, how deep a point is inside, its top's slope.

Boxes and hulls are planes; spheres and cylinders have closed forms.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from polypod.compute import kernel
from polypod.math.quat import load_quat, rotate, unrotate
from polypod.math.vec3 import Vec3, dot, length, load_vec3, normalized

if TYPE_CHECKING:
    from polypod.environment.table import EnvironmentTable

BOX = 0  # also every convex hull: described by its planes
SPHERE = 1
CYLINDER = 2

# A plane whose normal rises less than this is vertical: rounding of a yaw leaves about 1e-16.
VERTICAL = 1e-9
# How far outside a face a point may be by rounding and still be on it, in sizes of the obstacle.
ON_FACE = 1e-12
# A face whose normal sinks more than this is one from below.
DOWNWARD = -0.5


@kernel
def column_of(env: EnvironmentTable, o: int, x: float, z: float) -> tuple[float, float]:
    """Return the heights (bottom, top) between which a vertical line is inside obstacle `o`.

    A line that misses it gets (inf, -inf); one along a face or an edge meets it.
    """
    if env.kind[o] == SPHERE:
        return _column_of_sphere(env, o, x, z)
    if env.kind[o] == CYLINDER:
        return _column_of_cylinder(env, o, x, z)
    bottom = -math.inf
    top = math.inf
    slack = ON_FACE * (abs(x) + abs(z) + env.bounds[o, 3] - env.bounds[o, 0])
    for p in range(env.plane_count[o]):
        rise = env.planes[o, p, 1]
        room = env.planes[o, p, 3] - env.planes[o, p, 0] * x - env.planes[o, p, 2] * z
        if rise > VERTICAL:
            top = min(top, room / rise)
        elif rise < -VERTICAL:
            bottom = max(bottom, room / rise)
        elif room < -slack:
            return math.inf, -math.inf
    if bottom > top + slack:
        return math.inf, -math.inf
    return bottom, top


@kernel
def _column_of_sphere(env: EnvironmentTable, o: int, x: float, z: float) -> tuple[float, float]:
    across = x - env.position[o, 0]
    along = z - env.position[o, 2]
    room = env.half_size[o, 0] * env.half_size[o, 0] - across * across - along * along
    if room < 0.0:
        return math.inf, -math.inf
    reach = math.sqrt(room)
    return env.position[o, 1] - reach, env.position[o, 1] + reach


@kernel
def _column_of_cylinder(env: EnvironmentTable, o: int, x: float, z: float) -> tuple[float, float]:
    """Clip the line, in the cylinder's own frame, between the caps and inside the round side."""
    turn = load_quat(env.rotation[o])
    centre = load_vec3(env.position[o])
    start = unrotate(turn, Vec3(x - centre.x, 0.0, z - centre.z))
    up = unrotate(turn, Vec3(0.0, 1.0, 0.0))
    radius = env.half_size[o, 0]
    half = env.half_size[o, 1]
    first = -math.inf
    last = math.inf
    if abs(up.y) > VERTICAL:
        near = (-half - start.y) / up.y
        far = (half - start.y) / up.y
        first = min(near, far)
        last = max(near, far)
    elif abs(start.y) > half:
        return math.inf, -math.inf
    # |start + t up| in plan of the cylinder is the radius: a t^2 + 2 b t + c = 0.
    a = up.x * up.x + up.z * up.z
    b = start.x * up.x + start.z * up.z
    c = start.x * start.x + start.z * start.z - radius * radius
    if a > VERTICAL * VERTICAL:
        root = b * b - a * c
        if root < 0.0:
            return math.inf, -math.inf
        root = math.sqrt(root)
        first = max(first, (-b - root) / a)
        last = min(last, (-b + root) / a)
    elif c > 0.0:
        return math.inf, -math.inf
    if first > last:
        return math.inf, -math.inf
    return centre.y + first, centre.y + last


@kernel
def top_normal_of(env: EnvironmentTable, o: int, x: float, z: float) -> Vec3:
    """Return the outward normal where a vertical line leaves obstacle `o` at its top.

    The line must meet the obstacle.
    """
    top = column_of(env, o, x, z)[1]
    point = Vec3(x, top, z)
    if env.kind[o] == BOX:
        best = 0
        nearest = math.inf
        for p in range(env.plane_count[o]):
            rise = env.planes[o, p, 1]
            if rise > VERTICAL:
                room = env.planes[o, p, 3] - env.planes[o, p, 0] * x - env.planes[o, p, 2] * z
                if room / rise < nearest:
                    nearest = room / rise
                    best = p
        return load_vec3(env.planes[o, best])
    out = point - load_vec3(env.position[o])
    if env.kind[o] == SPHERE:
        shrink = 1.0 / float(env.half_size[o, 0])
        return out * shrink
    turn = load_quat(env.rotation[o])
    local = unrotate(turn, out)
    radius = math.sqrt(local.x * local.x + local.z * local.z)
    up = unrotate(turn, Vec3(0.0, 1.0, 0.0))
    cap_gap = env.half_size[o, 1] - abs(local.y)
    if cap_gap <= env.half_size[o, 0] - radius and abs(up.y) > VERTICAL:
        return rotate(turn, Vec3(0.0, math.copysign(1.0, local.y), 0.0))
    return rotate(turn, Vec3(local.x / radius, 0.0, local.z / radius))


@kernel
def depth_inside(env: EnvironmentTable, o: int, point: Vec3) -> float:
    """Return how far a point is inside obstacle `o`: exactly the distance to its surface.

    Outside it is below zero, and its size is at most the distance to the obstacle.
    """
    if env.kind[o] == BOX:
        depth = math.inf
        for p in range(env.plane_count[o]):
            height = (
                env.planes[o, p, 0] * point.x
                + env.planes[o, p, 1] * point.y
                + env.planes[o, p, 2] * point.z
            )
            depth = min(depth, float(env.planes[o, p, 3] - height))
        return depth
    out = point - load_vec3(env.position[o])
    if env.kind[o] == SPHERE:
        away = math.sqrt(out.x * out.x + out.y * out.y + out.z * out.z)
        return float(env.half_size[o, 0]) - away
    local = unrotate(load_quat(env.rotation[o]), out)
    side = float(env.half_size[o, 0]) - math.sqrt(local.x * local.x + local.z * local.z)
    return min(side, float(env.half_size[o, 1]) - abs(local.y))


@kernel
def way_out(env: EnvironmentTable, o: int, point: Vec3) -> Vec3:
    """Return the shortest move, but down, that brings a point in `o` to its surface; 0 outside.

    What stands on the ground has no way out below.
    """
    depth = depth_inside(env, o, point)
    if depth <= 0.0:
        return Vec3(0.0, 0.0, 0.0)
    if env.kind[o] == BOX:
        best = 0
        nearest = math.inf
        for p in range(env.plane_count[o]):
            normal = load_vec3(env.planes[o, p])
            room = env.planes[o, p, 3] - dot(normal, point)
            if room < nearest and normal.y > DOWNWARD:
                nearest = room
                best = p
        return load_vec3(env.planes[o, best]) * nearest
    out = point - load_vec3(env.position[o])
    if env.kind[o] == SPHERE:
        if out.y < 0.0:
            # Straight aside, to where the sphere is no wider than at this height.
            wide = math.sqrt(max(env.half_size[o, 0] ** 2 - out.y * out.y, 0.0))
            flat = Vec3(out.x, 0.0, out.z)
            return normalized(flat, Vec3(1.0, 0.0, 0.0)) * (wide - length(flat))
        return normalized(out, Vec3(0.0, 1.0, 0.0)) * depth
    turn = load_quat(env.rotation[o])
    local = unrotate(turn, out)
    across = Vec3(local.x, 0.0, local.z)
    aside = rotate(turn, normalized(across, Vec3(1.0, 0.0, 0.0)))
    cap = rotate(turn, Vec3(0.0, math.copysign(1.0, local.y), 0.0))
    side = env.half_size[o, 0] - length(across)
    end = env.half_size[o, 1] - abs(local.y)
    if cap.y <= DOWNWARD or (side <= end and aside.y > DOWNWARD):
        return aside * side
    return cap * end


@kernel
def plan_distance(env: EnvironmentTable, o: int, x: float, z: float) -> float:
    """Return the distance in plan from a point to the footprint of obstacle `o`; inside it 0."""
    if env.kind[o] == SPHERE:
        gap = math.hypot(x - env.position[o, 0], z - env.position[o, 2])
        return max(gap - float(env.half_size[o, 0]), 0.0)
    nearest = math.inf
    inside = True
    count = env.footprint_count[o]
    for v in range(count):
        normal_x = env.footprint_side[o, v, 0]
        normal_z = env.footprint_side[o, v, 1]
        gap = normal_x * x + normal_z * z - env.footprint_side[o, v, 2]
        if gap <= 0.0:
            continue
        inside = False
        # The nearest point of this side, by where the point projects along it.
        w = v + 1 if v + 1 < count else 0
        along_x = env.footprint[o, w, 0] - env.footprint[o, v, 0]
        along_z = env.footprint[o, w, 1] - env.footprint[o, v, 1]
        off_x = x - env.footprint[o, v, 0]
        off_z = z - env.footprint[o, v, 1]
        share = (off_x * along_x + off_z * along_z) / (along_x * along_x + along_z * along_z)
        share = min(max(share, 0.0), 1.0)
        nearest = min(nearest, math.hypot(off_x - share * along_x, off_z - share * along_z))
    return 0.0 if inside else nearest
