"""A blow: what an impulse changes at once, of a body that has not moved yet (P2 5.2, 6)."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from polypod.body.push import FARTHEST_TURN, HARDEST, MOST_TIP, RECOVERY
from polypod.errors import SettingError
from polypod.gait.tempo import GRAVITY
from polypod.morphology.types import BodyTable, FloatArray, IntArray, Morphology


def judge_place(morphology: Morphology, at: float) -> None:
    """Refuse a place to push that is not on a creature's trunk; metres ahead of its centre.

    Raises:
        SettingError: it is not.
    """
    body = morphology.body
    back = float(min(body.box_centre[2] - body.half_size[2], 0.0))
    front = float(max(body.box_centre[2] + body.half_size[2], 0.0))
    if not isinstance(at, int | float) or not back <= at <= front:
        raise SettingError(
            f"a push at {at!r} is off the trunk of {morphology.name}, which reaches from "
            f"{back:.3g} to {front:.3g} m ahead of its centre"
        )


class Blow(NamedTuple):
    """What an impulse changes at once; N creatures."""

    velocity: FloatArray  # [N, 3] of the body's centre, world, m/s
    turn_rate: FloatArray  # [N] rad/s
    pitch_rate: FloatArray  # [N] of the slope lengthwise, 1/s
    roll_rate: FloatArray  # [N] of the slope across, 1/s


def strike(
    velocity: FloatArray, heading: FloatArray, at: float, body: BodyTable, recovery: float
) -> Blow:
    """Return what an impulse changes that gives the struck place of a trunk a velocity.

    Off the centre the trunk is lighter, and turns: it is taken as a plate of its box's plan.

    Args:
        velocity: [N, 3] of the struck place, world, m/s.
        heading: [N] rad.
        at: how far ahead of the body centre it is struck, m.
        body: the trunk.
        recovery: the rate of `recovery_rate`, 1/s.
    """
    pendulum = recovery / RECOVERY
    height = GRAVITY / (pendulum * pendulum)
    # The square of the plate's radius of gyration about the vertical.
    gyration = float(body.half_size[0] ** 2 + body.half_size[2] ** 2) / 3.0
    light = 1.0 if at == 0.0 else gyration / (gyration + at * at)
    lever = 0.0 if at == 0.0 else at / (gyration + at * at)
    sine, cosine = np.sin(heading), np.cos(heading)
    ahead = velocity[:, 0] * sine + velocity[:, 2] * cosine
    left = velocity[:, 0] * cosine - velocity[:, 2] * sine
    turn_rate, nod = lever * left, lever * velocity[:, 1]
    left = light * left
    up = light * velocity[:, 1]
    hardest = HARDEST * pendulum * height
    size = np.maximum(np.sqrt(ahead**2 + left**2 + up**2), 1e-12)
    share = np.minimum(hardest / size, 1.0)
    ahead, left, up = share * ahead, share * left, share * up
    most = FARTHEST_TURN * math.e * recovery
    tip = np.minimum(MOST_TIP * pendulum * height / np.maximum(np.hypot(ahead, left), 1e-12), 1.0)
    return Blow(
        np.stack([ahead * sine + left * cosine, up, ahead * cosine - left * sine], axis=1),
        np.clip(turn_rate, -most, most),
        np.clip(nod, -most, most) - tip * ahead / height,
        -tip * left / height,
    )


def land_blow(blow: Blow, rows: IntArray, state: Any, tables: Any) -> None:
    """Let an impulse act on the creatures of a herd's rows [N]."""
    rate = state.deflection[rows, 3:5] + blow.velocity[:, [0, 2]]
    hardest = HARDEST * GRAVITY * RECOVERY / tables.recovery
    size = np.maximum(np.hypot(rate[:, 0], rate[:, 1]), 1e-12)
    state.deflection[rows, 3:5] = rate * np.minimum(hardest / size, 1.0)[:, None]
    most = FARTHEST_TURN * math.e * tables.recovery
    turned = state.deflection[rows, 5] + blow.turn_rate
    state.deflection[rows, 5] = np.clip(turned, -most, most)
    state.tilt[rows, 0, 1] += blow.pitch_rate * tables.tilt_scale
    state.tilt[rows, 1, 1] += blow.roll_rate * tables.tilt_scale
    push_up(blow.velocity[:, 1], rows, state)


def push_up(speed: FloatArray, rows: IntArray, state: Any) -> None:
    """Let the vertical part of an impulse act: `speed` [N], m/s, of the rows [N] of a herd.

    Each foot's particle gets it, and the body, which is their mean.
    """
    state.particle_rise[rows] += speed[:, None]
