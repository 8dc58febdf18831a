"""Undo and redo: documents that were, a drag as one step."""

from __future__ import annotations

from polypod.studio.document import Document

MOST = 200


class History:
    """The documents before and after the present one."""

    def __init__(self) -> None:
        self._before: list[Document] = []
        self._after: list[Document] = []
        self._gesture: str | None = None

    @property
    def can_undo(self) -> bool:
        """Whether there is a document before."""
        return bool(self._before)

    @property
    def can_redo(self) -> bool:
        """Whether there is one that was undone."""
        return bool(self._after)

    def note(self, before: Document, gesture: str | None) -> None:
        """Keep the document that was before a change; changes of one gesture are one step."""
        if gesture is None or gesture != self._gesture:
            self._before = [*self._before[-(MOST - 1) :], before]
        self._gesture = gesture
        self._after = []

    def undo(self, present: Document) -> Document | None:
        """Return the document before the present one, None where there is none."""
        return self._step(self._before, self._after, present)

    def redo(self, present: Document) -> Document | None:
        """Return the document that was undone last, None where there is none."""
        return self._step(self._after, self._before, present)

    def _step(
        self, here: list[Document], there: list[Document], present: Document
    ) -> Document | None:
        self._gesture = None
        if not here:
            return None
        there.append(present)
        return here.pop()
