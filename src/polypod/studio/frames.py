"""A frame as bytes: poses of all creatures, obstacles, and all about the one in focus.

Poses go over the wire as float32 (docs/studio-protocol.md): 28 bytes a joint.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.gait.tempo import GRAVITY
from polypod.herd import Herd
from polypod.report.arrays import FloatArray, rotate_all

KIND = 1
FOCUS, FOOT = 16, 20
Floats = NDArray[np.float32]


class Focus(NamedTuple):
    """The creature whose details frames carry."""

    kind: int  # of the herds
    creature: int  # row of the herd


class Motion(NamedTuple):
    """What is told of the body's vertical motion, beside the state."""

    force: float  # g with which the feet push it
    load: FloatArray  # [K] g with which each foot pushes its particle


def pack_frame(
    number: int,
    time: float,
    herds: Sequence[Herd],
    obstacles: FloatArray,
    focus: Focus,
    motion: Motion,
    tape_frame: int | None = None,
) -> bytes:
    """Return a frame of a world.

    Args:
        number: of the frame.
        time: s.
        herds: the kinds of creatures.
        obstacles: [O, 7] quaternion and position, world, m.
        focus: whose details go along.
        motion: of that creature.
        tape_frame: which frame of the tape this shows, if it does.
    """
    pieces = []
    counts = []
    for herd in herds:
        body, pose = poses_of(herd)
        counts += [pose.shape[0], pose.shape[1]]
        pieces += [body.tobytes(), pose.tobytes()]
    details = focus_of(herds[focus.kind], focus, motion)
    feet = herds[focus.kind].state.swinging.shape[1]
    shown = 0 if tape_frame is None else tape_frame + 1
    head = struct.pack(
        "<IIdIIII", KIND, number, time, len(herds), len(obstacles), feet, shown
    ) + struct.pack(f"<{len(counts)}I", *counts)
    return b"".join([head, *pieces, obstacles.astype("<f4").tobytes(), details.tobytes()])


def poses_of(herd: Herd) -> tuple[Floats, Floats]:
    """Return bodies [C, 7] and joints [C, J + 1, 7] of a herd, the last the body, for skins.

    Quaternion q and shift t: a point of the rest pose, body frame, is at q x q* + t.
    """
    state = herd.state
    return joined_poses(
        state.position, state.rotation, state.joint_position, state.joint_rotation,
        herd.morphology.joint_rest,
    )  # fmt: skip


def joined_poses(
    position: FloatArray,
    rotation: FloatArray,
    joint_position: FloatArray,
    joint_rotation: FloatArray,
    joint_rest: FloatArray,
) -> tuple[Floats, Floats]:
    """Return what `poses_of` does, of bodies [C, 3], [C, 4] and joints [C, J, 3], [C, J, 4]."""
    body = np.concatenate([rotation, position], axis=1).astype("<f4")
    shift = joint_position - rotate_all(joint_rotation, joint_rest)
    joints = np.concatenate([joint_rotation, shift], axis=2).astype("<f4")
    return body, np.concatenate([joints, body[:, None]], axis=1)


def focus_of(herd: Herd, focus: Focus, motion: Motion) -> Floats:
    """Return the 16 numbers of the creature in focus, and 20 of each of its feet, in a row."""
    c, state = focus.creature, herd.state
    plane = state.plane_height[c]
    body = np.array(
        [
            state.needle[c], state.cycle_rate[c], state.speed[c], state.duty[c],
            state.position[c, 1] - plane, herd.command.arrays.body_height[c], motion.force,
            state.heading[c], state.turn_rate[c], state.sink[c], state.caution[c],
            state.activity[c], state.pace[c], c, focus.kind, state.position[c, 1],
        ]
    )  # fmt: skip
    standing = ~state.swinging[c]
    due = np.mod(state.swing_start[c] - state.needle[c], 1.0)
    soonest = due[standing].min() if standing.any() else np.inf
    feet = np.column_stack(
        [
            state.foot_reached[c], state.foot_target[c], state.foot_preferred[c],
            standing, state.waiting[c], state.swing_start[c], state.swing_extent[c],
            state.particle_offset[c], state.swing_progress[c], state.lift_phase[c],
            standing & (due <= soonest + 1e-6), motion.load,
            state.residual[c] / herd.tables.leg_length, np.zeros(len(standing)),
        ]
    )  # fmt: skip
    return np.concatenate([body, feet.ravel()]).astype("<f4")


class MotionMeter:
    """Tells forces from how heights change, frame by frame.

    The second difference over g, and 1: what a plate under the feet would weigh (BIOMECHANICS 5),
    and for each foot the load that its own particle is carried by (P2 4).
    """

    def __init__(self) -> None:
        self._heights: list[FloatArray] = []

    def forget(self) -> None:
        """Begin anew: another creature, or a jump in time."""
        self._heights = []

    def note(self, herd: Herd, creature: int, dt: float) -> Motion:
        """Return the motion of a creature after a step of `dt` s."""
        state = herd.state
        now = np.array([state.position[creature, 1], *state.particle_offset[creature]])
        self._heights = [*self._heights[-2:], now]
        if len(self._heights) < 3:
            return Motion(1.0, np.ones(len(now) - 1))
        before, middle, _ = self._heights
        force = 1.0 + (now - 2.0 * middle + before) / (dt * dt * GRAVITY)
        return Motion(float(force[0]), force[1:])
