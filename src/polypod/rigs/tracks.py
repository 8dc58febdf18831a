"""From a recording to what each node must do: translations, rotations and scales per frame.

A recording says where each joint is, as a rigid motion away from the rest. A file wants each
node's motion in its parent's frame. Going down the tree, each node's track is found against what
its ancestors do *after* rounding to the file's single precision, so that errors do not add up.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from polypod.errors import RigError
from polypod.report.record import Recording
from polypod.rigs.nodes import (
    FloatArray,
    IntArray,
    compose,
    decompose,
    parent_first_order,
    rotation_matrices,
)

# What counts as no motion at all: a share of the creature's size, an angle (half of it, rad) and a
# share of the scale. Each is a few roundings of single precision.
STILL_TRANSLATION = 2e-7
STILL_ROTATION = 3e-7
STILL_SCALE = 1e-6
PATHS = ("translation", "rotation", "scale")


@dataclass(frozen=True, eq=False)
class Track:
    """What one property of one node does."""

    node: int
    path: str  # one of PATHS
    values: NDArray[np.float32]  # [F, 3], or [F, 4] for a rotation


@dataclass(frozen=True, eq=False)
class RestParts:
    """The nodes of the file that is written, as they are when nothing plays."""

    parents: IntArray  # [N]
    local: FloatArray  # [N, 4, 4] the matrices, which may hold more than the three parts can
    translation: FloatArray  # [N, 3]
    rotation: FloatArray  # [N, 4] unit
    scale: FloatArray  # [N, 3]
    names: tuple[str, ...]  # [N] for messages


def motion_matrices(recording: Recording) -> FloatArray:
    """Return [F, 4, 4] what takes the file's bind pose to the world, rigid on the body, metres."""
    count = len(recording.time)
    scale = np.ones((count, 3))
    body = compose(recording.body_position, recording.body_rotation, scale)
    return np.asarray(body @ recording.morphology.source.body_from_file)


def joint_matrices(recording: Recording, row: int) -> FloatArray:
    """Return [F, 4, 4] a joint's world matrix, metres: bind pose, to the body frame, moved."""
    source = recording.morphology.source
    turn = rotation_matrices(recording.joint_rotation[:, row])
    shift = recording.joint_position[:, row] - turn @ recording.morphology.joint_rest[row]
    rest_body = source.body_from_file @ source.joint_rest_file[row]
    posed = np.tile(np.eye(4), (len(turn), 1, 1))
    posed[:, :3, :3] = turn @ rest_body[:3, :3]
    posed[:, :3, 3] = turn @ rest_body[:3, 3] + shift
    return posed


def tracks_of(
    recording: Recording, rest: RestParts, motion_node: int, keyed: set[tuple[int, str]]
) -> list[Track]:
    """Return the tracks of all nodes that move, ancestors first.

    Args:
        recording: the walk.
        rest: the nodes of the file.
        motion_node: the node that carries the creature through the world.
        keyed: (node, path) that other animations of the file move. They get a track here even
            where they rest: Blender, for one, leaves them as the animation before put them.

    Raises:
        RigError: a node above a joint has scale zero, so that the joint cannot be placed.
    """
    row_of_node = {int(node): row for row, node in enumerate(recording.morphology.joint_node)}
    needed = _with_ancestors([*row_of_node, motion_node], rest.parents)
    size = float(np.ptp(recording.morphology.joint_rest, axis=0).max(initial=0.0))
    size = max(size, float(recording.morphology.legs.length.max(initial=0.0)))
    frames = len(recording.time)
    world: dict[int, FloatArray] = {-1: np.tile(np.eye(4), (frames, 1, 1))}
    tracks: list[Track] = []
    carried = {motion_node}
    for node in parent_first_order(rest.parents):
        parent = int(rest.parents[node])
        if parent in carried:
            carried.add(node)
        always = {path for path in PATHS if node in carried and (node, path) in keyed}
        if node != motion_node and node not in row_of_node:
            tracks += [_resting_track(node, path, rest, frames) for path in sorted(always)]
            if node in needed:
                world[node] = world[parent] @ rest.local[node]
            continue
        if node == motion_node:
            posed = motion_matrices(recording) @ rest.local[node]
        else:
            posed = joint_matrices(recording, row_of_node[node])
        found, moved = _node_tracks(
            node, world[parent], posed, rest, size * STILL_TRANSLATION, always
        )
        tracks += found
        world[node] = world[parent] @ moved
    return tracks


def _node_tracks(
    node: int,
    above: FloatArray,
    posed: FloatArray,
    rest: RestParts,
    still: float,
    always: set[str],
) -> tuple[list[Track], FloatArray]:
    """Return a node's tracks and its local matrices [F, 4, 4] as the file will have them.

    `above` and `posed` [F, 4, 4] are world matrices of the parent and of the node itself, `still`
    the length in metres below which a shift is none, `always` the paths that get a track anyhow.
    """
    units = np.cbrt(np.abs(np.linalg.det(above[0, :3, :3])))
    if not units > 0.0:
        raise RigError(
            f"node {node} ({rest.names[node] or 'unnamed'}) cannot be placed, because a node above "
            "it has scale zero"
        )
    local = np.linalg.inv(above) @ posed
    translation, rotation, scale = decompose(local, rest.scale[node])
    rotation = one_sign(rotation, rest.rotation[node])
    parts = {
        "translation": (translation, rest.translation[node], still / units),
        "rotation": (rotation, rest.rotation[node], STILL_ROTATION),
        "scale": (scale, rest.scale[node], STILL_SCALE * float(np.abs(scale).max())),
    }
    tracks, used = [], []
    for path, (values, at_rest, tolerance) in parts.items():
        if float(np.abs(values - at_rest).max()) <= tolerance:
            if path in always:
                tracks.append(_resting_track(node, path, rest, len(values)))
            used.append(np.broadcast_to(at_rest, values.shape))
            continue
        rounded = _rounded(values, tolerance)
        tracks.append(Track(node, path, rounded))
        used.append(rounded.astype(np.float64))
    return tracks, compose(*used)


def _resting_track(node: int, path: str, rest: RestParts, frames: int) -> Track:
    """Return a track that holds a node's property as it is when nothing plays."""
    value = np.asarray(getattr(rest, path)[node], np.float32)
    return Track(node, path, np.broadcast_to(value, (frames, len(value))))


def _rounded(values: FloatArray, tolerance: float) -> NDArray[np.float32]:
    """Return values in single precision; those that hardly change become constant."""
    middle = 0.5 * (values.min(axis=0) + values.max(axis=0))
    if float(np.abs(values - middle).max()) <= tolerance:
        return np.broadcast_to(middle.astype(np.float32), values.shape)
    return values.astype(np.float32)


def one_sign(rotation: FloatArray, first: FloatArray) -> FloatArray:
    """Return quaternions [F, 4] with signs such that each is on the side of the one before it.

    Interpolating clients would otherwise take the long way round between two frames.
    """
    against = np.concatenate([first[None], rotation[:-1]])
    agree = np.einsum("fi,fi->f", against, rotation) >= 0.0
    return rotation * np.cumprod(np.where(agree, 1.0, -1.0))[:, None]


def _with_ancestors(nodes: list[int], parents: IntArray) -> set[int]:
    found: set[int] = set()
    for start in nodes:
        node = start
        while node >= 0 and node not in found:
            found.add(node)
            node = int(parents[node])
    return found
