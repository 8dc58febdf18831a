"""Fold: bend a whole leg by one number until it is as long as its target is far."""

from __future__ import annotations

from polypod.compute import kernel
from polypod.ik.types import IkTable
from polypod.math.quat import Quat, from_axis_angle, rotate
from polypod.math.vec3 import Vec3, length, load_vec3

# The table starts within about 1e-6 of the answer: one or two steps are the rule.
SECANT_STEPS = 6
REACH_TOLERANCE = 1e-13


@kernel
def hinge_turn(base: float, slope: float, fold: float, low: float, high: float) -> float:
    """Return a hinge's turn away from the rest at a fold, radians, inside its range."""
    return min(max(base + fold * slope, low), high)


@kernel
def folded_chord(ik: IkTable, leg: int, fold: float) -> Vec3:
    """Return the way from hip to effector of the folded leg, its hip not turned, metres."""
    rotation = Quat(0.0, 0.0, 0.0, 1.0)
    chord = load_vec3(ik.bone_rest[leg, 0])
    for joint in range(1, ik.joint_count[leg]):
        turn = hinge_turn(
            ik.turn_base[leg, joint],
            ik.turn_slope[leg, joint],
            fold,
            ik.turn_low[leg, joint],
            ik.turn_high[leg, joint],
        )
        rotation = rotation * from_axis_angle(load_vec3(ik.axis[leg, joint]), turn)
        chord = chord + rotate(rotation, load_vec3(ik.bone_rest[leg, joint]))
    return chord


@kernel
def fold_for_reach(ik: IkTable, leg: int, reach: float) -> tuple[float, Vec3]:
    """Return the fold at which hip and effector are `reach` metres apart, and the way between them.

    `reach` lies between the leg's shortest and longest. A cubic through the table's four nearest
    samples gives a start and a slope from which a secant closes on the exact fold.
    """
    cells = ik.fold_of_reach.shape[1] - 1
    span = ik.longest[leg] - ik.shortest[leg]
    if span <= 0.0:
        fold = ik.fold_of_reach[leg, cells]
        return fold, folded_chord(ik, leg, fold)
    place = min(max((reach - ik.shortest[leg]) / span, 0.0), 1.0) * cells
    cell = min(int(place), cells - 1)
    near = ik.fold_of_reach[leg, cell]
    far = ik.fold_of_reach[leg, cell + 1]
    rise = far - near
    rise_near = 0.5 * (far - ik.fold_of_reach[leg, cell - 1]) if cell > 0 else rise
    rise_far = 0.5 * (ik.fold_of_reach[leg, cell + 2] - near) if cell + 2 <= cells else rise
    u = place - cell
    v = 1.0 - u
    fold = near * v + far * u + u * v * (v * (rise_near - rise) - u * (rise_far - rise))
    slope = rise + (v - u) * (v * (rise_near - rise) - u * (rise_far - rise))
    slope = (slope - u * v * (rise_near + rise_far - 2.0 * rise)) * cells / span
    chord = folded_chord(ik, leg, fold)
    error = length(chord) - reach
    steps = 0
    while abs(error) > REACH_TOLERANCE * ik.chain_length[leg] and steps < SECANT_STEPS:
        step = -error * slope
        fold += step
        chord = folded_chord(ik, leg, fold)
        before = error
        error = length(chord) - reach
        if error != before:
            slope = step / (error - before)
        steps += 1
    return fold, chord
