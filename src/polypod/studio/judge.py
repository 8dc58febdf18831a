"""Judges gaits beside the walk, so that nobody stumbles over it.

What to think of a gait is known at once; what would mend one that is not plausible takes seconds to
find. So a question has two answers: the verdict, and later the verdict with what would mend it. The
newest question counts: whatever is worked out for one before it is given up.
"""

from __future__ import annotations

import threading
import traceback
from typing import NamedTuple

from polypod.errors import PolypodError
from polypod.gait.build import Build
from polypod.gait.pattern import Gait
from polypod.gait.validation import PLAUSIBLE, GaitCheck, judge_gait, mended

# What would mend a gait is looked for once nothing else was asked for so long, s: while a hand
# drags, each moment has a gait of its own, and the search would only be in the way.
REST = 0.3


class Verdict(NamedTuple):
    """What to think of a gait."""

    check: GaitCheck
    searching: bool  # what would mend it is still being looked for


class Question(NamedTuple):
    """A gait to judge, for whom, and at which speed, m/s."""

    gait: Gait
    build: Build
    speed: float

    def answer(self) -> Verdict:
        """Return what to think of the gait, without what would mend it.

        Raises:
            PolypodError: it cannot be judged.
        """
        check = judge_gait(self.gait, self.build, speed=self.speed)
        return Verdict(check, check.verdict != PLAUSIBLE)

    def mend(self, verdict: Verdict, judge: Judge) -> Verdict:
        """Return a verdict with what would mend the gait.

        Raises:
            GivenUpError: something else was asked meanwhile.
        """
        return Verdict(mended(verdict.check, self.gait, self.build, judge.go_on), False)


class GivenUpError(Exception):
    """Nobody waits for what is being looked for: something else was asked."""


class Judge:
    """Takes questions and gives verdicts; called from one thread, works in another."""

    def __init__(self) -> None:
        self._asked = threading.Condition()
        self._waiting: Question | None = None
        self._verdict: Verdict | None = None
        self._busy = False

    def ask(self, question: Question) -> None:
        """Have a gait judged, instead of any that was asked about before."""
        with self._asked:
            self._waiting = question
            self._asked.notify()
            if self._busy:
                return
            self._busy = True
        threading.Thread(target=self._work, name="polypod-judge", daemon=True).start()

    def take(self) -> Verdict | None:
        """Return a verdict that was not taken yet, if there is one."""
        with self._asked:
            verdict, self._verdict = self._verdict, None
        return verdict

    def go_on(self) -> None:
        """Raise GivenUpError if something else was asked."""
        if self._waiting is not None:
            raise GivenUpError

    def _work(self) -> None:
        while True:
            with self._asked:
                question, self._waiting = self._waiting, None
                if question is None:
                    self._busy = False
                    return
            try:
                self._answer(question)
            except GivenUpError:
                pass
            except PolypodError:
                pass  # what cannot be judged has no verdict; the walk says what is wrong
            except Exception:
                traceback.print_exc()

    def _answer(self, question: Question) -> None:
        verdict = question.answer()
        self._put(verdict)
        if not verdict.searching:
            return
        with self._asked:
            self._asked.wait_for(lambda: self._waiting is not None, REST)
        self.go_on()
        verdict = question.mend(verdict, self)
        self.go_on()
        self._put(verdict)

    def _put(self, verdict: Verdict) -> None:
        with self._asked:
            self._verdict = verdict
