"""Stride-to-stride variation: no animal's strides all last equally long (2-4 %, BIOMECHANICS 2).

Each cycle's duration has a factor of its own, a function of seed, creature and the cycle's number
and of nothing else: the same for any threads and company, and for any frame rate.
"""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel

MASK = 0xFFFFFFFF
# Uniform numbers whose sum is nearly normal, and the root of what the sum of so many varies by.
SUMMED = 4
SPREAD = math.sqrt(SUMMED / 12.0)
# However much strides vary, none is shorter than this share of its time.
SHORTEST = 0.2


@kernel
def mixed(value: int) -> int:
    """Return a number of 32 bits that depends on all bits of another."""
    value = ((value ^ (value >> 16)) * 0x045D9F3B) & MASK
    value = ((value ^ (value >> 16)) * 0x045D9F3B) & MASK
    return value ^ (value >> 16)


@kernel
def period_factor(seed: int, creature: int, cycle: int, variation: float) -> float:
    """Return by what a cycle's duration is multiplied: mean 1, standard deviation `variation`.

    Near to normal, within 3.5 standard deviations.
    """
    state = mixed(mixed(mixed(seed & MASK) ^ (creature & MASK)) ^ (cycle & MASK))
    total = 0.0
    for _ in range(SUMMED):
        state = mixed((state + 0x3C6EF372) & MASK)
        total += (state + 0.5) / (MASK + 1.0)
    return max(1.0 + variation * (total - 0.5 * SUMMED) / SPREAD, SHORTEST)


@kernel
def varied_period(c: int, dt: float, period: float, state: Any, settings: Any) -> float:
    """Return the duration, s, of the cycles that a creature turns through in a step of `dt` s.

    Each has its own factor of `period`; the count of cycles goes on.
    """
    done = math.floor(state.cycles[c])
    seed = state.seed[c]
    creature = state.member[c]
    now = period * period_factor(seed, creature, int(done), settings.stride_variation)
    left = done + 1.0 - state.cycles[c]
    # Steps are shorter than a cycle: at most one ends within.
    if dt < left * now:
        state.cycles[c] += dt / now
        return now
    after = period * period_factor(seed, creature, int(done) + 1, settings.stride_variation)
    rest = (dt - left * now) / after
    state.cycles[c] = done + 1.0 + rest
    return dt / (left + rest)
