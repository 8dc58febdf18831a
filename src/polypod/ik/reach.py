"""Whether a leg can reach a place, and the least move that lets it: asked by planner and body."""

from __future__ import annotations

from polypod.compute import kernel
from polypod.ik.aim import hip_for
from polypod.ik.fold import fold_for_reach
from polypod.ik.hip import hip_strain
from polypod.ik.solve import offset_from_hip
from polypod.ik.types import IkTable
from polypod.math.vec3 import Vec3, dot, length, load_vec3, mix, normalized

CORRECTIONS = 8
BISECTIONS = 24
# The probe's step for slopes, in leg lengths.
PROBE = 1e-4


@kernel
def with_length_in(offset: Vec3, shortest: float, longest: float, fallback: Vec3) -> Vec3:
    """Return an offset with its length brought between two bounds, m; `fallback` directs zero."""
    reach = min(max(length(offset), shortest), longest)
    return normalized(offset, fallback) * reach


@kernel
def direction_strain(ik: IkTable, leg: int, offset: Vec3) -> float:
    """Return how much of the hip's range the pose for an offset takes; above 1 it is not allowed.

    `offset` leads from the hip to the effector, m; its length is taken within the leg's reach.
    """
    reach = min(max(length(offset), ik.shortest[leg]), ik.longest[leg])
    _, chord = fold_for_reach(ik, leg, reach)
    direction = normalized(offset, load_vec3(ik.limb_axis[leg]))
    return hip_strain(ik, leg, hip_for(ik, leg, chord, direction))


@kernel
def reach_shift(ik: IkTable, leg: int, effector_body: Vec3) -> Vec3:
    """Return about the least displacement that brings a target within the leg's reach and limits.

    Zero where `solve_leg` meets the target exactly. Body frame, m.
    """
    wanted = offset_from_hip(effector_body, load_vec3(ik.hip_rest[leg]), ik.chain_length[leg])
    limb = load_vec3(ik.limb_axis[leg])
    shortest = ik.shortest[leg]
    longest = ik.longest[leg]
    size = length(wanted)
    offset = wanted
    # A rounding's worth of slack, so that a target already moved is left alone.
    if size > longest * (1.0 + 1e-9) or size < shortest * (1.0 - 1e-9):
        offset = with_length_in(wanted, shortest, longest, limb)
    strain = direction_strain(ik, leg, offset)
    if strain <= 1.0:
        return offset - wanted
    probe = PROBE * ik.chain_length[leg]
    for _ in range(CORRECTIONS):
        slope = Vec3(
            direction_strain(ik, leg, offset + Vec3(probe, 0.0, 0.0)) - strain,
            direction_strain(ik, leg, offset + Vec3(0.0, probe, 0.0)) - strain,
            direction_strain(ik, leg, offset + Vec3(0.0, 0.0, probe)) - strain,
        ) * (1.0 / probe)
        steepness = dot(slope, slope)
        # Far outside the limits slopes mislead: no step is longer than a fifth of the leg.
        step = slope * ((1.0 - 1e-6 - strain) / max(steepness, 1e-12))
        cap = 0.2 * ik.chain_length[leg] / max(length(step), 1e-300)
        offset = with_length_in(offset + step * min(cap, 1.0), shortest, longest, limb)
        strain = direction_strain(ik, leg, offset)
        if strain <= 1.0:
            return offset - wanted
    stance = load_vec3(ik.effector_stance[leg]) - load_vec3(ik.hip_rest[leg])
    inside = with_length_in(stance, shortest, longest, limb)
    outside = offset
    for _ in range(BISECTIONS):
        middle = with_length_in(mix(inside, outside, 0.5), shortest, longest, limb)
        if direction_strain(ik, leg, middle) <= 1.0:
            inside = middle
        else:
            outside = middle
    return inside - wanted
