"""Figures of the standing foot: slip, float, sinking, residual (BIOMECHANICS 5, rows 1, 2, 11)."""

from __future__ import annotations

import numpy as np

from polypod.report.arrays import (
    FloatArray,
    conjugate_all,
    rotate_all,
    runs_of,
    widest,
)
from polypod.report.ground import Ground
from polypod.report.record import Recording


def slip_per_stance(recording: Recording, foot_position: FloatArray) -> list[float]:
    """Return for each stance the largest distance between two places of its foot, leg lengths.

    `foot_position` [F, K, 3] may be the record's or one read back from a file. A foot on an
    obstacle is seen from that obstacle.
    """
    slips: list[float] = []
    for foot, leg_length in enumerate(recording.morphology.legs.length):
        for start, stop in runs_of(recording.foot_stance[:, foot]):
            place = foot_position[start:stop, foot]
            support = int(recording.foot_support[start, foot])
            if support >= 0:
                place = rotate_all(
                    conjugate_all(recording.obstacle_rotation[start:stop, support]),
                    place - recording.obstacle_position[start:stop, support],
                )
            slips.append(widest(place) / float(leg_length))
    return slips


def stance_figures(
    recording: Recording, ground: Ground, foot_position: FloatArray | None = None
) -> dict[str, object]:
    """Return the figures of stance feet; lengths in leg lengths of the foot's own leg.

    `foot_position` [F, K, 3] replaces the record's, to judge places read back from a file.
    """
    place = recording.foot_position if foot_position is None else foot_position
    stance = recording.foot_stance
    leg_length = np.broadcast_to(recording.morphology.legs.length, stance.shape)[stance]
    standing = place[stance]
    frame = np.nonzero(stance)[0]
    height = standing[:, 1] - ground.surface(standing[:, 0], standing[:, 2], frame)
    inside = ground.penetration(standing, frame)
    residual = np.linalg.norm(standing - recording.foot_target[stance], axis=1)
    both = stance[1:] & stance[:-1]
    own = _seen_from_support(recording, place)
    travel = np.linalg.norm((own[1:] - own[:-1])[both][:, [0, 2]], axis=1)
    slips = slip_per_stance(recording, place)
    return {
        "stance_count": len(slips),
        "stance_slip_of_leg": max(slips, default=None),
        "stance_skate_mm_a_frame": _largest(1000.0 * travel),
        "stance_off_surface_of_leg": _largest(np.abs(height) / leg_length),
        "stance_float_of_leg": _largest(np.maximum(height, 0.0) / leg_length),
        "stance_sunk_of_leg": _largest(np.maximum(-height, 0.0) / leg_length),
        "stance_inside_of_leg": _largest(inside / leg_length),
        "stance_residual_of_leg": _largest(residual / leg_length),
    }


def _seen_from_support(recording: Recording, place: FloatArray) -> FloatArray:
    """Return places of feet [F, K, 3] as what each stands on sees them, along its first axes."""
    own = place.copy()
    frame, foot = np.nonzero(recording.foot_stance & (recording.foot_support >= 0))
    support = recording.foot_support[frame, foot]
    if len(support):
        now, first = recording.obstacle_rotation[frame, support], recording.obstacle_rotation[0]
        arm = place[frame, foot] - recording.obstacle_position[frame, support]
        own[frame, foot] = rotate_all(first[support], rotate_all(conjugate_all(now), arm))
    return own


def _largest(values: FloatArray) -> float | None:
    return float(values.max()) if values.size else None
