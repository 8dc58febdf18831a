"""The bounded retry: a girdle that its standing feet hold stays where they let it be (P2 5.1, 5.4).

The body moves first, as far as all legs allow. Where legs of two girdles ask for opposite things no
place of the body suits them all: then each girdle is moved by what its own standing feet are short
of, to the side and up, and the curve is drawn anew through where they let it be. Once.
"""

from __future__ import annotations

from typing import Any

from polypod.body.reach import TOLERANCE, shift_as_wished
from polypod.compute import kernel
from polypod.math.quat import Quat, unrotate
from polypod.math.vec3 import Vec3, length, load_vec3
from polypod.spine.chain import place_segments
from polypod.spine.curve import draw_curve
from polypod.spine.elevation import slope_at

# No girdle yields by more than this at once, leg lengths.
MOST = 0.25


@kernel
def short_of(
    c: int, g: int, position: Vec3, turn: Quat, state: Any, tables: Any, scratch: Any
) -> Vec3:
    """Return by how much, world, a girdle must move for the foot of it that is farthest off.

    Of the standing feet, where the scratch has them, with the body at a pose; zero: they reach.
    """
    most = 2.0 * TOLERANCE * tables.leg_length
    move = Vec3(0.0, 0.0, 0.0)
    for k in range(state.swinging.shape[1]):
        if state.swinging[c, k] or tables.girdles.of_leg[k] != g:
            continue
        sole = load_vec3(scratch.sole[k])
        shift = shift_as_wished(c, k, sole, state, tables, scratch, position, turn)
        size = length(shift)
        if size > most:
            most = size
            move = shift * -min(1.0, MOST * tables.leg_length / size)
    return move


@kernel
def yields(c: int, position: Vec3, turn: Quat, state: Any, tables: Any, scratch: Any) -> bool:
    """Draw the spine anew where girdles are held at a body's pose; return whether any is."""
    if tables.spine.joint.shape[0] == 0 or state.spine_share[c, 1, 0] <= 0.0:
        return False
    node = scratch.node
    give = scratch.more
    count = node.shape[0]
    any_held = False
    for g in range(count):
        move = short_of(c, g, position, turn, state, tables, scratch)
        any_held = any_held or length(move) > 0.0
        move = unrotate(turn, move)
        give[g, 0] = move.x
        give[g, 1] = move.y
    if not any_held or count < 2:
        return False
    for g in range(count):
        node[g, 0] += give[g, 0]
        node[g, 1] += give[g, 1]
        node[g, 2] += slope_at(g, give[:, 0], tables)
        node[g, 3] += slope_at(g, give[:, 1], tables)
    draw_curve(c, node, state, tables)
    place_segments(c, 1.0, state, tables)
    return True
