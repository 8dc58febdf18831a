"""The simulation's thread: orders in, frames and messages out, sixty steps a second."""

from __future__ import annotations

import threading
import time
import traceback
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, TypeVar

from polypod.errors import PolypodError
from polypod.studio.conductor import Conductor
from polypod.studio.document import Document
from polypod.studio.obeying import obey
from polypod.studio.outbox import Telling
from polypod.studio.stage import STEP, FindRig, Stage
from polypod.studio.world_files import WorldFiles

Result = TypeVar("Result")

# What it is behind by more than this is not made up for, s; and how often it says how it keeps up.
MOST_BEHIND = 0.1
TELL_EVERY = 0.25
# While it makes up for lost time, so many times faster and no more: no burst is seen.
CATCH_UP = 1.5
IDLE = 0.25  # s for which it sleeps while nothing happens


def fault(error: Exception) -> str:
    """Return what to say of a fault that is ours, with where it happened on stderr."""
    traceback.print_exception(error)
    return f"this is a fault of Polypod's own, please report it: {type(error).__name__}: {error}"


class Runner:
    """Walks a document's world in a thread of its own; other threads talk to it by its queue."""

    def __init__(
        self, document: Document, find_rig: FindRig, files: WorldFiles | None = None
    ) -> None:
        self._opening = (document, find_rig, files)
        self._work: deque[Callable[[], None]] = deque()
        self._woken = threading.Condition()
        self._listeners: list[Callable[[Telling], None]] = []
        self._thread: threading.Thread | None = None
        self._stopped = False
        self.conductor: Conductor | None = None
        self.failed: PolypodError | None = None
        self.ready = threading.Event()

    def start(self) -> None:
        """Begin; the world is made in the thread, which may have to compile first."""
        self._thread = threading.Thread(target=self._run, name="polypod-studio", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """End the thread after the frame that it is at."""
        with self._woken:
            self._stopped = True
            self._woken.notify()
        if self._thread is not None:
            self._thread.join(10.0)

    def listen(self, hear: Callable[[Telling], None]) -> Callable[[], None]:
        """Have `hear` called, in the runner's thread, for all that tabs are to be sent."""
        self._listeners.append(hear)
        return lambda: self._listeners.remove(hear) if hear in self._listeners else None

    def tell(self, event: Telling) -> None:
        """Tell all who listen."""
        for hear in list(self._listeners):
            hear(event)

    def order(self, order: dict[str, Any], answer: Callable[[str | None], None]) -> None:
        """Put an order into the queue; `answer` is called with None, or with why it is refused."""

        def carry_out() -> None:
            try:
                obey(self._conductor, order)
            except PolypodError as error:
                answer(str(error))
            except Exception as error:
                answer(fault(error))
            else:
                answer(None)

        self._push(carry_out)

    def call(self, work: Callable[[Conductor], Result]) -> Future[Result]:
        """Have something done between two frames; errors come by the future."""
        future: Future[Result] = Future()

        def carry_out() -> None:
            if not future.set_running_or_notify_cancel():
                return
            try:
                future.set_result(work(self._conductor))
            except Exception as error:
                future.set_exception(error)

        self._push(carry_out)
        return future

    def watched(self, overlays: frozenset[str]) -> None:
        """Say which overlays any tab wishes to see."""
        self._push(lambda: self._conductor.watch_overlays(overlays))

    def greeting(self) -> list[dict[str, Any]]:
        """Return the messages that a new tab needs, in their order."""
        return [] if self.conductor is None else self.conductor.greeting()

    def newest(self) -> bytes | None:
        """Return the frame that was sent last: a tab that comes while time stands sees it."""
        return None if self.conductor is None else self.conductor.newest or None

    def skin(self, number: int) -> bytes | None:
        """Return a skin by its number, as named arrays."""
        return None if self.conductor is None else self.conductor.drawn.skins.get(number)

    def ground(self, number: int) -> bytes | None:
        """Return the ground by its number, as named arrays."""
        return None if self.conductor is None else self.conductor.drawn.grounds.get(number)

    @property
    def _conductor(self) -> Conductor:
        assert self.conductor is not None, "the runner has not begun"
        return self.conductor

    def _push(self, work: Callable[[], None]) -> None:
        with self._woken:
            self._work.append(work)
            self._woken.notify()

    def _run(self) -> None:
        document, find_rig, files = self._opening
        try:
            stage = Stage(document, find_rig, files)
        except PolypodError as error:
            self.failed = error
            self.ready.set()
            return
        self.conductor = Conductor(stage, self.tell)
        self.conductor.step(STEP)
        self.ready.set()
        for message in self.conductor.greeting():
            self.tell(Telling("text", message))
        self._walk()

    def _walk(self) -> None:
        """Carry out orders and walk, in step with the clock on the wall."""
        conductor = self._conductor
        due = soonest = time.perf_counter()
        told = walked = 0.0
        began = due
        while not self._stopped:
            self._carry_out_work()
            now = time.perf_counter()
            step = STEP / conductor.rate
            # Nobody looks: it costs nothing then, and goes on when somebody comes back.
            if not conductor.playing or not self._listeners:
                due, began, walked = now, now, 0.0
                conductor.rest()
                self._sleep(IDLE)
                continue
            if now - due > MOST_BEHIND:
                due = now - MOST_BEHIND
            if now >= max(due, soonest):
                self._step()
                walked += step
                due += step
                soonest = now + step / CATCH_UP
            if now - told > TELL_EVERY:
                conductor.behind = min(walked / max(now - began, step), 1.0)
                began, walked, told = now, 0.0, now
                conductor.tell_clock()
            self._sleep(max(due, soonest) - time.perf_counter())

    def _step(self) -> None:
        """Walk on; a fault of ours stops time and is told, and the page goes on."""
        try:
            self._conductor.step(STEP)
        except Exception as error:
            self._conductor.playing = False
            self.tell(Telling("text", {"is": "trouble", "why": fault(error)}))
            self._conductor.tell_clock()

    def _carry_out_work(self) -> None:
        while True:
            with self._woken:
                if not self._work:
                    return
                work = self._work.popleft()
            work()

    def _sleep(self, seconds: float) -> None:
        if seconds <= 0.0:
            return
        with self._woken:
            if not self._work and not self._stopped:
                self._woken.wait(seconds)
