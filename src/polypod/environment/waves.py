"""The heights of hills: a sum of cosines, for any places."""

from __future__ import annotations

import math

import numpy as np

from polypod.environment.lattice import FloatArray

WAVES = 12


def waves(seed: int, wavelength: float, x: FloatArray, z: FloatArray) -> FloatArray:
    """Return a sum of cosines in random directions, over places whose arrays fit each other."""
    random = np.random.default_rng(seed)
    direction = random.uniform(0.0, 2.0 * math.pi, WAVES)
    number = 2.0 * math.pi / wavelength * random.uniform(1.0, 2.0, WAVES)
    shift = random.uniform(0.0, 2.0 * math.pi, WAVES)
    heights = np.zeros(np.broadcast_shapes(x.shape, z.shape))
    for angle, wave, phase in zip(direction, number, shift, strict=True):
        heights += np.cos(wave * math.cos(angle) * x + wave * math.sin(angle) * z + phase) / wave
    return heights
