"""Curves under the surfaces: rounded polylines, smooth tables of values, frames along a line."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def rounded_chain(chain: FloatArray, places: FloatArray, corner: float) -> FloatArray:
    """Return points [R, 3] of a polyline whose inner corners are quadratic arcs.

    Args:
        chain: [N, 3] the polyline.
        places: [R] places along it, in segments from 0 to N - 1.
        corner: part of each segment beside a corner, in [0, 0.5], that the arc takes.
    """
    segment = np.clip(places.astype(np.int64), 0, len(chain) - 2)
    rest = (places - segment)[:, None]
    result = chain[segment] * (1.0 - rest) + chain[segment + 1] * rest
    for bend in range(1, len(chain) - 1):
        before = chain[bend] + corner * (chain[bend - 1] - chain[bend])
        after = chain[bend] + corner * (chain[bend + 1] - chain[bend])
        inside = np.abs(places - bend) < corner
        part = ((places[inside] - bend) / (2.0 * corner) + 0.5)[:, None]
        result[inside] = (
            (1.0 - part) ** 2 * before + 2.0 * part * (1.0 - part) * chain[bend] + part**2 * after
        )
    return result


def monotone_curve(places: FloatArray, values: FloatArray, at: FloatArray) -> FloatArray:
    """Return values [R, C] of the monotone cubic (Fritsch and Carlson 1980) through keys [K, C]."""
    step = np.diff(places)[:, None]
    secant = np.diff(values, axis=0) / step
    slope = np.zeros_like(values)
    if len(places) == 2:
        slope[:] = secant[0]
    else:
        before, after = 2.0 * step[1:] + step[:-1], step[1:] + 2.0 * step[:-1]
        same = secant[:-1] * secant[1:] > 0.0
        with np.errstate(divide="ignore", invalid="ignore"):
            mean = (before + after) / (before / secant[:-1] + after / secant[1:])
        slope[1:-1] = np.where(same, mean, 0.0)
        slope[0] = _end_slope(step[0], step[1], secant[0], secant[1])
        slope[-1] = _end_slope(step[-1], step[-2], secant[-1], secant[-2])
    index = np.clip(np.searchsorted(places, at, side="right") - 1, 0, len(places) - 2)
    width = step[index]
    t = (at - places[index])[:, None] / width
    return (
        (1.0 + 2.0 * t) * (1.0 - t) ** 2 * values[index]
        + t * (1.0 - t) ** 2 * width * slope[index]
        + t**2 * (3.0 - 2.0 * t) * values[index + 1]
        + t**2 * (t - 1.0) * width * slope[index + 1]
    )


def arc_length(points: FloatArray) -> FloatArray:
    """Return the length [R] along a polyline up to each of its points."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def frames(centres: FloatArray, side: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the directions [R, 3] across and up of the sections of a curve."""
    steps = np.diff(centres, axis=0)
    steps /= np.linalg.norm(steps, axis=1, keepdims=True)
    tangent = np.concatenate([steps[:1], steps[:-1] + steps[1:], steps[-1:]])
    up = np.cross(tangent, side)
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    across = np.cross(up, tangent)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    return across, up


def _end_slope(
    near: FloatArray, far: FloatArray, secant: FloatArray, next_secant: FloatArray
) -> FloatArray:
    """Return the three-point slope at an end, kept monotone."""
    slope = ((2.0 * near + far) * secant - near * next_secant) / (near + far)
    slope = np.where(slope * secant <= 0.0, 0.0, slope)
    steep = (secant * next_secant <= 0.0) & (np.abs(slope) > 3.0 * np.abs(secant))
    return np.where(steep, 3.0 * secant, slope)
