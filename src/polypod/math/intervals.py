"""Phases and sectors on a circle of circumference one.

A phase lies in [0, 1). A sector is half open: it holds its start and not its end, so that two
sectors that meet never both hold the same phase.
"""

from __future__ import annotations

import math

from polypod.compute import kernel
from polypod.gait.pattern import SAME_MOMENT, FloatArray


@kernel
def wrap_phase(phase: float) -> float:
    """Return the phase in [0, 1) that lies on the same place of the circle."""
    wrapped = phase - math.floor(phase)
    # A tiny negative phase rounds up to exactly 1.
    return wrapped if wrapped < 1.0 else 0.0


@kernel
def sector_progress(phase: float, start: float, extent: float) -> float:
    """Return how much of a sector lies behind a phase, in [0, 1), or -1 outside of the sector."""
    inside = wrap_phase(phase - start)
    return inside / extent if inside < extent else -1.0


@kernel
def covered_share(start: FloatArray, extent: FloatArray) -> float:
    """Return the share of the circle that sectors cover together.

    Args:
        start: [K] where each sector starts.
        extent: [K] how far it goes, 0 to 1.
    """
    covered = 1.0
    for k in range(start.shape[0]):
        end = wrap_phase(start[k] + extent[k])
        gap = 1.0
        for other in range(start.shape[0]):
            inside = wrap_phase(end - start[other])
            beyond = extent[other] - inside
            # Of sectors that end at the same place the last one's gap counts.
            if beyond > SAME_MOMENT or (abs(beyond) <= SAME_MOMENT and other > k):
                gap = 0.0
                break
            gap = min(gap, 1.0 - inside)
        covered -= gap
    return max(covered, 0.0)
