"""Figures of feet that have a shape: how flat they stand, and how deep any of it gets."""

from __future__ import annotations

import numpy as np

from polypod.report.arrays import FloatArray, rotate_all, runs_of
from polypod.report.ground import Ground
from polypod.report.record import Recording

# The middles of the shape's sides, then its corners, in half extents along the foot's x and z.
SIDES = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
CORNERS = np.array([[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]])


def contact_figures(recording: Recording, ground: Ground) -> dict[str, object]:
    """Return how far feet stand from flat on the ground, degrees, and how deep their shapes sink.

    A stance counts by the frame in which its foot is flattest: before and after it rolls. Depths
    are of the corners of the foot's shape, in leg lengths.
    """
    legs = recording.morphology.legs
    tilts: list[float] = []
    stance_depth: list[float] = [0.0]
    swing_depth: list[float] = [0.0]
    for foot in np.flatnonzero(legs.foot_joint >= 0):
        stance = recording.foot_stance[:, foot]
        tilt = _tilt(recording, ground, int(foot))
        tilts += [float(tilt[start:stop].min()) for start, stop in runs_of(stance)]
        depth = _depth(recording, ground, int(foot)) / float(legs.length[foot])
        stance_depth.append(float(depth[stance].max(initial=0.0)))
        swing_depth.append(float(depth[~stance].max(initial=0.0)))
    if not tilts:
        return dict.fromkeys(
            ("foot_tilt_deg", "foot_tilt_deg_max", "foot_sunk_of_leg", "foot_sunk_in_swing_of_leg")
        )
    return {
        "foot_tilt_deg": float(np.degrees(np.median(tilts))),
        "foot_tilt_deg_max": float(np.degrees(max(tilts))),
        "foot_sunk_of_leg": max(stance_depth),
        "foot_sunk_in_swing_of_leg": max(swing_depth),
    }


def _carried(recording: Recording, foot: int, offsets: FloatArray, row: int) -> FloatArray:
    """Return where places of a foot's shape are [F, N, 3], world m, if joint `row` carries them.

    `offsets` [N, 2] are from the middle of the shape along its x and z at rest, m.
    """
    morphology = recording.morphology
    legs = morphology.legs
    rest = np.tile(legs.sole_rest[foot] - morphology.joint_rest[row], (len(offsets), 1))
    rest[:, 0] += offsets[:, 0]
    rest[:, 2] += offsets[:, 1] - legs.foot_behind[foot]
    turned = rotate_all(recording.joint_rotation[:, row][:, None], rest)
    place: FloatArray = recording.joint_position[:, row][:, None] + turned
    return place


def _toe_row(recording: Recording, foot: int) -> int:
    """Return the joint that carries the front of a foot: its toes', or its own."""
    legs = recording.morphology.legs
    return int(legs.toe_joint[foot] if legs.toe_joint[foot] >= 0 else legs.foot_joint[foot])


def _tilt(recording: Recording, ground: Ground, foot: int) -> FloatArray:
    """Return the angle [F] between a foot and the plane of the ground under its shape, rad."""
    half = recording.morphology.legs.foot_half_size[foot]
    row = _toe_row(recording, foot)
    side = _carried(recording, foot, SIDES * half, row)
    frame = np.repeat(np.arange(len(side)), len(SIDES))
    height = ground.surface(side[..., 0].ravel(), side[..., 2].ravel(), frame)
    under = side.copy()
    under[..., 1] = height.reshape(side.shape[:2])
    across, along = under[:, 0] - under[:, 1], under[:, 2] - under[:, 3]
    normal = np.cross(along, across)
    up = rotate_all(recording.joint_rotation[:, row], np.array([0.0, 1.0, 0.0]))
    sine = np.linalg.norm(np.cross(up, normal), axis=1)
    angle: FloatArray = np.arctan2(sine, (up * normal).sum(axis=1))
    return angle


def _depth(recording: Recording, ground: Ground, foot: int) -> FloatArray:
    """Return how deep [F] the deepest corner of a foot's shape is inside anything, m."""
    legs = recording.morphology.legs
    offsets = CORNERS * legs.foot_half_size[foot]
    front = _carried(recording, foot, offsets[:2], _toe_row(recording, foot))
    back = _carried(recording, foot, offsets[2:], int(legs.foot_joint[foot]))
    corners = np.concatenate([front, back], axis=1)
    frame = np.repeat(np.arange(len(corners)), len(CORNERS))
    depth: FloatArray = ground.penetration(corners.reshape(-1, 3), frame)
    return np.maximum(depth.reshape(corners.shape[:2]).max(axis=1), 0.0)
