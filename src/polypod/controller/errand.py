"""What a foot is sent to do."""

from __future__ import annotations

from typing import NamedTuple

from polypod.math.vec3 import Vec3


class Errand(NamedTuple):
    """What a foot is sent to do."""

    preferred: Vec3  # world, m: where it would land on the plan
    seconds: float  # until touchdown
    velocity: Vec3  # with which it sets out, m per unit of progress
    launch: float  # its speed then over the mean speed
    radius: float  # m about the preferred place in which a footprint is looked for
