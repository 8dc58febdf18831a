"""What is recorded in the studio: frames to scrub, and the walks to export."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import replace

from polypod.errors import SettingError
from polypod.herd import Herd
from polypod.recording import add_frame
from polypod.report.record import Recorder, Recording
from polypod.world import World

# All frames together, bytes, as they are sent; and joints times frames of the walks.
MOST_BYTES = 400_000_000
MOST_JOINT_FRAMES = 4_000_000
NOTHING = "nothing is recorded; press record and let it walk for a while"
# Where a frame's bytes say which frame of the tape it is, and its number.
TAPE_AT, NUMBER_AT = 28, 4


class Tape:
    """A recording under way or finished; herds and obstacles stay as they were at its start."""

    def __init__(self, world: World, herds: Sequence[Herd]) -> None:
        self.world = world
        self.recording = True
        self.frames: list[bytes] = []
        self.start = world.time
        self.seconds = 0.0
        self._bytes = 0
        self._recorders = [
            (herd, c, Recorder(herd.morphology, len(world.environment.obstacles)))
            for herd in herds
            for c in range(herd.count)
        ]
        self._joints = sum(len(herd.morphology.joint_node) * herd.count for herd in herds)
        self._obstacles = len(world.environment.obstacles)

    @property
    def full(self) -> bool:
        """Whether there is no room for another frame."""
        return self._bytes > MOST_BYTES or self._joints * (len(self.frames) + 1) > MOST_JOINT_FRAMES

    def fits(self, world: World) -> bool:
        """Return whether a world is still the one that is recorded.

        It has as many obstacles, and its creatures the limits that they had.
        """
        same = all(herd.morphology is recorder.morphology for herd, _, recorder in self._recorders)
        alike = len(world.environment.obstacles) == self._obstacles
        return world is self.world and alike and same

    def add(self, frame: bytes) -> None:
        """Keep a frame: its bytes, and what every creature does now."""
        self.frames.append(frame)
        self._bytes += len(frame)
        self.seconds = self.world.time - self.start
        for herd, c, recorder in self._recorders:
            add_frame(recorder, self.world, herd, c)

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

    def walk(self, creature: int) -> Recording:
        """Return the recording of a creature, the first frame at time 0.

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
        return replace(walk, time=walk.time - walk.time[0])
