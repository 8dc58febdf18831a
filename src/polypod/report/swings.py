"""Figures of the swinging foot: what it went through, how high, how fast (rows 2, 9, 11)."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from polypod.report.arrays import FloatArray, runs_of
from polypod.report.ground import Ground
from polypod.report.record import Recording

# A swing frame deeper than this many leg lengths counts as inside.
INSIDE = 0.01
# Places looked at between two frames for a crossing: what plays is the chord.
CHORD_PLACES = 8


def swing_figures(recording: Recording, ground: Ground) -> dict[str, object]:
    """Return the figures of swing feet; lengths in leg lengths of the foot's own leg."""
    swing = ~recording.foot_stance
    if not swing.any():
        return {"swing_count": 0}
    leg_length = np.broadcast_to(recording.morphology.legs.length, swing.shape)[swing]
    place = recording.foot_position[swing]
    inside = ground.penetration(place, np.nonzero(swing)[0]) / leg_length
    residual = np.linalg.norm(place - recording.foot_target[swing], axis=1) / leg_length
    return {
        "swing_inside_of_leg": float(inside.max()),
        "swing_inside_share": float((inside > INSIDE).mean()),
        "swing_residual_of_leg_999": float(np.quantile(residual, 0.999, method="lower")),
        "swing_residual_of_leg": float(residual.max()),
        "swing_residual_share_beyond": float((residual > 0.001).mean()),
        **_shape_of_swings(recording),
    }


def _shape_of_swings(recording: Recording) -> dict[str, object]:
    """Return how high and how unevenly fast the feet swing, over complete swings."""
    apexes: list[float] = []
    peaks: list[float] = []
    count = 0
    for foot, leg_length in enumerate(recording.morphology.legs.length):
        for start, stop in runs_of(~recording.foot_stance[:, foot]):
            if start == 0 or stop == len(recording.time):
                continue
            count += 1
            # From the last frame of stance to the first: lift-off and touchdown lie between.
            path = recording.foot_position[start - 1 : stop + 1, foot]
            apex = path[:, 1].max() - max(path[0, 1], path[-1, 1])
            apexes.append(float(apex / leg_length))
            step_s = np.diff(recording.time[start - 1 : stop + 1])
            speed = np.linalg.norm(np.diff(path, axis=0), axis=1) / step_s
            # The first and last step are partly stance: they would dilute the mean.
            inner = speed[1:-1]
            if inner.size >= 3 and inner.mean() > 0.0:
                peaks.append(float(inner.max() / inner.mean()))
    return {
        "swing_count": count,
        "swing_apex_of_leg": float(np.median(apexes)) if apexes else None,
        "swing_apex_of_leg_max": max(apexes, default=None),
        "swing_speed_peak_over_mean": float(np.median(peaks)) if peaks else None,
    }


def forbidden_figures(recording: Recording, ground: Ground) -> dict[str, object]:
    """Return how often feet stood on forbidden obstacles or passed over them.

    A crossing is a swing with any place, on the chords between its frames too, inside a forbidden
    obstacle's projection on the ground plane.
    """
    stances = crossings = 0
    for foot in range(len(recording.morphology.foot_name)):
        places = recording.foot_position[:, foot]
        for start, stop in runs_of(recording.foot_stance[:, foot]):
            support = int(recording.foot_support[start, foot])
            frame = np.arange(start, stop)
            over = ground.over_forbidden(places[start:stop], frame).any()
            stances += int(support in ground.forbidden or over)
        for start, stop in runs_of(~recording.foot_stance[:, foot]):
            first = max(start - 1, 0)
            path = _chords(places[first : stop + 1])
            moments = first + np.arange(len(path)) / CHORD_PLACES
            crossings += int(ground.over_forbidden(path, moments).any())
    return {"forbidden_stances": stances, "forbidden_crossings": crossings}


def _chords(places: FloatArray) -> FloatArray:
    """Return places [N, 3] on the straight ways between the frames' places [F, 3]."""
    share = np.linspace(0.0, 1.0, CHORD_PLACES, endpoint=False)[:, None]
    legs = [a + (b - a) * share for a, b in pairwise(places)]
    return np.concatenate([*legs, places[-1:]])
