"""Gaits are judged beside the walk: the newest at once, and what would mend it when hands rest."""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np
import pytest

from polypod import Gait, load_rig, make_gait
from polypod.errors import GaitError
from polypod.gait.build import Build
from polypod.gait.validation import check_gait
from polypod.studio import judge as judging
from polypod.studio.judge import GivenUpError, Judge, Question, Verdict

PATIENCE = 60.0  # s, on a busy machine


class Held:
    """A question whose search is held until it is let go, or given up."""

    def __init__(self, name: str, told: list[str], error: Exception | None = None) -> None:
        self.name, self.told, self.error = name, told, error
        self.searches, self.go = threading.Event(), threading.Event()

    def answer(self) -> Any:
        self.told.append(self.name)
        if self.error is not None:
            raise self.error
        return Verdict(self.name, True)  # type: ignore[arg-type]

    def mend(self, verdict: Any, judge: Judge) -> Any:
        self.searches.set()
        end = time.monotonic() + PATIENCE
        while not self.go.is_set():
            assert time.monotonic() < end
            judge.go_on()
            time.sleep(0.001)
        self.told.append(f"{self.name} mended")
        return verdict._replace(searching=False)


def taken(judge: Judge) -> Verdict:
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        verdict = judge.take()
        if verdict is not None:
            return verdict
        time.sleep(0.002)
    raise AssertionError("no verdict came")


def ask(judge: Judge, question: Any) -> None:
    judge.ask(question)


def test_a_plausible_gait_has_one_answer_as_the_library_answers_it() -> None:
    spider = load_rig("spider")
    tripod = make_gait("tripod", spider.legs.side, spider.legs.row)
    judge = Judge()
    judge.ask(Question(tripod, Build.of(spider), 0.5))
    verdict = taken(judge)
    assert not verdict.searching
    assert verdict.check.sentence == check_gait(tripod, spider, speed=0.5).sentence
    assert judge.take() is None, "a verdict is taken once"


def test_what_would_mend_a_gait_comes_after_the_verdict() -> None:
    wolf = load_rig("wolf")
    gait = Gait("all at once", np.full(4, 0.1), np.full(4, 0.9))
    judge = Judge()
    judge.ask(Question(gait, Build.of(wolf), 1.0))
    first, second = taken(judge), taken(judge)
    whole = check_gait(gait, wolf, speed=1.0)
    assert whole.change is not None
    assert (first.searching, second.searching) == (True, False)
    assert first.check.verdict == second.check.verdict == "implausible"
    assert whole.sentence.startswith(first.check.sentence)
    assert second.check.sentence == whole.sentence


def test_a_search_is_given_up_for_a_newer_question() -> None:
    told: list[str] = []
    first, second, third = (Held(name, told) for name in ("first", "second", "third"))
    judge = Judge()
    ask(judge, first)
    assert taken(judge) == Verdict("first", True)  # type: ignore[arg-type]
    assert first.searches.wait(PATIENCE), "it looks for what would mend the first"
    ask(judge, second)
    assert taken(judge) == Verdict("second", True)  # type: ignore[arg-type]
    # Asked again before the search began, which waits for hands to rest.
    ask(judge, third)
    assert taken(judge) == Verdict("third", True)  # type: ignore[arg-type]
    third.go.set()
    assert taken(judge) == Verdict("third", False)  # type: ignore[arg-type]
    assert told == ["first", "second", "third", "third mended"]


def test_a_long_search_of_the_library_is_given_up() -> None:
    """Forty legs in step: some hundred changes are tried before one is found."""
    centipede = load_rig("centipede")
    feet = len(centipede.foot_name)
    question = Question(
        Gait("all at once", np.full(feet, 0.1), np.full(feet, 0.9)), Build.of(centipede), 0.05
    )
    verdict = question.answer()
    tried = 0

    class Impatient(Judge):
        def go_on(self) -> None:
            nonlocal tried
            tried += 1
            if tried == 3:
                raise GivenUpError

    with pytest.raises(GivenUpError):
        question.mend(verdict, Impatient())
    assert tried == 3


def test_while_a_hand_drags_nothing_is_searched_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(judging, "REST", PATIENCE)
    told: list[str] = []
    questions = [Held(str(number), told) for number in range(5)]
    judge = Judge()
    for question in questions:
        ask(judge, question)
        assert taken(judge).searching
    assert not any(question.searches.is_set() for question in questions)
    last = Held("last", told, GaitError("no gait"))
    ask(judge, last)  # ends the thread's wait


@pytest.mark.parametrize("error", [GaitError("no gait"), RuntimeError("a fault")])
def test_after_what_cannot_be_judged_it_goes_on(error: Exception) -> None:
    told: list[str] = []
    judge = Judge()
    ask(judge, Held("bad", told, error))
    end = time.monotonic() + PATIENCE
    while not told and time.monotonic() < end:
        time.sleep(0.002)
    ask(judge, Held("good", told))
    assert taken(judge) == Verdict("good", True)  # type: ignore[arg-type]
