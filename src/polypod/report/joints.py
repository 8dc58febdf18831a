"""Figures of the joints: turns, bones, stretch, smoothness (BIOMECHANICS 5, rows 10, 11)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from polypod.ik.limits import limit_excess
from polypod.ik.table import build_ik_table
from polypod.report.arrays import FloatArray, angles_of, conjugate_all, multiply_all, rotate_all
from polypod.report.record import Recording, bones

if TYPE_CHECKING:
    from polypod.morphology.types import LegTable

# Between two frames in which the foot travels at most this many leg lengths, no joint may jump.
CALM_TRAVEL = 0.1


def joint_figures(recording: Recording, joint_limits: bool) -> dict[str, object]:
    """Return the figures of joints: turns, bones, limits, stretch, jerk, crossings."""
    return {
        **_turn_figures(recording),
        "bone_variation": _bone_variation(recording),
        **({"joint_limit_excess_deg": _limit_excess(recording)} if joint_limits else {}),
        "leg_stretch": _stretch(recording),
        "joint_jerk_m_s3": _jerk(recording.joint_position, recording.time),
        **_crossing_figures(recording),
    }


def leg_rows(legs: LegTable, leg: int) -> list[int]:
    """Return the rows of the joint table of one leg, hip first, its foot's joint last."""
    rows = [int(row) for row in legs.joint[leg, : legs.joint_count[leg]]]
    if legs.foot_joint[leg] >= 0:
        rows.append(int(legs.foot_joint[leg]))
    return rows


def frames_of_leg(recording: Recording, leg: int) -> FloatArray:
    """Return the rotation [F, 4] of what a leg hangs on: its girdle's segment, or the body."""
    spine = recording.morphology.segments
    segment = int(spine.of_leg[leg])
    row = int(spine.joint[segment]) if segment >= 0 else -1
    return recording.joint_rotation[:, row] if row >= 0 else recording.body_rotation


def turns_of_leg(recording: Recording, leg: int) -> FloatArray:
    """Return the turn [F - 1, N] of each joint of a leg relative to its parent, rad a frame.

    The parent is the joint above in the file, or the body: a foot that hangs on the root is
    judged against the root, as it plays.
    """
    rows = leg_rows(recording.morphology.legs, leg)
    turns = []
    for row in rows:
        parent = int(recording.morphology.joint_parent[row])
        above = recording.joint_rotation[:, parent] if parent >= 0 else recording.body_rotation
        local = multiply_all(conjugate_all(above), recording.joint_rotation[:, row])
        turns.append(angles_of(multiply_all(conjugate_all(local[:-1]), local[1:])))
    return np.stack(turns, axis=1)


def _turn_figures(recording: Recording) -> dict[str, object]:
    """Return the largest turn between frames in which the foot is calm, and whose it was."""
    if len(recording.time) < 2:
        return {"joint_turn_deg": None, "joint_turn_at": ""}
    most, where = 0.0, ""
    unturned = conjugate_all(recording.body_rotation)
    for leg, leg_length in enumerate(recording.morphology.legs.length):
        foot_world = recording.foot_position[:, leg]
        foot_body = rotate_all(unturned, foot_world - recording.body_position)
        # Calm as seen from the world or from the body: the stricter reading of either.
        travel = np.minimum(_steps(foot_world), _steps(foot_body))
        turn = turns_of_leg(recording, leg)
        turn[travel > CALM_TRAVEL * leg_length] = 0.0
        frame, joint = np.unravel_index(int(turn.argmax()), turn.shape)
        if turn[frame, joint] > most:
            most = float(turn[frame, joint])
            row = leg_rows(recording.morphology.legs, leg)[int(joint)]
            name = recording.morphology.joint_name[row] or f"node {row}"
            where = f"{name}, at {recording.time[int(frame) + 1]:.3f} s"
    return {"joint_turn_deg": float(np.degrees(most)), "joint_turn_at": where}


def _bone_variation(recording: Recording) -> float | None:
    """Return the largest (longest - shortest) / mean over bones."""
    pairs = bones(recording.morphology)
    if not len(pairs):
        return None
    ends = recording.joint_position
    length = np.linalg.norm(ends[:, pairs[:, 0]] - ends[:, pairs[:, 1]], axis=2)
    return float((np.ptp(length, axis=0) / length.mean(axis=0)).max())


def _limit_excess(recording: Recording) -> float:
    """Return the most that any joint of a leg is beyond its limits in any frame, degrees."""
    legs = recording.morphology.legs
    table = build_ik_table(legs)
    most = 0.0
    for leg, count in enumerate(legs.joint_count):
        rows = legs.joint[leg, :count]
        unturned = conjugate_all(frames_of_leg(recording, leg))[:, None]
        rotation_leg = multiply_all(unturned, recording.joint_rotation[:, rows])
        for turned in rotation_leg:
            most = max(most, limit_excess(table, leg, turned))
    return float(np.degrees(most))


def _stretch(recording: Recording) -> float:
    """Return the largest hip-to-sole distance over the leg's length."""
    legs = recording.morphology.legs
    hip = recording.joint_position[:, legs.joint[:, 0]]
    reach = np.linalg.norm(recording.foot_position - hip, axis=2)
    return float((reach / legs.length).max())


def _jerk(position: FloatArray, time: FloatArray) -> float | None:
    """Return the mean of |x3 - 3 x2 + 3 x1 - x0| fps^3, m/s^3 (row 10)."""
    if len(time) < 4:
        return None
    fps = (len(time) - 1) / (time[-1] - time[0])
    return float(np.linalg.norm(np.diff(position, n=3, axis=0), axis=-1).mean() * fps**3)


def _steps(place: FloatArray) -> FloatArray:
    step: FloatArray = np.linalg.norm(np.diff(place, axis=0), axis=1)
    return step


def _crossing_figures(recording: Recording) -> dict[str, object]:
    """Return how close soles come and in what share of frames two legs cross in plan."""
    legs = recording.morphology.legs
    feet = len(legs.length)
    if feet < 2:
        return {"feet_closest_of_leg": None, "legs_crossed_share": 0.0}
    hip = recording.joint_position[:, legs.joint[:, 0]][:, :, [0, 2]]
    sole = recording.foot_position[:, :, [0, 2]]
    crossed = np.zeros(len(recording.time), np.bool_)
    closest = np.inf
    for a in range(feet):
        for b in range(a + 1, feet):
            gap = recording.foot_position[:, a] - recording.foot_position[:, b]
            nearest = float(np.linalg.norm(gap, axis=1).min())
            closest = min(closest, nearest / max(float(legs.length[a]), float(legs.length[b])))
            crossed |= _segments_cross(hip[:, a], sole[:, a], hip[:, b], sole[:, b])
    return {"feet_closest_of_leg": closest, "legs_crossed_share": float(crossed.mean())}


def _segments_cross(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> np.ndarray:
    """Return in which rows the plan segments a-b and c-d [F, 2] cross."""

    def turn(p: FloatArray, q: FloatArray, r: FloatArray) -> FloatArray:
        u, v = q - p, r - p
        area: FloatArray = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        return area

    parted = turn(a, b, c) * turn(a, b, d)
    return (parted < 0.0) & (turn(c, d, a) * turn(c, d, b) < 0.0)
