"""Whether a leg can reach a place, and the least move that lets it: asked by planner and body."""

from __future__ import annotations

from polypod.compute import kernel
from polypod.ik.solve import aimed_hip, fold_for_reach, folded_chord, hip_strain, offset_from_hip
from polypod.ik.types import IkTable
from polypod.math.vec3 import Vec3, dot, length, load_vec3, mix, normalized

CORRECTIONS = 8
BISECTIONS = 24
# The probe's step for slopes, in leg lengths.
PROBE = 1e-4


@kernel
def within_reach(ik: IkTable, leg: int, offset: Vec3, longest: float) -> Vec3:
    """Return an offset from the hip with its length brought between shortest and `longest`."""
    size = length(offset)
    reach = min(max(size, ik.shortest[leg]), longest)
    return normalized(offset, load_vec3(ik.limb_axis[leg])) * reach


@kernel
def direction_strain(ik: IkTable, leg: int, offset: Vec3) -> float:
    """Return how much of the hip's range the pose for an offset takes; above 1 it is not allowed.

    `offset` leads from the hip to the effector, m; its length is taken within the leg's reach.
    """
    reach = min(max(length(offset), ik.shortest[leg]), ik.longest[leg])
    chord = folded_chord(ik, leg, fold_for_reach(ik, leg, reach))
    direction = normalized(offset, load_vec3(ik.limb_axis[leg]))
    return hip_strain(ik, leg, aimed_hip(ik, leg, chord, direction))


@kernel
def reach_shift_within(ik: IkTable, leg: int, effector_body: Vec3, longest: float) -> Vec3:
    """Return about the least displacement that brings a target within `longest` and the limits.

    Zero where `solve_leg` meets the target exactly. Body frame, m.
    """
    wanted = offset_from_hip(ik, leg, effector_body)
    size = length(wanted)
    offset = wanted
    # A rounding's worth of slack, so that a target already moved is left alone.
    if size > longest * (1.0 + 1e-9) or size < ik.shortest[leg] * (1.0 - 1e-9):
        offset = within_reach(ik, leg, wanted, longest)
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
        offset = within_reach(ik, leg, offset + step * min(cap, 1.0), longest)
        strain = direction_strain(ik, leg, offset)
        if strain <= 1.0:
            return offset - wanted
    stance = load_vec3(ik.effector_stance[leg]) - load_vec3(ik.hip_rest[leg])
    inside = within_reach(ik, leg, stance, longest)
    outside = offset
    for _ in range(BISECTIONS):
        middle = within_reach(ik, leg, mix(inside, outside, 0.5), longest)
        if direction_strain(ik, leg, middle) <= 1.0:
            inside = middle
        else:
            outside = middle
    return inside - wanted


@kernel
def reach_shift(ik: IkTable, leg: int, effector_body: Vec3) -> Vec3:
    """Return about the least displacement that brings a target within the leg's reach and limits.

    Zero where `solve_leg` meets the target exactly. Body frame, m.
    """
    return reach_shift_within(ik, leg, effector_body, ik.longest[leg])
