"""Phases and sectors on a circle of circumference one.

A phase lies in [0, 1). A sector is half open: it holds its start and not its end, so that two
sectors that meet never both hold the same phase.
"""

from __future__ import annotations

import math

from polypod.compute import kernel


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
