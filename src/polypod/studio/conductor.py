"""Walks the stage on, takes what is asked of it, and tells all tabs what comes of it."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from polypod.errors import SettingError
from polypod.studio.asked import facts_of, limits_of
from polypod.studio.document import Document
from polypod.studio.drawn import Drawn
from polypod.studio.frames import Focus, MotionMeter, pack_frame
from polypod.studio.history import History
from polypod.studio.judge import Judge
from polypod.studio.messages import (
    backdrop_message,
    clock_message,
    document_message,
    files_message,
    kinds_message,
    tape_message,
    verdict_message,
    welcome_message,
)
from polypod.studio.outbox import Telling
from polypod.studio.overlays import Overlays
from polypod.studio.stage import RATE, Stage
from polypod.studio.tape import NOTHING, Backdrop, Tape

OVERLAY_EVERY = 0.2  # s
# Bytes of frames a second that a page is sent: what it takes to carry and read more slows the walk
# down where few cores share the work. Some 120 creatures have all their frames, 200 every second.
MOST_SENT = 8_000_000


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
        self.backdrop: Backdrop | None = None  # of the frame that is scrubbed
        self._meter = MotionMeter()
        self._overlays = Overlays()
        self._wished: frozenset[str] = frozenset()
        self._overlays_told = 0.0
        self._overlays_of = -1  # number of the frame with which they were sent last
        self._tell = tell
        self._files_told = files_message(self)
        self.newest = b""  # the frame sent last
        self._unsent = False  # the newest frame was made, but not sent: there were too many
        self.urgent = False  # something was asked for: the next frame is sent whatever it has
        self._judge = Judge()
        self._verdict = stage.question().answer()
        self._judge.ask(stage.question())
        self.drawn = Drawn(stage)

    # What goes out.

    def greeting(self) -> list[dict[str, Any]]:
        """Return the messages that a new tab needs, in their order."""
        return [
            welcome_message(self),
            facts_of(self.stage.herd, self.stage.rig),
            kinds_message(self),
            files_message(self),
            document_message(self),
            clock_message(self),
            verdict_message(self._verdict),
            tape_message(self),
            backdrop_message(self),
        ]

    def say(self, message: dict[str, Any]) -> None:
        """Send a message to all tabs."""
        self._tell(Telling("text", message))

    def tell_files(self) -> None:
        """Say which files there are, if these are others than were said last."""
        message = files_message(self)
        if message != self._files_told:
            self._files_told = message
            self.say(message)

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
        if self.drawn.gone:
            self._renew_ground()
            self.say(kinds_message(self))
        self._send_frame(dt)
        self._send_overlays()

    def rest(self) -> None:
        """Do what is to be done while time stands still."""
        self._tell_verdict()
        if self._unsent and self.scrubbed is None:
            self._tell_newest()
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
            if tape.full:
                self._stop_tape("the tape is full")
            else:
                tape.add(frame)
                if len(tape.frames) % 15 == 1:
                    self.say(tape_message(self))
        every = 1 + len(frame) * RATE // MOST_SENT
        self._unsent = True
        if dt is None or self.urgent or self.number % every == 0:
            self._tell_newest()

    def _tell_newest(self) -> None:
        self.urgent = self._unsent = False
        self._tell(Telling("frame", self.newest))

    def watch_overlays(self, overlays: frozenset[str]) -> None:
        """Send these overlays from now on."""
        self._wished = overlays
        self._overlays_told = 0.0
        self._overlays_of = -1

    def _send_overlays(self) -> None:
        now = time.perf_counter()
        if not self._wished or now - self._overlays_told < OVERLAY_EVERY:
            return
        # Where nothing has moved nothing is seen anew.
        if self.number == self._overlays_of:
            return
        self._overlays_told, self._overlays_of = now, self.number
        for name, content in self._overlays.of(self.stage, self.focus, self._wished):
            self._tell(Telling("arrays", content, name))

    # What stands and who walks.

    def _renew_ground(self) -> None:
        self.drawn.renew_ground({} if self.tape is None else self.tape.grounds)
        self._note_backdrop()

    def _note_backdrop(self) -> None:
        if self.tape is not None and self.tape.recording:
            number = self.drawn.ground
            obstacle = self.stage.document["obstacle"]
            self.tape.stand(obstacle, number, self.drawn.grounds[number])

    def take(self, document: Document, gesture: str | None = None, keep: bool = True) -> None:
        """Take another document, judged; `keep` the one before for undo.

        Raises:
            PolypodError: it asks for what cannot be; nothing has changed.
        """
        before = self.stage.document
        if document == before:
            return
        built = any(document[key] != before[key] for key in ("terrain", "obstacle"))
        applied = self.stage.apply(document)
        if keep:
            self.history.note(before, gesture)
        if built and self.scrubbed is not None:
            # Who builds wishes to see what comes of it.
            self.scrub(None)
        if self.tape is not None and self.tape.recording and not applied.creature:
            if applied.renumbered is not None:
                self.tape.change(self.stage.world, self.stage.herds, applied.renumbered)
            self._note_backdrop()
        if applied.creature or applied.ground:
            self._begin_anew(applied.creature)
        if applied.limits:
            self._stop_tape("joints have other limits now")
            self.say(limits_of(self.stage.herd, self.stage.rig))
        # Before the document that may name them.
        self.tell_files()
        self.say(document_message(self))
        if any(document[k] != before[k] for k in ("creature", "gait", "command")):
            self._judge.ask(self.stage.question())
        if not self.playing or applied.creature:
            self._send_frame()

    def _begin_anew(self, creature: bool) -> None:
        self.focus = Focus(0, 0)
        self._meter.forget()
        if creature:
            self._stop_tape("others walk now")
        self.drawn.renew_skins()
        self._renew_ground()
        if creature:
            self.say(facts_of(self.stage.herd, self.stage.rig))
        self.say(kinds_message(self))

    def restart(self) -> None:
        """Stand all creatures where they began."""
        self.stage.restart()
        self._stop_tape("the walk has begun anew")
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
            self._note_backdrop()
            self._send_frame()
            self.tape.add(self.newest)
            self.say(tape_message(self))
        else:
            self._stop_tape()

    def _stop_tape(self, why: str = "") -> None:
        """End a recording that is under way, and say why where nobody asked for it."""
        if self.tape is None or not self.tape.recording:
            return
        self.tape.recording = False
        if why:
            why = f"recording has ended: {why}; what was recorded is kept"
            self.say({"is": "trouble", "why": why})
        self.say(tape_message(self))

    def scrub(self, index: int | None) -> None:
        """Show a frame of the tape; None: the walk, which goes on.

        Raises:
            SettingError: nothing was recorded, or no such frame.
        """
        if index is None:
            if self.scrubbed is not None:
                self.scrubbed = None
                self._show_backdrop(None)
                self._send_frame()
                self.say(tape_message(self))
            return
        if self.tape is None:
            raise SettingError(NOTHING)
        self.number += 1
        content = self.tape.shown(index, self.number)
        self._stop_tape()
        self.scrubbed = index
        self._show_backdrop(self.tape.backdrop(index))
        self.newest = content
        self._tell(Telling("frame", content))
        self.say(tape_message(self))

    def _show_backdrop(self, backdrop: Backdrop | None) -> None:
        if backdrop is not self.backdrop:
            self.backdrop = backdrop
            self.say(backdrop_message(self))
