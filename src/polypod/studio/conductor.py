"""Walks the stage on, takes what is asked of it, and tells all tabs what comes of it."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from polypod.errors import SettingError
from polypod.studio.asked import facts_of
from polypod.studio.document import Document
from polypod.studio.frames import Focus, MotionMeter, pack_frame
from polypod.studio.history import History
from polypod.studio.judge import Judge
from polypod.studio.meshes import ground_reach, pack_ground, pack_skin
from polypod.studio.messages import (
    clock_message,
    document_message,
    kinds_message,
    tape_message,
    verdict_message,
    welcome_message,
)
from polypod.studio.outbox import Telling
from polypod.studio.overlays import Overlays
from polypod.studio.stage import Stage
from polypod.studio.tape import NOTHING, Tape

OVERLAY_EVERY = 0.2  # s
# The ground is sent anew when the first creature has gone so much of what was sent.
GONE = 0.4


class Conductor:
    """What the runner's thread does; `tell` sends something to all tabs."""

    def __init__(self, stage: Stage, tell: Callable[[Telling], None]) -> None:
        self.stage = stage
        self.history = History()
        self.playing = True
        self.rate = 1.0
        self.behind = 1.0
        self.number = 0
        self.focus = Focus(0, 0)
        self.tape: Tape | None = None
        self.scrubbed: int | None = None
        self.skins: dict[int, bytes] = {}
        self.grounds: dict[int, bytes] = {}
        self.skin_numbers: dict[int, int] = {}
        self._counter = 0
        self._meter = MotionMeter()
        self._overlays = Overlays()
        self._wished: frozenset[str] = frozenset()
        self._overlays_told = 0.0
        self._tell = tell
        self.newest = b""  # the frame sent last
        self._judge = Judge()
        self._verdict = stage.question().answer()
        self._judge.ask(stage.question())
        self._renew_skins()
        self._renew_ground()

    # What goes out.

    def greeting(self) -> list[dict[str, Any]]:
        """Return the messages that a new tab needs, in their order."""
        return [
            welcome_message(self),
            facts_of(self.stage.herd),
            kinds_message(self),
            document_message(self),
            clock_message(self),
            verdict_message(self._verdict),
            tape_message(self),
        ]

    def say(self, message: dict[str, Any]) -> None:
        """Send a message to all tabs."""
        self._tell(Telling("text", message))

    def tell_clock(self) -> None:
        """Say how time goes."""
        self.say(clock_message(self))

    # Time.

    def step(self, dt: float) -> None:
        """Walk on by a step, and send a frame; who scrubs sees the tape."""
        self._tell_verdict()
        if self.scrubbed is not None:
            return
        self.stage.step(dt)
        self._renew_ground_if_gone()
        self._send_frame(dt)
        self._send_overlays()

    def rest(self) -> None:
        """Do what is to be done while time stands still."""
        self._tell_verdict()
        self._send_overlays()

    def _tell_verdict(self) -> None:
        verdict = self._judge.take()
        if verdict is not None:
            self._verdict = verdict
            self.say(verdict_message(verdict))

    def _send_frame(self, dt: float | None = None) -> None:
        stage = self.stage
        herd = stage.herds[self.focus.kind]
        if dt is None:
            self._meter.forget()
        motion = self._meter.note(herd, self.focus.creature, dt or 1.0)
        self.number += 1
        frame = pack_frame(
            self.number, stage.world.time, stage.herds, stage.obstacle_poses(), self.focus, motion
        )
        self.newest = frame
        tape = self.tape
        if tape is not None and tape.recording and dt is not None:
            if tape.full or not tape.fits(stage.world):
                self._stop_tape()
                why = "the tape is full" if tape.full else "there are other obstacles now"
                self.say({"is": "trouble", "why": f"recording has ended: {why}"})
            else:
                tape.add(frame)
                if len(tape.frames) % 15 == 1:
                    self.say(tape_message(self))
        self._tell(Telling("frame", frame))

    def watch_overlays(self, overlays: frozenset[str]) -> None:
        """Send these overlays from now on."""
        self._wished = overlays
        self._overlays_told = 0.0

    def _send_overlays(self) -> None:
        now = time.perf_counter()
        if not self._wished or now - self._overlays_told < OVERLAY_EVERY:
            return
        self._overlays_told = now
        for name, content in self._overlays.of(self.stage, self.focus, self._wished):
            self._tell(Telling("arrays", content, name))

    # What stands and who walks.

    def _renew_skins(self) -> None:
        for herd in self.stage.herds:
            key = id(herd.morphology)
            if key not in self.skin_numbers:
                self._counter += 1
                self.skin_numbers[key] = self._counter
                self.skins[self._counter] = pack_skin(herd.morphology)
        walking = {id(herd.morphology) for herd in self.stage.herds}
        for key, number in list(self.skin_numbers.items()):
            if key not in walking:
                del self.skin_numbers[key]
                self.skins.pop(number, None)

    def _renew_ground(self) -> None:
        stage = self.stage
        self._counter += 1
        centre = stage.herd.state.position[0].copy()
        reach = ground_reach(stage.herd.tables.leg_length)
        self._ground_at = (centre, reach)
        shown = len(stage.document["obstacle"])
        packed = pack_ground(stage.world.environment, shown, centre, reach)
        self.grounds = {self._counter: packed}

    def _renew_ground_if_gone(self) -> None:
        centre, reach = self._ground_at
        here = self.stage.herd.state.position[0]
        if max(abs(here[0] - centre[0]), abs(here[2] - centre[2])) > GONE * reach:
            self._renew_ground()
            self.say(kinds_message(self))

    def take(self, document: Document, gesture: str | None = None, keep: bool = True) -> None:
        """Take another document, judged; `keep` the one before for undo.

        Raises:
            PolypodError: it asks for what cannot be; nothing has changed.
        """
        before = self.stage.document
        if document == before:
            return
        applied = self.stage.apply(document)
        if keep:
            self.history.note(before, gesture)
        if applied.creature or applied.ground:
            self._begin_anew(applied.creature)
        self.say(document_message(self))
        if any(document[k] != before[k] for k in ("creature", "gait", "command")):
            self._judge.ask(self.stage.question())
        if not self.playing or applied.creature:
            self._send_frame()

    def _begin_anew(self, creature: bool) -> None:
        self.focus = Focus(0, 0)
        self._meter.forget()
        if self.tape is not None and self.tape.recording:
            self._stop_tape()
        self._renew_skins()
        self._renew_ground()
        if creature:
            self.say(facts_of(self.stage.herd))
        self.say(kinds_message(self))

    def restart(self) -> None:
        """Stand all creatures where they began."""
        self.stage.restart()
        self._begin_anew(False)
        self._send_frame()

    def look_at(self, creature: int) -> None:
        """Have frames carry the details of a creature, counted through all kinds.

        Raises:
            SettingError: there is no such creature.
        """
        self.focus = Focus(*self.stage.find(creature))
        self._meter.forget()

    # What is recorded.

    def record(self, on: bool) -> None:
        """Begin a record, which takes the place of the one before, or end it."""
        if on:
            self.scrub(None)
            self.tape = Tape(self.stage.world, self.stage.herds)
            self._send_frame()
            self.tape.add(self.newest)
            self.say(tape_message(self))
        else:
            self._stop_tape()

    def _stop_tape(self) -> None:
        if self.tape is not None:
            self.tape.recording = False
        self.say(tape_message(self))

    def scrub(self, index: int | None) -> None:
        """Show a frame of the tape; None: the walk, which goes on.

        Raises:
            SettingError: nothing was recorded, or no such frame.
        """
        if index is None:
            if self.scrubbed is not None:
                self.scrubbed = None
                self._send_frame()
                self.say(tape_message(self))
            return
        if self.tape is None:
            raise SettingError(NOTHING)
        self.number += 1
        content = self.tape.shown(index, self.number)
        self._stop_tape()
        self.scrubbed = index
        self.newest = content
        self._tell(Telling("frame", content))
        self.say(tape_message(self))
