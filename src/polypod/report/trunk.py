"""Figures of the trunk: way, bounce, implied force, clearance, tilt (rows 5, 7, 10)."""

from __future__ import annotations

import numpy as np

from polypod.report.arrays import FloatArray, rotate_all, runs_of
from polypod.report.ground import Ground
from polypod.report.record import Recording
from polypod.report.strides import mean_stride_s

GRAVITY = 9.81
# The belly is looked at on a grid this wide, over this share of the trunk's box: trunks are round.
BELLY_PLACES = 5
BELLY_SHARE = 0.7
# Motion above this many times the stride's frequency is tremor, not gait (row 10).
TREMOR_STRIDES = 6.0
# Less than this, leg lengths, nobody sees.
STILL = 1e-3


def way_figures(recording: Recording, commanded_distance_m: float | None) -> dict[str, object]:
    """Return how far the body went over the ground plane, m.

    `distance_m` is the length of the way sampled once a stride (or half a second, whichever is
    longer), so that sway does not count as going forward.
    """
    time = recording.time
    place = recording.body_position[:, [0, 2]]
    spacing_s = max(mean_stride_s(recording) or 0.0, 0.5)
    marks = np.arange(time[0], time[-1], spacing_s)
    frames = np.append(np.searchsorted(time, marks), len(time) - 1)
    way = float(np.linalg.norm(np.diff(place[frames], axis=0), axis=1).sum())
    figures: dict[str, object] = {
        "distance_m": way,
        "distance_net_m": float(np.linalg.norm(place[-1] - place[0])),
    }
    if commanded_distance_m is not None:
        figures["distance_commanded_m"] = commanded_distance_m
        if commanded_distance_m > 0.0:
            figures["distance_share"] = way / commanded_distance_m
    return figures


def trunk_figures(recording: Recording, ground: Ground) -> dict[str, object]:
    """Return the figures of the trunk's motion; heights in metres, forces in g."""
    return {
        "body_clearance_of_leg": float(belly_clearance(recording, ground).min())
        / float(recording.morphology.legs.length.max()),
        **_bounce_figures(recording),
        **_tilt_figures(recording),
    }


def belly_clearance(recording: Recording, ground: Ground) -> FloatArray:
    """Return the least height [F] of the belly above what lies under it, m."""
    body = recording.morphology.body
    share = np.linspace(-BELLY_SHARE, BELLY_SHARE, BELLY_PLACES)
    across, along = np.meshgrid(share * body.half_size[0], share * body.half_size[2])
    belly_body = np.stack(
        [
            body.box_centre[0] + across.ravel(),
            np.full(across.size, -body.thickness),
            body.box_centre[2] + along.ravel(),
        ],
        axis=1,
    )
    belly = recording.body_position[:, None] + rotate_all(
        recording.body_rotation[:, None], belly_body
    )
    points = belly.reshape(-1, 3)
    frame = np.repeat(np.arange(len(recording.time)), belly_body.shape[0])
    gap = points[:, 1] - ground.surface(points[:, 0], points[:, 2], frame)
    least: FloatArray = gap.reshape(len(recording.time), -1).min(axis=1)
    return least


def _bounce_figures(recording: Recording) -> dict[str, object]:
    """Return excursion, phase, implied force and tremor of the body's height.

    `body_mid_stance` is its height over the stride's mean at the middle of the feet's stances, half
    excursions: -1 where it is lowest at every foot's mid-stance, 1 where it is highest.
    """
    height, time = recording.body_position[:, 1], recording.time
    stride_s = mean_stride_s(recording)
    nothing = dict.fromkeys(
        (
            "body_excursion_m",
            "body_mid_stance",
            "body_force_least_g",
            "body_force_mean_g",
            "body_tremor_share",
        )
    )
    if stride_s is None or len(time) < 8:
        return dict(nothing)
    fps = (len(time) - 1) / (time[-1] - time[0])
    frames = max(round(stride_s * fps), 2)
    force = 1.0 + np.diff(height, n=2) * fps**2 / GRAVITY
    figures: dict[str, object] = dict(nothing)
    figures["body_force_least_g"] = float(force.min())
    figures["body_force_mean_g"] = float(force.mean())
    if len(height) < 3 * frames:
        return figures
    # What the ground does to the height is slower than a stride: take its running mean away.
    trend = np.convolve(height, np.full(frames, 1.0 / frames), "valid")
    first = frames // 2
    bounce = height[first : first + len(trend)] - trend
    windows = np.lib.stride_tricks.sliding_window_view(bounce, frames)
    figures["body_excursion_m"] = float(np.median(np.ptp(windows, axis=1)))
    figures["body_mid_stance"] = _at_mid_stance(recording, bounce, first)
    energy = np.abs(np.fft.rfft(bounce * np.hanning(len(bounce)))) ** 2
    frequency = np.fft.rfftfreq(len(bounce), 1.0 / fps)
    total = float(energy[1:].sum())
    tremor = float(energy[frequency > TREMOR_STRIDES / stride_s].sum())
    # A body that hardly bounces has no tremor either: in a walk whose feet cancel, what is left of
    # their beats are the last ones, a thousandth of a leg high and not to be seen.
    still = float(np.ptp(bounce)) < STILL * float(recording.morphology.legs.length.max())
    figures["body_tremor_share"] = 0.0 if still else tremor / total
    return figures


def _at_mid_stance(recording: Recording, bounce: FloatArray, first: int) -> float | None:
    """Return the mean of a bounce at mid-stances, half excursions; its first frame is `first`."""
    places = np.arange(len(bounce)) + first
    middles = [
        0.5 * (start + end - 1)
        for foot in range(recording.foot_stance.shape[1])
        # The first and the last may be cut short.
        for start, end in runs_of(recording.foot_stance[:, foot])[1:-1]
    ]
    inside = [middle for middle in middles if places[0] <= middle <= places[-1]]
    size = 0.5 * float(np.ptp(bounce))
    if not inside or size <= 0.0:
        return None
    return float(np.interp(inside, places, bounce).mean()) / size


def _tilt_figures(recording: Recording) -> dict[str, object]:
    """Return the largest tilt of the trunk and how fast it tilts."""
    up = rotate_all(recording.body_rotation, np.array([0.0, 1.0, 0.0]))
    tilt = np.degrees(np.arccos(np.clip(up[:, 1], -1.0, 1.0)))
    rate = np.linalg.norm(np.diff(up, axis=0), axis=1) / np.diff(recording.time)
    return {
        "body_tilt_deg": float(tilt.max()),
        "body_tilt_rate_deg_s": float(np.degrees(rate.max())) if rate.size else None,
    }
