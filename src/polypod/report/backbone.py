"""Figures of the spine: how far it bends, within its limits and without twist (BIOMECHANICS 5, 12).

Read off the joints as they were recorded, by nothing that the spine itself is bent with.
"""

from __future__ import annotations

import numpy as np

from polypod.report.arrays import FloatArray, conjugate_all, multiply_all, rotate_all
from polypod.report.record import Recording
from polypod.report.strides import mean_stride_s

# A trunk whose segments yaw by less than this, rad, makes no wave to speak of.
WRIGGLES = np.radians(5.0)


def backbone_figures(recording: Recording) -> dict[str, object]:
    """Return the figures of the spine; None where a trunk is rigid.

    `spine_limit_excess_deg` and `spine_twist_step_deg` are over all frames and joints of spine and
    tail. `pelvis_yaw_deg` (against the body) and `spine_flexion_deg` (of the trunk's joints
    together) are from one end to the other in a stride, the median over the walk.
    `spine_travelling` is 0 where the trunk's wave stands, 1 where it travels (see `travelling`),
    None where there is none.
    """
    spine = recording.morphology.segments
    if not len(spine.joint):
        names = ("pelvis_yaw_deg", "spine_flexion_deg", "spine_travelling")
        return dict.fromkeys((*names, "spine_twist_step_deg", "spine_limit_excess_deg"))
    angles = joint_angles(recording)
    limit = np.concatenate([spine.limit[1:], spine.tail_limit])
    pelvis = recording.joint_rotation[:, spine.joint[0]]
    yaw = angles_of_turn(multiply_all(conjugate_all(recording.body_rotation), pelvis))[:, 0]
    flexion = angles[:, : max(spine.neck - 1, 0), 1].sum(axis=1)
    steps = np.abs(np.diff(angles[..., 2], axis=0))
    return {
        "pelvis_yaw_deg": _in_a_stride(recording, np.unwrap(yaw)),
        "spine_flexion_deg": _in_a_stride(recording, flexion),
        "spine_travelling": _wave(recording),
        "spine_twist_step_deg": float(np.degrees(steps.max())) if steps.size else 0.0,
        "spine_limit_excess_deg": float(np.degrees(max((np.abs(angles) - limit).max(), 0.0))),
    }


def joint_angles(recording: Recording) -> FloatArray:
    """Return [F, S - 1 + T, 3] rad: yaw, pitch (front up) and roll of the joints of spine and tail.

    Of each segment but the first against the one behind it; of the tail's against the one nearer
    the trunk.
    """
    spine = recording.morphology.segments
    turned = recording.joint_rotation
    rows = [*spine.joint[1:], *spine.tail_joint]
    above = [*spine.joint[:-1], *spine.joint[:1], *spine.tail_joint[:-1]][: len(rows)]
    return angles_of_turn(multiply_all(conjugate_all(turned[:, above]), turned[:, rows]))


def angles_of_turn(rotation: FloatArray) -> FloatArray:
    """Return [..., 3] rad: the heading, the pitch in it and the roll of rotations [..., 4]."""
    ahead = rotate_all(rotation, np.array([0.0, 0.0, 1.0]))
    left = rotate_all(rotation, np.array([1.0, 0.0, 0.0]))
    up = rotate_all(rotation, np.array([0.0, 1.0, 0.0]))
    yaw = np.arctan2(ahead[..., 0], ahead[..., 2])
    pitch = np.arcsin(np.clip(ahead[..., 1], -1.0, 1.0))
    return np.stack([yaw, pitch, np.arctan2(left[..., 1], up[..., 1])], axis=-1)


def travelling(angle: FloatArray, strides: float) -> float:
    """Return how far a wave [F, S] travels along its S places: 0 it stands, 1 it travels.

    Each place's part at the stride's frequency is a complex number; of a standing wave all have
    one phase. It is the lesser over the greater singular value of their real and imaginary parts
    (Feeny 2008, the travelling index of complex orthogonal decomposition).

    Args:
        angle: of each place, in frames evenly spaced.
        strides: how many the frames cover.
    """
    turn = np.exp(-2j * np.pi * strides * np.arange(len(angle)) / len(angle))
    part = turn @ (angle - angle.mean(axis=0)) / len(angle)
    most, least = np.linalg.svd(np.stack([part.real, part.imag]), compute_uv=False)
    return float(least / most) if most > 0.0 else 0.0


def _wave(recording: Recording) -> float | None:
    """Return how far the wave of the trunk's yaw travels in the walk's last whole strides."""
    stride = mean_stride_s(recording)
    seconds = float(np.ptp(recording.time))
    # What begins a walk takes a stride or two.
    if stride is None or seconds < 4.0 * stride:
        return None
    strides = int(0.5 * seconds / stride)
    frames = round(strides * stride * (len(recording.time) - 1) / seconds)
    spine = recording.morphology.segments
    rows = spine.joint[: max(spine.neck, 1)]
    body = conjugate_all(recording.body_rotation[-frames:, None])
    yaw = angles_of_turn(multiply_all(body, recording.joint_rotation[-frames:, rows]))[..., 0]
    yaw = np.unwrap(yaw, axis=0)
    return travelling(yaw, strides) if np.ptp(yaw, axis=0).max() > WRIGGLES else None


def _in_a_stride(recording: Recording, angle: FloatArray) -> float | None:
    """Return by how much an angle [F], rad, goes to and fro in a stride, degrees."""
    stride = mean_stride_s(recording)
    if stride is None:
        return None
    frames = round(stride * (len(recording.time) - 1) / float(np.ptp(recording.time)))
    if not 2 <= frames < len(angle):
        return None
    windows = np.lib.stride_tricks.sliding_window_view(angle, frames + 1)
    return float(np.degrees(np.median(np.ptp(windows, axis=1))))
