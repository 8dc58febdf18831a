"""A filter whose output has continuous acceleration, exact for any time step."""

from __future__ import annotations

import math
from typing import Any

from polypod.compute import kernel


@kernel
def follow(memory: Any, target: float, seconds: float, dt: float) -> float:
    """Move `memory` [value, rate, input] toward `target` and return the value.

    The input is a low pass of the target and the value a critically damped spring toward it, so a
    step of the target bends the motion without a jolt. `seconds` is the time in which most of a
    step is made up. The spring's solution for a constant input is used, not a difference scheme.
    """
    if seconds < 1e-9:
        memory[0] = target
        memory[1] = 0.0
        memory[2] = target
        return target
    # Three equal poles: half of a step is made up after 2.7 of their time constants.
    pole = 4.0 / seconds
    decay = math.exp(-pole * dt)
    memory[2] += (target - memory[2]) * (1.0 - decay)
    gap = memory[0] - memory[2]
    drift = memory[1] + pole * gap
    memory[0] = memory[2] + (gap + drift * dt) * decay
    memory[1] = (memory[1] - pole * drift * dt) * decay
    value: float = memory[0]
    return value
