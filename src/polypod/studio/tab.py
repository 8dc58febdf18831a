"""One open page, as the server sees it: what it may still be sent, and what it sent."""

from __future__ import annotations

import asyncio
import json
import struct
from collections import deque
from typing import Any

from polypod.studio.guard import Faults, Rate
from polypod.studio.outbox import Outbox, Telling

FRAMES_UNDER_WAY = 3
# Messages that may wait for a page that does not read, and its orders that wait for an answer.
MOST_WAITING = 2000
MOST_ORDERS = 500


NOT_CLOSING = 0


def as_json(message: dict[str, Any]) -> str:
    """Return a message as text."""
    return json.dumps(message, allow_nan=False, separators=(",", ":"))


class Tab:
    """A page that is connected."""

    def __init__(self) -> None:
        self.sees: frozenset[str] = frozenset()
        self.outbox = Outbox()
        self.rate, self.faults = Rate(), Faults()
        self.orders = 0  # that wait for their answer
        self.closing = (NOT_CLOSING, "")  # the websocket's code and reason
        self._under_way: deque[int] = deque()
        self._something = asyncio.Event()

    @property
    def is_closing(self) -> bool:
        """Whether the connection is to be closed."""
        return self.closing[0] != NOT_CLOSING

    def tell(self, message: dict[str, Any]) -> None:
        """Have a message sent."""
        self.put(Telling("text", message))

    def put(self, telling: Telling) -> None:
        """Have something sent, if this tab wishes to see it."""
        if telling.kind == "arrays" and telling.name not in self.sees:
            return
        self.outbox.put(telling)
        if self.outbox.messages > MOST_WAITING:
            self.close(1008, "the page does not read what it is sent")
        self._something.set()

    def close(self, code: int, reason: str) -> None:
        """Have the connection closed after what waits was sent."""
        if not self.is_closing:
            self.closing = (code, reason)
        self._something.set()

    def see(self, names: frozenset[str]) -> None:
        """Draw these overlays from now on."""
        self.outbox.drop(self.sees - names)
        self.sees = names

    def acknowledge(self, frame: int) -> None:
        """Take note that the page has a frame, and with it those sent before."""
        if frame in self._under_way:
            while self._under_way.popleft() != frame:
                pass
            self._something.set()

    async def next(self) -> str | bytes | None:
        """Wait for what is to be sent next; None when the connection is to be closed."""
        while True:
            telling = self.outbox.take(frames=len(self._under_way) < FRAMES_UNDER_WAY)
            if self.is_closing and (telling is None or telling.kind != "text"):
                return None
            if telling is not None:
                return self._written(telling)
            self._something.clear()
            await self._something.wait()

    def _written(self, telling: Telling) -> str | bytes:
        if telling.kind == "text":
            return as_json(telling.content)
        if telling.kind == "frame":
            self._under_way.append(struct.unpack_from("<I", telling.content, 4)[0])
        return bytes(telling.content)
