"""What is recorded in the studio: frames to scrub, and the walks to export.

The world may be built on meanwhile. Each obstacle that ever stands has a column of the record for
good, whatever its number in the world is at a time.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from polypod.errors import SettingError
from polypod.herd import Herd
from polypod.recording import add_state
from polypod.report.arrays import FloatArray
from polypod.report.record import Recorder, Recording
from polypod.world import World

# All frames together, bytes, as they are sent; and joints times frames of the walks.
MOST_BYTES = 400_000_000
MOST_JOINT_FRAMES = 4_000_000
NOTHING = "nothing is recorded; press record and let it walk for a while"
# Where a frame's bytes say which frame of the tape it is, and its number.
TAPE_AT, NUMBER_AT = 28, 4
# Keys of an obstacle that say where it is, not what: frames say that too.
WHERE = ("position", "yaw", "rotation", "velocity", "path", "speed", "turn_rate")
NO_PLACES, NO_TURNS = np.zeros((0, 3)), np.zeros((0, 4))


class Backdrop(NamedTuple):
    """What stood while some frames were recorded."""

    first: int  # frame
    obstacle: list[dict[str, Any]]  # as the document has it
    ground: int  # its number


class Stood(NamedTuple):
    """The obstacles of a frame."""

    column: NDArray[np.int64]  # [O]
    position: FloatArray  # [O, 3]
    rotation: FloatArray  # [O, 4]


class Kind(NamedTuple):
    """Creatures of a rig."""

    name: str
    creatures: int


class Walk(NamedTuple):
    """The recording of a creature, and which of its obstacles stood in each frame."""

    recording: Recording
    there: NDArray[np.bool_]  # [F, O]


class Tape:
    """A recording under way or finished; creatures stay as they were at its start."""

    def __init__(self, world: World, herds: Sequence[Herd]) -> None:
        self.world = world
        self.recording = True
        self.frames: list[bytes] = []
        self.grounds: dict[int, bytes] = {}
        self.start = world.time
        self.seconds = 0.0
        self.kinds = [Kind(herd.morphology.name, herd.count) for herd in herds]
        self._herds = list(herds)
        self._bytes = 0
        self._backdrops: list[Backdrop] = []
        self._stood: list[Stood] = []
        self._recorders = [
            (kind, c, Recorder(herd.morphology, 0))
            for kind, herd in enumerate(herds)
            for c in range(herd.count)
        ]
        self._joints = sum(len(herd.morphology.joint_node) * herd.count for herd in herds)
        self._columns = list(range(len(world.environment.obstacles)))
        self._column_count = len(self._columns)

    @property
    def full(self) -> bool:
        """Whether there is no room for another frame."""
        return self._bytes > MOST_BYTES or self._joints * (len(self.frames) + 1) > MOST_JOINT_FRAMES

    def change(self, world: World, herds: Sequence[Herd], renumbered: Sequence[int]) -> None:
        """Go on in another world, with the same creatures.

        Args:
            world: the world, at the time at which the one before was.
            herds: who walks there.
            renumbered: for each obstacle before, which one it is now, -1: gone.
        """
        columns = [-1] * len(world.environment.obstacles)
        for before, now in enumerate(renumbered):
            if now >= 0:
                columns[now] = self._columns[before]
        for i, column in enumerate(columns):
            if column < 0:
                columns[i] = self._column_count
                self._column_count += 1
        self.world, self._herds, self._columns = world, list(herds), columns

    def stand(self, obstacle: list[dict[str, Any]], number: int, ground: bytes) -> None:
        """Note what stands from the next frame on: a document's obstacles, and the ground."""
        first = len(self.frames)
        now = Backdrop(first, obstacle, number)
        if self._backdrops:
            last = self._backdrops[-1]
            if last.ground == number and _shapes(last.obstacle) == _shapes(obstacle):
                return
            if last.first == first:
                self._backdrops.pop()
        self._backdrops.append(now)
        if number not in self.grounds:
            self.grounds[number] = ground
            self._bytes += len(ground)

    def backdrop(self, index: int) -> Backdrop:
        """Return what stood in a frame that there is."""
        return [one for one in self._backdrops if one.first <= index][-1]

    def add(self, frame: bytes) -> None:
        """Keep a frame: its bytes, and what every creature does now."""
        environment = self.world.environment
        column = np.array(self._columns, np.int64)
        stood = Stood(column, environment.places(), environment.rotations)
        self.frames.append(frame)
        self._stood.append(stood)
        self._bytes += len(frame) + stood.position.nbytes + stood.rotation.nbytes
        self.seconds = self.world.time - self.start
        column_of = np.append(column, -1)  # the ground's is -1 too
        for kind, c, recorder in self._recorders:
            herd = self._herds[kind]
            support = column_of[herd.state.foot_support[c]]
            # Obstacles are kept once for all creatures.
            add_state(recorder, self.world.time, herd, c, support, NO_PLACES, NO_TURNS)

    def shown(self, index: int, number: int) -> bytes:
        """Return the bytes of a frame of the tape, sent as frame `number`.

        Raises:
            SettingError: there is no such frame.
        """
        if not 0 <= index < len(self.frames):
            raise SettingError(
                f"there is no frame {index} on the tape; it has {len(self.frames)} frames"
            )
        content = bytearray(self.frames[index])
        struct.pack_into("<I", content, TAPE_AT, index + 1)
        struct.pack_into("<I", content, NUMBER_AT, number)
        return bytes(content)

    def walk(self, creature: int) -> Walk:
        """Return the walk of a creature, the first frame at time 0.

        An obstacle that did not stand yet, or no more, is where it first or last stood.

        Raises:
            SettingError: nothing was recorded, or not that creature.
        """
        if len(self.frames) < 2:
            raise SettingError(NOTHING)
        if creature >= len(self._recorders):
            raise SettingError(
                f"there is no creature {creature}; {len(self._recorders)} were recorded"
            )
        walk = self._recorders[creature][2].finish()
        there, position, rotation = self._obstacles()
        ever = there.any(axis=0)
        # What was taken away before any frame saw it has no column.
        number = np.append(np.where(ever, np.cumsum(ever) - 1, -1), -1)
        recording = replace(
            walk,
            time=walk.time - walk.time[0],
            foot_support=number[walk.foot_support],
            obstacle_position=position[:, ever],
            obstacle_rotation=rotation[:, ever],
        )
        return Walk(recording, there[:, ever])

    def _obstacles(self) -> tuple[NDArray[np.bool_], FloatArray, FloatArray]:
        """Return whether each obstacle stood in each frame [F, O], its places and turns."""
        shape = (len(self.frames), self._column_count)
        there = np.zeros(shape, np.bool_)
        position, rotation = np.zeros((*shape, 3)), np.zeros((*shape, 4))
        for frame, stood in enumerate(self._stood):
            there[frame, stood.column] = True
            position[frame, stood.column] = stood.position
            rotation[frame, stood.column] = stood.rotation
        for column in np.flatnonzero(there.any(axis=0)):
            known = np.flatnonzero(there[:, column])
            at = np.clip(np.arange(shape[0]), known[0], known[-1])
            position[:, column], rotation[:, column] = position[at, column], rotation[at, column]
        return there, position, rotation


def _shapes(obstacles: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    return [{key: one[key] for key in one if key not in WHERE} for one in obstacles]
