"""Figures of the gait: duty, stride, phase, support (BIOMECHANICS 5, rows 3, 4, 8)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from polypod.report.arrays import FloatArray, runs_of
from polypod.report.record import Recording


def stride_figures(
    recording: Recording, gait_duty: ArrayLike | None = None, gait_phase: ArrayLike | None = None
) -> dict[str, object]:
    """Return the figures of the gait, over each foot's complete strides.

    A stride lasts from touchdown to touchdown. Phases are touchdowns as fractions of the stride
    after those of foot 0. `gait_duty` and `gait_phase` [K] are what the gait asks for; only
    differences between feet are judged, since the gait's clock has no mark in a record.
    """
    stance, time = recording.foot_stance, recording.time
    feet = stance.shape[1]
    touchdowns = [_touchdowns(stance[:, foot]) for foot in range(feet)]
    duty: list[float | None] = []
    period: list[float | None] = []
    length: list[float | None] = []
    for foot, frames in enumerate(touchdowns):
        if len(frames) < 2:
            duty.append(None)
            period.append(None)
            length.append(None)
            continue
        place = recording.foot_position[frames, foot][:, [0, 2]]
        duty.append(float(stance[frames[0] : frames[-1], foot].mean()))
        period.append(float(np.diff(time[frames]).mean()))
        length.append(float(np.linalg.norm(np.diff(place, axis=0), axis=1).mean()))
    phase = [_phase(time, touchdowns[0], frames) for frames in touchdowns]
    down = stance.sum(axis=1)
    figures: dict[str, object] = {
        "stride_s": _mean(period),
        "stride_m": _mean(length),
        "duty": _mean(duty),
        "duty_of_foot": duty,
        "phase_of_foot": phase,
        "feet_down_mean": float(down.mean()),
        "feet_down_least": int(down.min()),
        "flight_share": float((down == 0).mean()),
        "gait_shares": gait_shares(recording),
    }
    if gait_duty is not None:
        figures["duty_error"] = _largest_difference(duty, np.asarray(gait_duty, float))
    if gait_phase is not None:
        figures["phase_error"] = _phase_error(phase, np.asarray(gait_phase, float))
    return figures


def gait_shares(recording: Recording) -> dict[str, float]:
    """Return the share of the frames in each gait, in the order in which they were first taken."""
    names = recording.gait.tolist()
    return {name: names.count(name) / len(names) for name in dict.fromkeys(names)}


def mean_stride_s(recording: Recording) -> float | None:
    """Return the mean time between touchdowns of the same foot, or None where no foot has two."""
    periods = []
    for foot in range(recording.foot_stance.shape[1]):
        frames = _touchdowns(recording.foot_stance[:, foot])
        if len(frames) >= 2:
            periods.append(float(np.diff(recording.time[frames]).mean()))
    return float(np.mean(periods)) if periods else None


def _touchdowns(stance: np.ndarray) -> list[int]:
    """Return the frames in which a stance begins that the record saw beginning."""
    return [start for start, _ in runs_of(stance) if start > 0]


def _phase(time: FloatArray, reference: list[int], frames: list[int]) -> float | None:
    """Return the circular mean of touchdowns within the strides of the reference foot."""
    if len(reference) < 2:
        return None
    begins = time[reference]
    moments = time[frames]
    moments = moments[(moments >= begins[0]) & (moments < begins[-1])]
    if not moments.size:
        return None
    stride = np.searchsorted(begins, moments, side="right") - 1
    share = (moments - begins[stride]) / (begins[stride + 1] - begins[stride])
    return float(np.angle(np.exp(2j * np.pi * share).mean()) / (2.0 * np.pi) % 1.0)


def _phase_error(phase: list[float | None], asked: FloatArray) -> float | None:
    """Return the largest circular error after the best common shift, a share of the stride."""
    known = [foot for foot, value in enumerate(phase) if value is not None]
    if not known:
        return None
    measured = np.array([phase[foot] for foot in known], float)
    error = np.exp(2j * np.pi * (measured - asked[known]))
    error *= np.conj(error.mean()) / max(abs(error.mean()), 1e-12)
    return float(np.abs(np.angle(error)).max() / (2.0 * np.pi))


def _largest_difference(measured: list[float | None], asked: FloatArray) -> float | None:
    known = [abs(value - asked[foot]) for foot, value in enumerate(measured) if value is not None]
    return float(max(known)) if known else None


def _mean(values: list[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return float(np.mean(known)) if known else None
