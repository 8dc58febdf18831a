"""Where the joints of a standing leg lie, from its segments' lengths and its foot on the ground."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from polypod.morphology.builtin.curves import FloatArray

HALVINGS = 60  # of the bisection; the bracket ends below the rounding of a double


def spread_leg(
    leg: Sequence[float], hip_height: float, lengths: Sequence[float], bends: Sequence[float]
) -> FloatArray:
    """Return the joints [N + 1, 3] of a leg by where its hip is and where it goes from there.

    Args:
        leg: the hip's x and z, the heading of the foot from +Z toward +X in degrees, its distance
            from the hip in plan, and what the segments are scaled by; m.
        hip_height: m.
        lengths: N segments from the hip, m, before they are scaled.
        bends: see `folded_leg`.
    """
    x, z, heading, distance, scale = leg
    hip = np.array([x, hip_height, z])
    turn = np.radians(heading)
    foot = hip * (1.0, 0.0, 1.0) + distance * np.array([np.sin(turn), 0.0, np.cos(turn)])
    return folded_leg(hip, foot, [scale * length for length in lengths], bends)


def folded_leg(
    hip: ArrayLike, foot: ArrayLike, lengths: Sequence[float], bends: Sequence[float]
) -> FloatArray:
    """Return the joints of a leg standing in the vertical plane through its hip and foot.

    The bends keep their proportions and are scaled together until the leg spans hip to foot.

    Args:
        hip: [3] world, m.
        foot: [3] world, m; not straight below the hip.
        lengths: N segments from the hip, m.
        bends: N - 1 angles at the joints between, degrees; positive turns downward, knee up.

    Returns:
        N + 1 points [N + 1, 3] from the hip to the foot, both exact.
    """
    start, end = np.asarray(hip, dtype=np.float64), np.asarray(foot, dtype=np.float64)
    out = (end - start) * (1.0, 0.0, 1.0)
    out /= np.linalg.norm(out)
    span = float(np.linalg.norm(end - start))
    relative = np.concatenate([[0.0], -np.cumsum(np.radians(bends))])
    low, high = 0.0, 2.0  # the span shrinks as the fold grows
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if np.linalg.norm(_plane_chain(lengths, relative * middle)[-1]) > span:
            low = middle
        else:
            high = middle
    flat = _plane_chain(lengths, relative * low)
    aim = np.arctan2(end[1] - start[1], (end - start) @ out) - np.arctan2(flat[-1, 1], flat[-1, 0])
    flat = _plane_chain(lengths, relative * low + aim)
    points = start + flat[:, :1] * out + flat[:, 1:] * np.array([0.0, 1.0, 0.0])
    points[-1] = end
    return points


def outward_side(points: FloatArray) -> FloatArray:
    """Return the "across" direction [3] that makes "up" point up on a leg in a vertical plane."""
    out = points[-1] - points[0]
    side = np.array([out[2], 0.0, -out[0]])
    length = np.linalg.norm(side)
    return side / length


def _plane_chain(lengths: Sequence[float], angles: FloatArray) -> FloatArray:
    """Return the points [N + 1, 2] of segments at angles against the horizontal."""
    steps = np.asarray(lengths)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
