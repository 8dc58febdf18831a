"""Judges gaits beside the walk: a verdict takes up to seconds, and nobody shall stumble over it.

Each change of a gait that is drawn asks for a verdict. One is worked out at a time, and after it
the newest that waits: those between nobody would see.
"""

from __future__ import annotations

import threading
import traceback
from typing import NamedTuple

from polypod.errors import PolypodError
from polypod.gait.pattern import Gait
from polypod.gait.validation import GaitCheck, check_gait
from polypod.morphology.types import Morphology


class Question(NamedTuple):
    """A gait to judge, for whom, and at which speed, m/s."""

    gait: Gait
    morphology: Morphology
    speed: float

    def answer(self) -> GaitCheck:
        """Return what to think of the gait.

        Raises:
            PolypodError: it cannot be judged.
        """
        return check_gait(self.gait, self.morphology, speed=self.speed)


class Judge:
    """Takes questions and gives verdicts; called from one thread, works in another."""

    def __init__(self) -> None:
        self._guard = threading.Lock()
        self._waiting: Question | None = None
        self._verdict: GaitCheck | None = None
        self._busy = False

    def ask(self, question: Question) -> None:
        """Have a gait judged, before any that waits."""
        with self._guard:
            self._waiting = question
            if self._busy:
                return
            self._busy = True
        threading.Thread(target=self._work, name="polypod-judge", daemon=True).start()

    def take(self) -> GaitCheck | None:
        """Return a verdict that was not taken yet, if there is one."""
        with self._guard:
            verdict, self._verdict = self._verdict, None
        return verdict

    def _work(self) -> None:
        while True:
            with self._guard:
                question, self._waiting = self._waiting, None
                if question is None:
                    self._busy = False
                    return
            try:
                verdict = question.answer()
            except PolypodError:
                continue  # what cannot be judged has no verdict; the walk says what is wrong
            except Exception:
                traceback.print_exc()
                continue
            with self._guard:
                self._verdict = verdict
