"""Gaits are judged beside the walk, the newest of those that wait."""

from __future__ import annotations

import threading
import time
from typing import Any

import pytest

from polypod import load_rig, make_gait
from polypod.errors import GaitError
from polypod.gait.validation import GaitCheck
from polypod.studio.judge import Judge, Question


class Held:
    """A question whose answer is held back until it is let go."""

    def __init__(self, name: str, order: list[str], error: Exception | None = None) -> None:
        self.name, self.order, self.error = name, order, error
        self.go, self.begun = threading.Event(), threading.Event()

    def answer(self) -> Any:
        self.begun.set()
        assert self.go.wait(10.0)
        self.order.append(self.name)
        if self.error is not None:
            raise self.error
        return self.name


def taken(judge: Judge, seconds: float = 20.0) -> GaitCheck:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        verdict = judge.take()
        if verdict is not None:
            return verdict
        time.sleep(0.005)
    raise AssertionError(f"no verdict within {seconds} s")


def test_a_question_is_answered_as_the_library_answers_it() -> None:
    spider = load_rig("spider")
    question = Question(make_gait("tripod", spider.legs.side, spider.legs.row), spider, 0.5)
    judge = Judge()
    judge.ask(question)
    verdict = taken(judge)
    assert verdict.sentence == question.answer().sentence
    assert judge.take() is None, "a verdict is taken once"


def test_of_those_that_wait_only_the_newest_is_judged() -> None:
    order: list[str] = []
    first, second, third = (Held(name, order) for name in ("first", "second", "third"))
    judge = Judge()
    judge.ask(first)  # type: ignore[arg-type]
    assert first.begun.wait(10.0)
    for question in (second, third):
        began = time.monotonic()
        judge.ask(question)  # type: ignore[arg-type]
        assert time.monotonic() - began < 1.0, "who asks does not wait"
    assert judge.take() is None
    for question in (first, second, third):
        question.go.set()
    end = time.monotonic() + 10.0
    while len(order) < 2 and time.monotonic() < end:
        time.sleep(0.005)
    assert order == ["first", "third"]


@pytest.mark.parametrize("error", [GaitError("no gait"), RuntimeError("a fault")])
def test_after_what_cannot_be_judged_it_goes_on(error: Exception) -> None:
    order: list[str] = []
    bad, good = Held("bad", order, error), Held("good", order)
    bad.go.set()
    good.go.set()
    judge = Judge()
    judge.ask(bad)  # type: ignore[arg-type]
    end = time.monotonic() + 10.0
    while not order and time.monotonic() < end:
        time.sleep(0.005)
    judge.ask(good)  # type: ignore[arg-type]
    assert taken(judge) == "good"
