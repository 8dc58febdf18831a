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
def phase_until(needle: float, phase: float) -> float:
    """Return how far ahead of the needle a phase lies, as a fraction of the cycle in [0, 1)."""
    return wrap_phase(phase - needle)


@kernel
def phase_between(from_phase: float, to_phase: float) -> float:
    """Return the signed way from one phase to another by the shorter arc, in (-0.5, 0.5]."""
    ahead = wrap_phase(to_phase - from_phase)
    return ahead if ahead <= 0.5 else ahead - 1.0


@kernel
def sector_progress(phase: float, start: float, extent: float) -> float:
    """Return how much of a sector lies behind a phase, in [0, 1), or -1 outside of the sector."""
    inside = wrap_phase(phase - start)
    return inside / extent if inside < extent else -1.0


@kernel
def times_passed(needle: float, turn: float, phase: float) -> int:
    """Return how often a needle that turns by `turn` >= 0 passes a phase.

    The needle passes what lies in (needle, needle + turn]; a turn may be longer than the circle.
    """
    ahead = wrap_phase(phase - needle)
    if ahead == 0.0:
        ahead = 1.0
    return math.floor(turn - ahead) + 1 if turn >= ahead else 0
