"""The world that a document asks for, changed as little as a new document needs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from polypod.errors import SettingError
from polypod.gait.build import Build
from polypod.gait.follow import PINNED, next_rung
from polypod.gait.library import make_gait
from polypod.herd import Herd
from polypod.ik.table import build_ik_table
from polypod.relimit import relimit
from polypod.studio.asked import ask, gait_of, settings_of
from polypod.studio.document import CREATURE, Document
from polypod.studio.joint_limits import (
    LimitedRig,
    cannot_be,
    changed_joints,
    hinges_said,
    why_not_standing,
    why_not_stepping,
)
from polypod.studio.judge import Question
from polypod.studio.places import change_of, make_place, obstacle_poses, on_other_ground
from polypod.studio.wandering import Wanderers, stand_beside
from polypod.studio.world_files import WorldFiles
from polypod.world import World

# Where a rig's name leads: a built-in's name as it is, an upload's to its file; else SettingError.
FindRig = Callable[[str], Any]

RATE = 60  # steps a second
STEP = 1.0 / RATE


class Applied(NamedTuple):
    """What a new document changed."""

    creature: bool  # who walks: the skins are others
    ground: bool
    limits: bool  # how far the joints of the one who walks turn
    renumbered: tuple[int, ...] | None  # for each obstacle before its number now, -1: gone


class Stage:
    """A document and the world that walks it; used by one thread at a time.

    Attributes:
        document: judged; what is asked for now.
        world: where it is walked.
        herds: the first creature's, then the crowd's kinds.
        rig: the first creature's, as it is without what is asked of its joints.
    """

    def __init__(
        self, document: Document, find_rig: FindRig, files: WorldFiles | None = None
    ) -> None:
        self.world: World
        self.find_rig = find_rig
        self.files = files or WorldFiles()
        self._rigs: dict[str, LimitedRig] = {}
        self._build(document)
        self.document = document

    @property
    def herd(self) -> Herd:
        """The first creature's."""
        return self.herds[0]

    def apply(self, document: Document) -> Applied:
        """Take another document.

        Raises:
            PolypodError: it asks for what cannot be; the stage is as it was.
        """
        before = self.document
        creature = _who_walks(document) != _who_walks(before)
        ground = document["terrain"] != before["terrain"]
        limits = not creature and document["creature"] != before["creature"]
        numbers: tuple[int, ...] | None = None
        if creature or ground:
            total = len(self.world.environment.obstacles)
            self._build(document, stays=not creature)
            if not creature:
                numbers = on_other_ground(before["obstacle"], document["obstacle"], total)
        else:
            if limits:
                self._limit(document)
            else:
                ask(self.herd, document, before)
            if document["obstacle"] != before["obstacle"]:
                numbers = self._change_obstacles(before, document)
        self.document = document
        return Applied(creature, ground, limits, numbers)

    def restart(self) -> None:
        """Stand all creatures where they began."""
        self._build(self.document)

    def step(self, dt: float) -> None:
        """Walk on by `dt` seconds."""
        self.wanderers.lead(self.world.time)
        self.world.step(dt)

    def find(self, creature: int) -> tuple[int, int]:
        """Return the kind of a creature, counted through all herds, and its row of that herd.

        Raises:
            SettingError: there is no such creature.
        """
        row = creature
        for kind, herd in enumerate(self.herds):
            if 0 <= row < herd.count:
                return kind, row
            row -= herd.count
        raise SettingError(f"there is no creature {creature}")

    def push(self, creature: int, velocity: Sequence[float], at: float) -> None:
        """Push a creature as `Herd.push` does; velocity in m/s, struck `at` m ahead of its centre.

        Raises:
            SettingError: no such creature, or no such push.
        """
        kind, row = self.find(creature)
        self.herds[kind].push(velocity, row, at=at)

    def obstacle_poses(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """Return [O, 7] quaternions and positions of the document's obstacles, world, m."""
        return obstacle_poses(self.world.environment, len(self.document["obstacle"]))

    def question(self) -> Question:
        """Return what is to be judged: the gait that is walked, at the speed asked for."""
        herd = self.herd
        gait = gait_of(self.document, herd.morphology)
        speed = float(herd.command.arrays.speed[0])
        if gait is None:
            legs = herd.tables.legs
            gait = make_gait(herd.gait_name[0] or self._gait_at(speed), legs.side, legs.row)
        return Question(gait, Build.of(herd.morphology, herd.tables), speed)

    def _gait_at(self, speed: float) -> str:
        """Return what a creature will walk in that let go of its gait since the last step."""
        tables = self.herd.tables
        length = tables.hip_height if tables.upright else tables.leg_length
        return self.herd.ladder[next_rung(PINNED, speed, length, tables.ladder.limit)]

    def _rig(self, asked: Mapping[str, Any]) -> LimitedRig:
        """Return a creature, read once for all that is said of it but its joints' limits."""
        key = repr(sorted((key, value) for key, value in asked.items() if key != "limit"))
        if key not in self._rigs:
            rig = LimitedRig(self.find_rig(asked["rig"]), asked)
            if len(self._rigs) >= 8:
                self._rigs.pop(next(iter(self._rigs)))
            self._rigs[key] = rig
        return self._rigs[key]

    def _limit(self, document: Document) -> None:
        """Let the first creature go on with other limits of its joints.

        Raises:
            PolypodError: it cannot stand with them, or they name no joint; nothing has changed.
        """
        herd = self.herd
        morphology, tables = herd.morphology, herd.tables
        angles = herd.state.spine_angle.copy()
        limited = self.rig.limited(document["creature"].get("limit"))
        changed = list(changed_joints(morphology.legs, limited.legs))
        joints = [*changed, *hinges_said(limited.legs)]
        try:
            relimit(herd, limited)
        except SettingError:
            ik = build_ik_table(limited.legs, (tables.legs, tables.ik))
            why = why_not_standing(limited, ik, joints)
            raise SettingError(why or cannot_be(limited, changed)) from None
        try:
            why = why_not_standing(limited, herd.tables.ik, joints)
            why = why or why_not_stepping(herd, tables)
            if why is not None:
                raise SettingError(why)
            # What has a default of the creature's own may have another one now.
            other = dict.fromkeys(document["command"], "another")
            ask(herd, document, {**self.document, "command": other})
        except SettingError:
            herd.take_limits(morphology, tables)
            herd.state.spine_angle[:] = angles
            raise

    def _build(self, document: Document, *, stays: bool = False) -> None:
        """Make the world anew; a creature that `stays` goes on from where it is."""
        rig = self._rig(document["creature"])
        morphology = rig.limited(document["creature"].get("limit"))
        gait_of(document, morphology)
        kinds = [
            (self._rig(as_creature(kind)).limited(kind.get("limit")), kind["count"])
            for kind in document["crowd"]
        ]
        place = make_place(document, self.files)
        world = World(place)
        at, heading = (0.0, 0.0), float(document["command"]["heading"])
        if stays:
            # Time goes on too: what moves is where it would be.
            world.time = self.world.time
            place.advance(world.time)
            state = self.herd.state
            at = (float(state.position[0, 0]), float(state.position[0, 2]))
            heading = float(state.heading[0])
        settings = settings_of(document)
        try:
            first = world.add(morphology, position=list(at), heading=heading, settings=settings)
        except SettingError:
            if at == (0.0, 0.0):
                raise
            # The ground there is another now.
            first = world.add(morphology, position=[0.0, 0.0], heading=heading, settings=settings)
        if document["creature"].get("limit"):
            why = why_not_standing(morphology, first.tables.ik, hinges_said(morphology.legs))
            if why is not None:
                raise SettingError(why)
        ask(first, document, None)
        crowd = stand_beside(world, first, kinds)
        self.world = world
        self.rig = rig
        self.herds = [first, *crowd]
        self.wanderers = Wanderers(crowd, first)

    def _change_obstacles(self, before: Document, document: Document) -> tuple[int, ...] | None:
        change = change_of(before, document, self.world.environment, self.files)
        if change.environment is None:
            return None
        self.world.change_place(change.environment, change.renumbered)
        return change.renumbered


def as_creature(kind: Mapping[str, Any]) -> dict[str, Any]:
    """Return a kind of the crowd as the document has its first creature."""
    return {key: kind.get(key) for key in CREATURE}


def _who_walks(document: Document) -> tuple[Any, ...]:
    """Return what of a document makes other creatures of those who walk."""
    return {**document["creature"], "limit": None}, document["crowd"]
