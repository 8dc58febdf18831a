"""What the server needs of the simulation, so that either can be tried without the other."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, Protocol, TypeVar

from polypod.studio.outbox import Telling

T = TypeVar("T")


class Running(Protocol):
    """The simulation's thread, as `polypod.studio.runner` has it."""

    def start(self) -> None:
        """Begin."""

    def stop(self) -> None:
        """End; returns when the thread has ended."""

    def order(self, order: dict[str, Any], answer: Callable[[str | None], None]) -> None:
        """Put an order in the queue; the answer is None when it is done, or why it is not."""

    def call(self, work: Callable[[Any], T]) -> Future[T]:
        """Have the conductor give something between two frames."""

    def listen(self, hear: Callable[[Telling], None]) -> Callable[[], None]:
        """Have what is for every tab told to `hear`, in the thread; returns how to stop it."""

    def greeting(self) -> list[dict[str, Any]]:
        """Return what a new tab has to know."""

    def newest(self) -> bytes | None:
        """Return the frame that was sent last, if any was."""

    def skin(self, number: int) -> bytes | None:
        """Return a kind's skin, None where there is none of that number."""

    def ground(self, number: int) -> bytes | None:
        """Return the ground, None where it is another by now."""

    def watched(self, overlays: frozenset[str]) -> None:
        """Say which overlays any tab wishes to see."""
