"""What waits to be told: messages in their order, of frames and overlays only the newest."""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any, NamedTuple


class Telling(NamedTuple):
    """Something for every tab: a message, a frame, or named arrays."""

    kind: str  # "text", "frame" or "arrays"
    content: Any  # a message's dict, or bytes ready to send
    name: str = ""  # of arrays: a newer one takes the place of one that waits


class Outbox:
    """Things that wait, oldest first. A newer frame or overlay takes an older one's place.

    So what waits for a slow reader never grows but by messages, and these are few and are counted.
    """

    def __init__(self) -> None:
        self._waiting: dict[Hashable, Telling] = {}
        self._number = 0
        self.messages = 0

    def __len__(self) -> int:
        return len(self._waiting)

    def put(self, telling: Telling) -> None:
        """Have something wait."""
        key: Hashable = (telling.kind, telling.name)
        if telling.kind == "text":
            self._number += 1
            self.messages += 1
            key = self._number
        # Taken out first, so that it stands at the end: nothing overtakes what was told before it.
        self._waiting.pop(key, None)
        self._waiting[key] = telling

    def take(self, frames: bool = True) -> Telling | None:
        """Return what waits for longest, None where nothing does.

        Args:
            frames: False: frames go on waiting, and what stands behind them passes.
        """
        for key, telling in self._waiting.items():
            if frames or telling.kind != "frame":
                del self._waiting[key]
                self.messages -= telling.kind == "text"
                return telling
        return None

    def drop(self, names: frozenset[str]) -> None:
        """Forget waiting arrays of these names."""
        for name in names:
            self._waiting.pop(("arrays", name), None)
