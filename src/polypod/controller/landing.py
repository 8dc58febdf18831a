"""Swinging feet go on by what the body found room for, and land (P1 3.2)."""

from __future__ import annotations

from typing import Any

from polypod.body.reach import TOLERANCE, shift_as_it_is, shift_as_wished
from polypod.compute import kernel
from polypod.controller.settle import NEARLY_DOWN, pushed_aside
from polypod.environment.table import surface
from polypod.math.quat import load_quat, store_quat
from polypod.math.vec3 import Vec3, length, load_vec3, store_vec3

# A foot has landed where it is so near to the surface, leg lengths.
LANDED = 1e-3


@kernel
def dragged(c: int, k: int, sole: Vec3, state: Any, tables: Any, scratch: Any) -> Vec3:
    """Return where a swinging foot gets whose body does not wait for it, world.

    As near to its place on its path as its leg reaches: a foot that has just lifted falls behind
    its body.
    """
    position = load_vec3(state.position[c])
    turn = load_quat(state.rotation[c])
    shift = shift_as_wished(c, k, sole, state, tables, scratch, position, turn)
    if length(shift) <= 2.0 * TOLERANCE * tables.leg_length:
        return sole
    return sole + shift


@kernel
def advance_swings(
    c: int, dt: float, state: Any, tables: Any, scratch: Any, env: Any
) -> None:  # fmt: skip
    """Carry the swinging feet as far as `settle_body` found, and land those that arrived."""
    for k in range(state.swinging.shape[1]):
        if not scratch.held[k]:
            for i in range(3):
                state.foot_pitch[c, k, i] = scratch.pitch[k, i]
                state.foot_bend[c, k, i] = scratch.bend[k, i]
        if not state.swinging[c, k] or state.reaching[c, k]:
            continue
        state.airborne[c, k] += dt
        sole = load_vec3(scratch.sole[k])
        if scratch.held[k]:
            state.waiting[c, k] += dt
            if env.mover_count > 0:
                here = load_vec3(state.foot[c, k])
                here = pushed_aside(c, k, here, state, tables, env)
                # A body that is carried away by what it stands on takes its feet in the air along.
                position = load_vec3(state.position[c])
                turn = load_quat(state.rotation[c])
                here = here + shift_as_it_is(c, k, here, state, tables, position, turn)
                store_vec3(state.foot[c, k], here)
            continue
        late = 0.0
        near = dragged(c, k, sole, state, tables, scratch)
        if near != sole and scratch.progress[k] >= 1.0:
            # Its place is out of reach, and no place to land: another is looked for soon.
            scratch.progress[k] = NEARLY_DOWN
            late = state.waiting[c, k] + dt
        sole = near
        state.waiting[c, k] = late
        state.swing_progress[c, k] = scratch.progress[k]
        store_vec3(state.foot[c, k], sole)
        store_quat(state.foot_rotation[c, k], load_quat(scratch.turn[k]))
        if scratch.progress[k] >= 1.0:
            height, support = surface(env, sole.x, sole.z)
            if env.mover_count > 0 and abs(height - sole.y) > LANDED * tables.leg_length:
                # Not there any more: the foot is sent elsewhere in the next step.
                state.swing_progress[c, k] = NEARLY_DOWN
                continue
            state.swinging[c, k] = False
            state.stood[c, k] = 0.0
            state.foot_support[c, k] = support
