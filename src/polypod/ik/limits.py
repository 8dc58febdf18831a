"""How far a leg's pose is outside its limits, measured apart from the solver: for tests and audits.

The solver works with half angles of quaternions; here directions and matrices are measured, so that
an error in one does not hide in the other.
"""

from __future__ import annotations

import math

import numpy as np

from polypod.ik.types import IkTable
from polypod.morphology.types import FloatArray


def limit_excess(ik: IkTable, leg: int, rotation: FloatArray) -> float:
    """Return the most that any joint of a posed leg exceeds its range, radians; 0 within.

    A hinge also exceeds by any turn off its axis; the hip by swing, scaled to its elliptic cone,
    and by twist.

    Args:
        ik: the legs.
        leg: row of the leg.
        rotation: [M, 4] each joint's rotation relative to the rest, body frame, x y z w.
    """
    count = int(ik.joint_count[leg])
    matrices = [matrix_from_quaternion(rotation[i]) for i in range(count)]
    worst = hip_excess(ik, leg, matrices[0])
    for joint in range(1, count):
        own = matrices[joint - 1].T @ matrices[joint]
        axis = ik.axis[leg, joint]
        if not axis.any():
            worst = max(worst, _angle_between(np.eye(3), own))
            continue
        side = _across(axis)
        turned = own @ side
        turn = math.atan2(float(np.cross(side, turned) @ axis), float(side @ turned))
        off_axis = math.atan2(
            float(np.linalg.norm(np.cross(axis, own @ axis))), float(axis @ own @ axis)
        )
        low = ik.turn_low[leg, joint] - turn
        high = turn - ik.turn_high[leg, joint]
        # A turn is an angle: one that lies below the range may be a whole turn above it.
        if low > math.pi:
            low, high = low - 2.0 * math.pi, high + 2.0 * math.pi
        if high > math.pi:
            low, high = low + 2.0 * math.pi, high - 2.0 * math.pi
        worst = max(worst, low, high, off_axis)
    return max(worst, 0.0)


def hip_excess(ik: IkTable, leg: int, matrix: FloatArray) -> float:
    """Return how far a hip's rotation [3, 3] is outside cone and twist, radians; <= 0 inside."""
    turned = matrix @ matrix_from_quaternion(ik.hip_stance[leg]).T
    limb = ik.limb_axis[leg]
    flexion_axis = ik.flexion_axis[leg]
    swung = turned @ limb
    across = np.cross(limb, swung)
    sine = float(np.linalg.norm(across))
    angle = math.atan2(sine, float(limb @ swung))
    axis = across / sine if sine > 1e-12 else flexion_axis
    flexion = angle * float(axis @ flexion_axis)
    sideways = angle * float(axis @ np.cross(limb, flexion_axis))
    limit = ik.hip_limit[leg]
    strain = math.hypot(flexion / limit[0], sideways / limit[1])
    swing_excess = angle * (1.0 - 1.0 / strain) if strain > 1.0 else 0.0
    untwisted = _rotation_about(axis, -angle) @ turned
    pointer = untwisted @ flexion_axis
    twist = math.atan2(float(np.cross(flexion_axis, pointer) @ limb), float(flexion_axis @ pointer))
    return max(swing_excess, abs(twist) - float(limit[2]))


def matrix_from_quaternion(rotation: FloatArray) -> FloatArray:
    """Return the rotation matrix [3, 3] of a unit quaternion x, y, z, w."""
    x, y, z, w = rotation
    spin = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + 2.0 * w * spin + 2.0 * spin @ spin


def _rotation_about(axis: FloatArray, angle: float) -> FloatArray:
    half = 0.5 * angle
    return matrix_from_quaternion(np.append(math.sin(half) * axis, math.cos(half)))


def _across(axis: FloatArray) -> FloatArray:
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    side = np.cross(axis, helper)
    return np.asarray(side / np.linalg.norm(side))


def _angle_between(a: FloatArray, b: FloatArray) -> float:
    return math.acos(min(max(0.5 * (float(np.trace(a.T @ b)) - 1.0), -1.0), 1.0))
