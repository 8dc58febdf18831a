"""Carries out orders, one after the other, between two frames."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from polypod.errors import PolypodError, SettingError
from polypod.gait.library import make_gait
from polypod.studio.asked import disks_of
from polypod.studio.conductor import Conductor
from polypod.studio.document import Document, edited, judged
from polypod.studio.stage import STEP

Step = Callable[[Document], Document | None]


def obey(conductor: Conductor, order: dict[str, Any]) -> None:
    """Carry out an order that `orders.judge_order` has let through.

    Raises:
        PolypodError: it cannot be done; nothing has changed.
    """
    present = conductor.stage.document
    conductor.urgent = True
    match order["do"]:
        case "edit":
            document = edited(present, order["at"], order["to"])
            conductor.take(document, order.get("gesture"))
        case "open":
            conductor.take(judged(order["document"]))
        case "gait":
            conductor.take(judged({**present, "gait": _disks(conductor, order["name"])}))
        case "undo":
            _go(conductor, conductor.history.undo, conductor.history.redo, "undo")
        case "redo":
            _go(conductor, conductor.history.redo, conductor.history.undo, "redo")
        case "clock":
            _set_clock(conductor, order)
        case "push":
            at = float(order.get("at", 0.0))
            conductor.stage.push(order.get("creature", 0), order["velocity"], at)
        case "restart":
            conductor.restart()
        case "record":
            conductor.record(order["on"])
        case "scrub":
            conductor.scrub(order["frame"])
        case "watch":
            conductor.look_at(order["creature"])
        case name:
            raise ValueError(f"nobody carries out {name}")


def _disks(conductor: Conductor, name: str | None) -> dict[str, Any] | None:
    """Return a gait of the library as a document holds it; None: it follows speed."""
    legs = conductor.stage.herd.tables.legs
    return None if name is None else disks_of(make_gait(name, legs.side, legs.row))


def _go(conductor: Conductor, there: Step, back: Step, what: str) -> None:
    """Take a document out of the history; what cannot be taken any more stays in it."""
    document = there(conductor.stage.document)
    if document is None:
        raise SettingError(f"there is nothing to {what}")
    try:
        conductor.take(document, keep=False)
    except PolypodError:
        back(document)
        raise


def _set_clock(conductor: Conductor, order: dict[str, Any]) -> None:
    """Let time go on or stand, faster or slower, or on by some steps while it stands."""
    if order.get("playing"):
        conductor.scrub(None)
    conductor.playing = order.get("playing", conductor.playing)
    conductor.rate = float(order.get("rate", conductor.rate))
    if not conductor.playing:
        for _ in range(order.get("steps", 0)):
            conductor.step(STEP)
    conductor.tell_clock()
