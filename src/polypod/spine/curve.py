"""Step 4: a Hermite curve through the girdles, and the spine's bones along it (P2 5.4).

Nodes are the girdles where steps 1 to 3 want them, with the directions in which they lead. A
segment that carries a girdle takes its direction, one between two girdles that of the curve where
it lies at rest; the bones keep their length, and the whole is put where it fits the nodes best. So
girdles may end elsewhere than steps 1 to 3 wanted them, and what these keep for themselves is not
touched (P2 5.4). A segment rolls about itself only as far as it takes its girdles from one bank to
another: else each faces up as the body does.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel
from polypod.math.hermite import hermite
from polypod.math.quat import Quat, conjugate, rotate
from polypod.math.vec3 import Vec3, load_vec3, store_vec3
from polypod.spine.chain import AHEAD, joint_angles, joint_turn, within


@kernel
def node_place(g: int, node: Any, tables: Any) -> Vec3:
    """Return where a girdle is to be, body frame, m."""
    rest = load_vec3(tables.spine.girdle_rest[g])
    return Vec3(rest.x + node[g, 0], rest.y + node[g, 1], rest.z)


@kernel
def node_way(g: int, node: Any) -> Vec3:
    """Return the unit direction in which a girdle is to lead, body frame."""
    return rotate(joint_turn(node[g, 2], node[g, 3], 0.0), AHEAD)


@kernel
def curve_at(g: int, u: float, node: Any, tables: Any) -> Vec3:
    """Return a point of the curve between a girdle and the next, body frame, m.

    Against the straight line between the two at rest: girdles of unequal height are no bend.
    """
    span = float(tables.girdles.place[g + 1] - tables.girdles.place[g])
    begin = Vec3(node[g, 0], node[g, 1], float(tables.girdles.place[g]))
    end = Vec3(node[g + 1, 0], node[g + 1, 1], float(tables.girdles.place[g + 1]))
    return hermite(begin, node_way(g, node) * span, end, node_way(g + 1, node) * span, u)


@kernel
def segment_way(s: int, node: Any, tables: Any) -> Vec3:
    """Return the direction in which a segment of the trunk is to lead, body frame."""
    bend = tables.bend
    first = bend.first_girdle[s]
    last = bend.last_girdle[s]
    if first < 0:
        g = bend.behind[s]
        return curve_at(g, bend.end[s], node, tables) - curve_at(g, bend.begin[s], node, tables)
    if first == last:
        return node_way(first, node)
    across = node_place(last, node, tables) - node_place(first, node, tables)
    rest = load_vec3(tables.spine.girdle_rest[last]) - load_vec3(tables.spine.girdle_rest[first])
    return Vec3(across.x, across.y - rest.y, across.z)


@kernel
def segment_roll(s: int, node: Any, tables: Any) -> float:
    """Return the roll of a segment of the trunk: its girdles', or between two its share of both."""
    bend = tables.bend
    first = bend.first_girdle[s]
    if first >= 0:
        return 0.5 * float(node[first, 4] + node[bend.last_girdle[s], 4])
    g = bend.behind[s]
    along = 0.5 * (bend.begin[s] + bend.end[s])
    return float(node[g, 4] + along * (node[g + 1, 4] - node[g, 4]))


@kernel
def segment_turn(s: int, node: Any, tables: Any) -> Quat:
    """Return the rotation that a segment of the trunk is to have against the body frame."""
    way = segment_way(s, node, tables)
    yaw = math.atan2(way.x, way.z)
    pitch = math.atan2(way.y, math.hypot(way.x, way.z))
    return joint_turn(yaw, pitch, segment_roll(s, node, tables))


@kernel
def room_for(node: Any, more: Any, tables: Any) -> float:
    """Return the share of what is to be added to the nodes that the joints' limits leave room for.

    `node` and `more` are [G, 5]; angles are taken to add up as far as each bends.
    """
    limit = tables.spine.limit
    share = 1.0
    before = segment_turn(0, node, tables)
    before_all = segment_turn(0, more, tables)
    for s in range(1, tables.spine.neck):
        turn = segment_turn(s, node, tables)
        turn_all = segment_turn(s, more, tables)
        own = joint_angles(conjugate(before) * turn)
        full = joint_angles(conjugate(before_all) * turn_all)
        share = min(share, room_of(own.x, full.x, limit[s, 0]))
        share = min(share, room_of(own.y, full.y, limit[s, 1]))
        before = turn
        before_all = turn_all
    return share


@kernel
def room_of(own: float, whole: float, limit: float) -> float:
    """Return the share of the way from an angle to another at which it comes to its limit, rad."""
    if abs(whole) <= limit:
        return 1.0
    return min(max((limit - abs(own)) / max(abs(whole - own), 1e-12), 0.0), 1.0)


@kernel
def draw_curve(c: int, node: Any, state: Any, tables: Any) -> tuple[Quat, bool]:
    """Write the angles of the trunk's joints, and where it begins; return the chest's rotation.

    And whether all angles were within their limits, into which they are brought.
    `node` [G, 5] says for each girdle how far it is to be to the left and up, m, and its yaw, pitch
    and roll, rad, against the body frame.
    """
    spine = tables.spine
    turn = Quat(0.0, 0.0, 0.0, 1.0)
    pivot = load_vec3(spine.pivot_rest[0])
    gap = Vec3(0.0, 0.0, 0.0)
    inside = True
    for s in range(max(spine.neck, 1)):
        angles = joint_angles(conjugate(turn) * segment_turn(s, node, tables))
        if s > 0:
            kept = within(angles, spine.limit[s])
            inside = inside and kept == angles
            angles = kept
        store_vec3(state.spine_wish[c, s], angles)
        turn = turn * joint_turn(angles.x, angles.y, angles.z)
        begin = load_vec3(spine.pivot_rest[s])
        for g in range(tables.bend.first_girdle[s], tables.bend.last_girdle[s] + 1):
            if g < 0:
                continue
            reached = pivot + rotate(turn, load_vec3(spine.girdle_rest[g]) - begin)
            gap = gap + (node_place(g, node, tables) - reached) * tables.girdles.weight[g]
        pivot = pivot + rotate(turn, load_vec3(spine.pivot_rest[s + 1]) - begin)
    store_vec3(state.spine_base_wish[c], gap)
    return turn, inside
